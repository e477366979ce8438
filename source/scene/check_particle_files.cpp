#include "scene/check_particle_files.h"

#include "scene/check_bodies.h"
#include "scene/formulation.h"
#include "scene/lattice.h"
#include "scene/particle_file.h"
#include "scene/particle_spacing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

std::string bodyPath(size_t index) { return fmt::format("fluid.bodies[{}]", index); }

void requireInside(const Scene& scene, const std::string& body, const std::string& file,
                   const ParticleTable& table) {
    for (size_t i = 0; i < table.positions.size(); ++i)
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            const double low = scene.domain.min[k], high = scene.domain.max[k],
                         at = table.positions[i][k], tolerance = 1e-5 * (high - low);
            if (!(at >= low - tolerance && at <= high + tolerance))
                refuse(body, fmt::format("{}: {}: {} = {} m is outside the domain's {} to {} m; "
                                         "remove the particle or enlarge the domain",
                                         file, table.nameOf(i), "xyz"[k], at, low, high));
        }
}

// The fluids that particles name.
void checkFluids(const Scene& scene, const std::string& body, const std::string& file,
                 const ParticleTable& table) {
    const size_t fluids = scene.fluid.bodies.size();
    for (size_t i = 0; i < table.fluids.size(); ++i)
        if (table.fluids[i] >= double(fluids))
            refuse(body, fmt::format("{}: {}: fluid = {:g}, and fluid.bodies has the entries 0 to "
                                     "{}; add one with that fluid's rest_density, or mend the file",
                                     file, table.nameOf(i), table.fluids[i], fluids - 1));
}

// Of a particle of a file: of the fluid that it names, or of its own body's.
double restDensityOf(const Scene& scene, const Body& own, const ParticleTable& table, size_t i) {
    return restDensity(scene,
                       table.fluids.empty() ? own : scene.fluid.bodies[size_t(table.fluids[i])]);
}

// Densities say how much particles are pressed, where they are carried those of the column, else
// the same ones as sums over places. By a tenth is many times what any flow does that the methods
// are for: fluid would burst. Single particles of violent runs get there.
void checkCompression(const Scene& scene, const std::string& path, const Body& body,
                      const ParticleTable& table) {
    constexpr double Most = 0.1, MostParticles = 0.01;
    if (factsOf(scene).isHistorical) return;
    size_t far = 0, first = 0;
    for (size_t i = table.densities.size(); i-- > 0;) {
        const double rho = table.densities[i], off = rho / restDensityOf(scene, body, table, i) - 1;
        if (rho != 0 && (off > Most || (off < -Most && carriesDensity(scene)))) ++far, first = i;
    }
    if (double(far) <= MostParticles * double(table.densities.size())) return;
    refuse(path, fmt::format("{}: {} of {} particles have densities more than a tenth off their "
                             "fluid's at rest, and would burst; {}: {:.4g} kg/m³, and {:.4g} at "
                             "rest; set rest_density, or leave the column rho out",
                             body.path, far, table.densities.size(), table.nameOf(first),
                             table.densities[first], restDensityOf(scene, body, table, first)));
}

// Densities whose unit is another one are a thousand times too small or too large.
void checkDensities(const std::string& body, const std::string& file, const ParticleTable& table,
                    double rest) {
    if (table.densities.empty()) return;
    const auto [least, most] = std::minmax_element(table.densities.begin(), table.densities.end());
    if (*most == 0) return;  // none is known
    if (*most < 0.01 * rest || *least > 100 * rest)
        refuse(body, fmt::format("{}: rho is {:.4g} to {:.4g} kg/m³, and {:.4g} at rest; name its "
                                 "unit in the header, as rho [g/cm³], or set "
                                 "fluid.rest_density",
                                 file, *least, *most, rest));
}

// Particles have one volume in all of a scene, which is about a cell of its spacing.
void checkMasses(const Scene& scene, const std::string& body, const std::string& file,
                 const ParticleTable& table, double rest, double found) {
    const auto [least, most] = std::minmax_element(table.masses.begin(), table.masses.end());
    if (*most > (1 + 1e-4) * *least)
        refuse(body, fmt::format("{}: masses are {:.6g} to {:.6g} kg, and a body's particles have "
                                 "one; give each fluid a file of its own",
                                 file, *least, *most));
    const double volume = particleVolume(scene);
    if (std::abs(*least / (rest * volume) - 1) > 1e-3)
        refuse(body, fmt::format("{}: {:.6g} kg of {:g} kg/m³ are {:.6g} m³, and particles of "
                                 "another file have {:.6g} m³; they must have one volume",
                                 file, *least, rest, *least / rest, volume));
    const double dx = scene.simulation.spacing;
    const int d = scene.simulation.dimensions;
    const double side = std::pow(volume, 1.0 / d);
    if (std::abs(found / side - 1) > 0.05 || std::abs(found / dx - 1) > 0.3)
        refuse(body, fmt::format("{}: its {} particles are {:.3g} m apart in the mean, by their "
                                 "mass {:.3g} m, and simulation.spacing is {:.3g} m; set "
                                 "fluid.rest_density and simulation.spacing as they were",
                                 file, table.positions.size(), found, side, dx));
}

// Where a column says how dense particles are, they may be nearer or farther by what that makes.
void checkSpacing(const Scene& scene, const std::string& body, const std::string& file,
                  const ParticleTable& table, double rest) {
    const int d = scene.simulation.dimensions;
    std::vector<Vec3d> places = table.positions;
    if (d == 2)
        for (Vec3d& p : places) p.z = 0;
    const double found = spacingBetween(places, d), dx = scene.simulation.spacing;
    if (found == 0 || scene.fluid.particleMass > 0) return;
    if (!table.masses.empty()) return checkMasses(scene, body, file, table, rest, found);
    std::vector<double> rho = table.densities;
    double expected = dx;
    if (!rho.empty()) {
        std::nth_element(rho.begin(), rho.begin() + long(rho.size() / 2), rho.end());
        expected *= std::pow(rest / rho[rho.size() / 2], 1.0 / d);
    }
    constexpr double Most = 0.05;
    if (std::abs(found / dx - 1) > Most && std::abs(found / expected - 1) > Most)
        refuse(body, fmt::format("{}: its {} particles are {:.3g} m apart in the mean, and "
                                 "simulation.spacing is {:.3g} m; set it to {:.3g}, or make "
                                 "the file anew",
                                 file, places.size(), found, dx, found));
}

// Of all files together: the same one may be read twice.
void checkDoubled(const Scene& scene, const std::vector<std::pair<size_t, ParticleTable>>& tables) {
    constexpr double Nearest = 0.05;  // spacings; particles of violent runs keep twice as far apart
    std::vector<Vec3d> places;
    std::vector<std::pair<size_t, size_t>> origins;  // which table, which of its particles
    for (size_t t = 0; t < tables.size(); ++t)
        for (size_t i = 0; i < tables[t].second.positions.size(); ++i) {
            places.push_back(tables[t].second.positions[i]);
            if (scene.simulation.dimensions == 2) places.back().z = 0;
            origins.push_back({t, i});
        }
    Vec3d periods{0, 0, 0};
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        if (scene.domain.periodic(k)) periods[k] = scene.domain.size()[k];
    const auto doubled = doubledParticles(places, Nearest * scene.simulation.spacing, periods);
    if (doubled.empty()) return;
    auto name = [&](size_t particle) {
        const auto [t, i] = origins[particle];
        return fmt::format("{}: {}", scene.fluid.bodies[tables[t].first].path,
                           tables[t].second.nameOf(i));
    };
    const auto [later, earlier] = doubled.front();
    const Vec3d at = places[later];
    refuse(
        bodyPath(tables[origins[later].first].first) + ".path",
        fmt::format("{} of {} particles are where another one is, the first at ({:.4g}, {:.4g}, "
                    "{:.4g}) m, {} and {}; remove them",
                    doubled.size(), places.size(), at.x, at.y, at.z, name(earlier), name(later)));
}

}  // namespace

void checkParticleFiles(const Scene& scene) {
    std::vector<std::pair<size_t, ParticleTable>> tables;
    for (size_t b = 0; b < scene.fluid.bodies.size(); ++b) {
        const Body& body = scene.fluid.bodies[b];
        if (body.shape != Shape::File) continue;
        const ParticleTable& table = tables.emplace_back(b, readParticles(body.path)).second;
        const std::string path = bodyPath(b) + ".path";
        requireInside(scene, path, body.path, table);
        checkFluids(scene, path, body.path, table);
        checkDensities(path, body.path, table, restDensity(scene, body));
        checkCompression(scene, path, body, table);
    }
    checkDoubled(scene, tables);
    for (const auto& [b, table] : tables)
        checkSpacing(scene, bodyPath(b) + ".path", scene.fluid.bodies[b].path, table,
                     restDensity(scene, scene.fluid.bodies[b]));
}

}  // namespace spindrift
