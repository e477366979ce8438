// What fluid does to each face of the domain: output.face_forces.
#include "core/error.h"
#include "physics/cube.h"
#include "scene/check.h"
#include "scene/formulation.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

namespace spindrift {
namespace {

// The forces of pressure and of viscosity together, by the face's name.
std::map<std::string, Vec3d> facesOf(Simulation& simulation) {
    std::map<std::string, Vec3d> out;
    for (const FaceMeasurement& f : simulation.measure().faces)
        out[f.name] = f.pressureForce + f.viscousForce;
    return out;
}

// Water of height H at rest: its weight on the floor, rho g H^2 / 2 a metre on each side, at three
// resolutions, in two dimensions and in three.
TEST(FaceForces, OfWaterAtRestAreHydrostatic) {
    for (const char* formulation : {"wcsph", "delta_sph", "delta_plus", "incompressible"})
        for (const int dimensions : {2, 3})
            for (const int layers : {8, 16, 32}) {
                if (dimensions == 3 && layers > 8) continue;
                SCOPED_TRACE(testing::Message()
                             << formulation << " " << dimensions << "D, " << layers << " layers");
                const double H = 0.4, L = 1, g = 9.81, rho = 1000, D = dimensions == 2 ? 1 : 0.6;
                Scene scene = cubeWith(
                    {std::string("simulation.formulation=") + formulation,
                     "simulation.dimensions=" + std::to_string(dimensions),
                     "simulation.spacing=" + std::to_string(H / layers), "domain.max=1,0.8,0.6",
                     "fluid.viscosity=1", "output.face_forces=true",
                     R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[1,0.4,0.6],)"
                     R"("pressure":"hydrostatic"}])"});
                if (!factsOf(scene).carriesDensity)  // begins without the pressure of its depth
                    scene.simulation.gravityRamp = 0.3f;
                auto simulation = makeSimulation(scene);
                std::map<std::string, Vec3d> mean;
                const double calm = factsOf(scene).carriesDensity ? 0.3 : 0.6;
                simulation->stopAt(calm);
                while (simulation->clock().time < calm) simulation->step();
                const int samples = 40;
                for (int k = 0; k < samples; ++k) {
                    simulation->step(5);
                    for (const auto& [name, force] : facesOf(*simulation))
                        mean[name] = mean[name] + (1.0 / samples) * force;
                }
                EXPECT_EQ(mean.size(), 2u * size_t(dimensions));
                const double weight = rho * g * H * L * D, side = rho * g * H * H / 2 * D;
                // Solved pressures swing in calm pools.
                const double within = factsOf(scene).solvesPressure ? 0.02 : 0.01;
                EXPECT_NEAR(-mean["y_min"].y / weight, 1, within);
                EXPECT_NEAR(-mean["x_min"].x / side, 1, 2 * within);
                EXPECT_NEAR(mean["x_max"].x / side, 1, 2 * within);
                EXPECT_NEAR(mean["y_max"].y / weight, 0, 1e-3);
            }
}

// What leaves the fluid's momentum arrives at the faces and at the solid.
TEST(FaceForces, AreWhatTheFluidsMomentumLoses) {
    for (const char* formulation : {"wcsph", "delta_sph", "delta_plus"})
        for (const char* solid :
             {"", R"({"shape":"block","min":[0.6,0,0.3],"max":[0.8,0.2,0.7]})"}) {
            SCOPED_TRACE(testing::Message() << formulation << " " << solid);
            Scene scene = cubeWith({std::string("simulation.formulation=") + formulation,
                                    "output.face_forces=true", "fluid.viscosity=1",
                                    std::string("solids=[") + solid + "]",
                                    R"(fluid.bodies=[{"shape":"block","max":[0.4,0.6,1]}])"});
            auto simulation = makeSimulation(scene);
            const Measurement start = simulation->measure();
            const double mass = 1000 * 0.4 * 0.6;
            Vec3d given;
            double before = 0;
            while (simulation->clock().time < 0.5) {
                const Measurement m = simulation->measure();
                simulation->step();
                const double dt = simulation->clock().time - before;
                before = simulation->clock().time;
                for (const FaceMeasurement& f : m.faces)
                    given = given + dt * (f.pressureForce + f.viscousForce);
                for (const SolidMeasurement& s : m.solids)
                    given = given + dt * (s.pressureForce + s.viscousForce);
            }
            const Vec3d lost = start.momentum + before * mass * Vec3d{0, -9.81, 0} -
                               simulation->measure().momentum;
            const double all = mass * 9.81 * before;
            // What is stopped at the solid's surface is not told.
            EXPECT_LT(length(given - lost), (*solid ? 0.015 : 0.01) * all);
        }
}

TEST(FaceForces, FacesThatAreNotThereAreNotTold) {
    Scene scene = cubeWith({"output.face_forces=true", "domain.periodic_x=true",
                            R"(fluid.bodies=[{"shape":"block","max":[1,0.5,1]}])"});
    EXPECT_EQ(makeSimulation(scene)->measure().faces.size(), 4u);
    scene.output.faceForces = false;
    EXPECT_TRUE(makeSimulation(scene)->measure().faces.empty());
    const auto refusal = [](const std::vector<std::string>& knobs) -> std::string {
        try {
            checkScene(cubeWith(knobs));
        } catch (const Error& error) { return error.what(); }
        return "";
    };
    EXPECT_NE(refusal({"output.face_forces=true", "walls.kind=reflect"})
                  .find("output.face_forces: walls that reflect"),
              std::string::npos);
    EXPECT_NE(refusal({"output.face_forces=true", "domain.periodic_x=true",
                       "domain.periodic_y=true", "domain.periodic_z=true"})
                  .find("output.face_forces: all axes are periodic"),
              std::string::npos);
}

}  // namespace
}  // namespace spindrift
