#include "measure/poured.h"

#include "scene/convex.h"

namespace spindrift {

std::vector<Poured> pouredIntoMeshes(const Scene& scene, const std::vector<Particle>& particles) {
    std::vector<Poured> all;
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) {
        const Body& body = scene.fluid.bodies[b];
        if (body.shape != Shape::Mesh) continue;
        const Convex shape = convexOf(body, 3);
        const double rho = restDensity(scene, body), skin = 1e-3 * scene.simulation.spacing;
        const double each = double(particleMass(scene)) * rho / double(scene.fluid.restDensity);
        Poured poured{b, 0, std::pow(shape.scale, 3) * shape.mesh->weigh().volume, 0};
        for (const Particle& p : particles)
            if (shape.nearest(p.position - shape.middle).distance <= skin) poured.mass += each;
        poured.wanted = rho * poured.volume;
        all.push_back(poured);
    }
    return all;
}

}  // namespace spindrift
