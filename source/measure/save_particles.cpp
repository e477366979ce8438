#include "measure/save_particles.h"

#include "core/output_file.h"
#include "scene/particle_file.h"

namespace spindrift {

void saveParticles(const std::string& path, const std::vector<Particle>& particles) {
    ParticleTable table;
    for (const Particle& p : particles) {
        table.positions.push_back(p.position), table.velocities.push_back(p.velocity);
        table.densities.push_back(p.density), table.pressures.push_back(p.pressure);
    }
    replaceFile(path, [&](const std::string& temporary) { return writeParticles(temporary, path.ends_with(".h5"), table); });
}

}  // namespace spindrift
