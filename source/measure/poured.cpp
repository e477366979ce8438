#include "measure/poured.h"

#include "scene/convex.h"
#include "scene/lattice.h"
#include "scene/particles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace spindrift {
namespace {

// kg; of the shape, nothing where it isn't known.
struct Share {
    std::string holder;
    double shape, particles;
};

std::string told(const Share& s, int dimensions) {
    const double more = s.particles / s.shape - 1;
    return fmt::format("{:.4g} {}, {:.2g} % {} than {}", s.particles, perDepth("kg", dimensions),
                       100 * std::abs(more), more > 0 ? "more" : "less", s.holder);
}

}  // namespace

std::vector<Poured> pouredIntoMeshes(const Scene& scene, const std::vector<Particle>& particles) {
    std::vector<Poured> all;
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) {
        const Body& body = scene.fluid.bodies[b];
        if (body.shape != Shape::Mesh) continue;
        const Convex shape = convexOf(body, 3);
        const double rho = restDensity(scene, body), skin = 1e-3 * scene.simulation.spacing;
        const double each = double(particleMass(scene)) * rho / double(scene.fluid.restDensity);
        Poured poured{b, 0, std::pow(double(body.scale), 3) * readMesh(body.path)->weigh().volume,
                      0};
        for (const Particle& p : particles)
            if (shape.nearest(p.position - shape.middle).distance <= skin) poured.mass += each;
        poured.wanted = rho * poured.volume;
        all.push_back(poured);
    }
    return all;
}

std::vector<std::string> pouredAmiss(const Scene& scene, Simulation& simulation) {
    constexpr double Most = 0.01;
    const std::vector<Body>& bodies = scene.fluid.bodies;
    const bool known = std::none_of(bodies.begin(), bodies.end(), [](const Body& body) {
        return body.shape == Shape::File || body.shape == Shape::Mesh;
    });
    if (!known || scene.fluid.particleMass > 0 || comesAndGoes(scene)) return {};
    const std::vector<double> volumes = bodyVolumes(scene);
    const std::vector<uint16_t> of = simulation.state().particles.bodies;  // of a mixture only
    std::vector<Share> shares;
    if (of.empty()) {
        const double volume = std::accumulate(volumes.begin(), volumes.end(), 0.0);
        const char* holder = bodies.size() == 1 ? "its body holds" : "its bodies hold";
        shares.push_back({holder, volume * scene.fluid.restDensity,
                          simulation.fluidCount() * double(particleMass(scene))});
    } else {
        for (size_t b = 0; b < bodies.size(); ++b)
            shares.push_back({fmt::format("fluid.bodies[{}] holds", b),
                              volumes[b] * restDensity(scene, bodies[b]), 0});
        for (const uint16_t b : of)
            shares[b].particles += particleVolume(scene) * restDensity(scene, bodies[b]);
    }
    std::vector<std::string> lines;
    for (const Share& s : shares)
        if (s.shape > 0 && std::abs(s.particles / s.shape - 1) > Most)
            lines.push_back(told(s, scene.simulation.dimensions));
    return lines;
}

}  // namespace spindrift
