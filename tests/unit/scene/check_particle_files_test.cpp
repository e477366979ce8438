// What is asked of particles of files, and how they are made even.
#include "scene/check_particle_files.h"

#include "core/error.h"
#include "scene/formulation.h"
#include "scene/particle_file.h"
#include "scene/particles.h"
#include "sim/simulation.h"
#include "unit/scene/scene_of_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

namespace spindrift {
namespace {

class CheckParticleFiles : public testing::Test {
protected:
    CheckParticleFiles()
        : path(std::filesystem::temp_directory_path() /
               ("spindrift-check-" + std::to_string(getpid()) + ".csv")) {}
    ~CheckParticleFiles() override { std::filesystem::remove(path); }
    // A scene that begins with these particles.
    Scene sceneOf(const std::string& text, Formulation formulation) const {
        std::ofstream(path, std::ios::binary) << text;
        return sceneOfFile(path.string(), formulation);
    }
    static std::string refusalOf(const Scene& scene) {
        try {
            checkParticleFiles(scene);
        } catch (const Error& error) { return error.what(); }
        return "";
    }
    std::filesystem::path path;
};

// Fluid of other density than its own at rest would burst, or tear where density is carried; also
// where a particle names its fluid.
TEST_F(CheckParticleFiles, DensitiesFarFromTheirFluidsAreRefused) {
    for (const Formulation formulation : {Formulation::Wcsph, Formulation::DeltaSph,
                                          Formulation::DeltaPlus, Formulation::Incompressible})
        for (const bool named : {false, true})
            for (const double rest : {1000.0, 700.0})
                for (const double ratio : {0.8, 0.88, 0.95, 1.0, 1.05, 1.12, 1.3}) {
                    const bool takesFluids = factsOf(formulation).takesFluids;
                    if (!takesFluids && (named || rest != 1000)) continue;
                    std::string text = named ? "x,y,z,rho,fluid\n" : "x,y,z,rho\n";
                    const double apart = 0.1 / std::cbrt(ratio);
                    for (int i = 0; i < 343; ++i)
                        text += fmt::format("{},{},{},{}{}\n", -0.85 + (i % 7) * apart,
                                            2.1 + (i / 7 % 7) * apart, 3.1 + i / 49 * apart,
                                            ratio * rest, named ? ",1" : "");
                    Scene scene = sceneOf(text, formulation);
                    Body other{{.min{-1, 2, 3}, .max{-0.9f, 2.1f, 3.1f}}};
                    (named ? other : scene.fluid.bodies[0]).restDensity = float(rest);
                    if (named) scene.fluid.bodies.push_back(other);
                    const std::string said = refusalOf(scene);
                    const bool bursts = ratio > 1.1,
                               tears = ratio < 0.9 && factsOf(formulation).carriesDensity;
                    EXPECT_EQ(said.find("343 of 343 particles have densities more than a tenth off "
                                        "their fluid's at rest") != std::string::npos,
                              bursts || tears)
                        << int(formulation) << " " << named << " " << rest << " " << ratio << " "
                        << said;
                }
}

// From an uneven start the places become even, and stay where they were: at walls, in the open, and
// beside another body's.
TEST_F(CheckParticleFiles, AreRelaxedWhereThatIsAskedFor) {
    for (const int dimensions : {2, 3})
        for (const bool other : {false, true}) {
            SCOPED_TRACE(testing::Message() << dimensions << " dimensions, " << other);
            std::mt19937 random(3);
            const double dx = 0.05;
            std::string text = "x,y,z,vx,vy,vz\n";
            const int n = 12, deep = dimensions == 2 ? 1 : 20;
            for (int i = 0; i < 20 * n * deep; ++i) {
                const auto shaken = [&](int at) {
                    return (at + 0.5 + 0.8 * (double(random()) / 4294967296.0 - 0.5)) * dx;
                };
                const double x = shaken(i % 20), y = shaken(i / 20 % n), z = shaken(i / (20 * n));
                text += fmt::format("{},{},{},1,2,3\n", x - 1, y + 2, z + 3);
            }
            Scene scene = sceneOf(text, Formulation::Wcsph);
            scene.simulation.dimensions = dimensions, scene.simulation.spacing = float(dx);
            if (other) scene.fluid.bodies.push_back(Body{{.min{-1, 2.6f, 3}, .max{0, 2.8f, 4}}});
            struct Spread {
                double mean = 0, deviation = 0;
            };
            const auto inside = [&](const Scene& s) {
                std::vector<double> rho;
                for (const Particle& p : makeSimulation(s)->particles())
                    if (p.position.y < 2.6 - 2.6 * dx || (other && p.position.y < 2.7))
                        rho.push_back(p.density);
                Spread spread;
                for (const double r : rho) spread.mean += r / double(rho.size());
                for (const double r : rho)
                    spread.deviation += std::pow(r - spread.mean, 2) / double(rho.size());
                spread.deviation = std::sqrt(spread.deviation);
                return spread;
            };
            const Spread before = inside(scene);
            scene.fluid.bodies[0].relax = true;
            const Spread after = inside(scene);
            EXPECT_GT(before.deviation, 20) << "kg/m³";
            EXPECT_LT(after.deviation, 0.25 * before.deviation);
            EXPECT_NEAR(after.mean, 1000, 15);
            const Placement placed = placeParticles(scene);
            double top = 0, moved = 0;
            const ParticleTable table = readParticles(scene.fluid.bodies[0].path);
            const size_t first = placed.positions.size() - table.positions.size();
            for (size_t i = 0; i < table.positions.size(); ++i) {
                const Vec3d at = toDouble(placed.positions[first + i] + scene.domain.min);
                top = std::max(top, at.y);
                Vec3d way = at - table.positions[i];
                if (dimensions == 2) way.z = 0;
                moved = std::max(moved, length(way));
                EXPECT_EQ(placed.velocities[first + i].x, 1);
            }
            EXPECT_NEAR(top, 2.6 - 0.5 * dx, 0.7 * dx) << "it began rugged by 0.4";
            EXPECT_LT(moved, 2 * dx);
            EXPECT_GT(moved, 0.1 * dx);
        }
}

}  // namespace
}  // namespace spindrift
