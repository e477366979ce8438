#include "measure/save_particles.h"

#include "core/output_file.h"
#include "scene/lattice.h"
#include "scene/particle_file.h"

namespace spindrift {

void saveParticles(const std::string& path, const std::vector<Particle>& particles,
                   const std::vector<double>& masses, const std::vector<double>& fluids) {
    ParticleTable table;
    table.masses = masses, table.fluids = fluids;
    for (const Particle& p : particles) {
        table.positions.push_back(p.position), table.velocities.push_back(p.velocity);
        table.densities.push_back(p.density), table.pressures.push_back(p.pressure);
    }
    replaceFile(path, [&](const std::string& temporary) {
        return writeParticles(temporary, path.ends_with(".h5"), table);
    });
}

std::vector<double> massesToSave(const Scene& scene, Simulation& simulation) {
    if (!hasOwnVolume(scene)) return {};
    const double volume = particleVolume(scene);
    std::vector<double> masses(size_t(simulation.fluidCount()), volume * scene.fluid.restDensity);
    const std::vector<uint16_t> bodies = simulation.state().particles.bodies;
    for (size_t i = 0; i < bodies.size(); ++i)
        masses[i] = volume * restDensity(scene, scene.fluid.bodies[bodies[i]]);
    return masses;
}

std::vector<double> fluidsToSave(const Scene& scene, Simulation& simulation) {
    if (hasOwnVolume(scene)) return {};
    const std::vector<uint16_t> bodies = simulation.state().particles.bodies;
    return {bodies.begin(), bodies.end()};
}

}  // namespace spindrift
