// Nobody gets through a solid, however thin it is and however far a particle moves in a step; and
// what meshes do to fluid is what other solids do.
#include "meshes.h"
#include "physics/cube.h"
#include "scene/convex.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "sim/simulation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

namespace spindrift {
namespace {

// Particles without pressure, gravity or friction, which fly on until they hit something, in steps
// of 10 ms: at 50 m/s ten spacings each.
Scene dustOf(const std::vector<std::string>& knobs) {
    Scene scene = cubeWith({"simulation.gravity=0,0,0", "fluid.stiffness=1e-9", "fluid.viscosity=0",
                            "fluid.artificial_viscosity=0", "fluid.density_diffusion=0",
                            "time.mode=fixed", "time.step=0.01", "walls.restitution=1"});
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return scene;
}
using Side = std::function<bool(const Particle&)>;
void expectAll(const std::string& what, Scene scene, int steps, const Side& side) {
    SCOPED_TRACE(what);
    auto simulation = makeSimulation(scene);
    for (int k = 1; k <= steps; ++k) {
        simulation->step();
        for (const Particle& p : simulation->particles())
            ASSERT_TRUE(side(p)) << "step " << k << ", particle " << p.id << " at " << p.position.x
                                 << " " << p.position.y << " " << p.position.z;
    }
}
std::string mesh(const Surface& surface, const std::string& name, const std::string& more = "") {
    return R"({"shape":"mesh","path":")" + surface.write(testing::TempDir() + "/" + name + ".obj") +
           "\"" + more + "}";
}
// A wall all round a room, both of them boxes.
Surface roomSurface(Vec3d low, Vec3d high, double wall) {
    Surface room = boxSurface({low.x - wall, low.y - wall, low.z - wall},
                              {high.x + wall, high.y + wall, high.z + wall});
    const Surface hollow = boxSurface(low, high);
    for (const Vec3d& p : hollow.vertices) room.vertices.push_back(p);
    for (std::vector<int> f : hollow.faces) {
        for (int& v : f) v += 8;
        room.faces.push_back({f.rbegin(), f.rend()});
    }
    return room;
}

const char* const Above =
    R"(fluid.bodies=[{"shape":"block","min":[0.2,0.6,0.2],"max":[0.8,0.9,0.8]}])";

TEST(Collisions, ThinPlatesStopAllFluidWhereItCame) {
    const std::string plates[] = {
        R"({"shape":"block","min":[-0.2,0.4,-0.2],"max":[1.2,0.42,1.2]})",
        R"({"shape":"wedge","min":[-1,0.4,-0.2],"max":[2,0.43,1.2]})",
        R"({"shape":"cylinder","center":[0.5,0.41,0.5],"radius":0.8,"height":0.02})",
        R"({"shape":"plane","center":[0.5,0.42,0.5],"normal":[0.1,1,0]})",
        mesh(dentedBoxSurface({-0.2, 0.4, -0.2}, {1.2, 0.42, 1.2}), "plate")};
    for (const std::string& plate : plates)
        for (const char* formulation : {"wcsph", "delta_sph", "delta_plus"})
            for (const char* integrator :
                 {"symplectic_euler", "velocity_verlet", "predictor_corrector"})
                for (Vec3 velocity : {Vec3{0, -7, 0}, Vec3{60, -80, 20}, Vec3{0, -1000, 0}}) {
                    Scene scene = dustOf({std::string("simulation.formulation=") + formulation,
                                          std::string("time.integrator=") + integrator,
                                          "solids=[" + plate + "]", Above});
                    scene.fluid.bodies[0].velocity = velocity;
                    if (velocity.x == 0) scene.walls.restitution = 0.5f;
                    // Carried density has no bounds where a thousand particles become a heap in a
                    // step.
                    const Formulation f = scene.simulation.formulation;
                    const int steps = f == Formulation::Wcsph      ? 12
                                      : f == Formulation::DeltaSph ? 2
                                                                   : 1;
                    const double tilt = plate.find("plane") == std::string::npos ? 0 : 0.1;
                    expectAll(plate + formulation + integrator, scene, steps,
                              [&](const Particle& p) {
                                  const Vec3d x = p.position;
                                  return x.y + tilt * (x.x - 0.5) > 0.4 &&
                                         std::min({x.x, x.y, x.z}) >= 0 &&
                                         std::max({x.x, x.y, x.z}) <= 1;  // in the box, too
                              });
                }
}

// In two dimensions, and with pressure and steps as the flow asks for, all alike and each particle
// its own: of 13 mm and 26, where the plate is 10 mm thin.
TEST(Collisions, ThinPlatesStopFluidWithPressure) {
    for (const char* mode : {"cfl", "local"})
        for (int dimensions : {2, 3})
            for (const char* shape : {"block", "plane", "mesh"}) {
                if (dimensions == 2 && shape[0] == 'm') continue;
                const std::string plate =
                    shape[0] == 'm'
                        ? mesh(dentedBoxSurface({-0.2, 0.4, -0.2}, {1.2, 0.41, 1.2}), "leaf")
                    : shape[0] == 'b'
                        ? R"({"shape":"block","min":[-0.2,0.4,-0.2],"max":[1.2,0.41,1.2]})"
                        : R"({"shape":"plane","center":[0,0.41,0]})";
                Scene scene = cubeWith({std::string("time.mode=") + mode,
                                        "simulation.dimensions=" + std::to_string(dimensions),
                                        "fluid.sound_speed=20", "solids=[" + plate + "]", Above});
                scene.fluid.bodies[0].velocity = {0, -30, 0};
                expectAll(plate + mode, scene, 150,
                          [](const Particle& p) { return p.position.y > 0.405; });
            }
}

// Shot at from above: nobody is below their middle in their shadow, or in them.
TEST(Collisions, BodiesStopFluidWhereItCame) {
    for (const std::string& body :
         {std::string(R"({"shape":"sphere","center":[0.5,0.3,0.5],"radius":0.15})"),
          std::string(R"({"shape":"cylinder","center":[0.5,0.3,0.5],"radius":0.15,"height":0.4,)"
                      R"("axis":"y"})"),
          mesh(sphereSurface({0.5, 0.3, 0.5}, 0.15, 3), "sphere")}) {
        Scene scene =
            dustOf({"walls.restitution=0", "solids=[" + body + "]",
                    R"(fluid.bodies=[{"shape":"block","min":[0.4,0.6,0.4],"max":[0.6,0.9,0.6]}])"});
        scene.fluid.bodies[0].velocity = {0, -60, 0};
        expectAll(body, scene, 1, [](const Particle& p) {
            const Vec3d from = p.position - Vec3d{0.5, 0.3, 0.5};
            return (from.y > 0 || std::hypot(from.x, from.z) > 0.148) && length(from) > 0.148;
        });
    }
}

// A mesh that ends at the domain's walls, or at itself across a periodic axis, has no way in along
// them: pressed into the corner of both for a second, no particle is more than a hundredth of a
// spacing deep in its flank.
TEST(Collisions, MeshesThatEndAtWallsHaveNoWayInThere) {
    for (const double thick : {0.02, 0.075})
        for (const char* motion : {"", R"(,"keyframes":[[0,0,0,0],[1,0,0.1,0]])"})
            for (const auto& [low, high, along, periodic] : {std::tuple{0.0, 1.0, 3, false},
                                                             {0.0, 1.0, -3, true},
                                                             {0.0, 0.7, -3, false},
                                                             {0.3, 1.0, 3, false}}) {
                const double end = 0.5 + thick;
                const std::vector<Vec3d> L{{0.5, -0.15, 0}, {0.9, -0.15, 0}, {0.9, 0, 0},
                                           {end, 0, 0},     {end, 1.05, 0},  {0.5, 1.05, 0}};
                const Scene scene =
                    dustOf({"solids=[" + mesh(prismSurface(L, low, high), "profile", motion) + "]",
                            fmt::format("simulation.gravity=5,0,{}", along),
                            fmt::format("domain.periodic_z={}", periodic), "walls.restitution=0",
                            fmt::format(R"(fluid.bodies=[{{"shape":"block","min":[0.3,0.4,{}],
                                  "max":[0.4,0.6,{}]}}])",
                                        low > 0 ? 0.5 : 0, high < 1 ? 0.5 : 1)});
                expectAll(fmt::format("{}{} {} {}", thick, motion, low, high), scene, 100,
                          [](const Particle& p) { return p.position.x < 0.5005; });
            }
}

TEST(Collisions, PlatesThatMoveTakeAlongWhatTheyMeet) {
    for (const char* integrator : {"symplectic_euler", "velocity_verlet", "predictor_corrector"})
        for (bool isMesh : {false, true}) {
            // At 30 m/s 0.3 m a step, then back, and on.
            const std::string keys =
                R"(,"keyframes":[[0,0,0,0],[0.015,0.45,0,0],[0.045,0,0,0],[0.09,0.4,0,0]])";
            const std::string plate =
                isMesh
                    ? mesh(dentedBoxSurface({0.1, -0.2, -0.2}, {0.12, 1.2, 1.2}), "piston", keys)
                    : R"({"shape":"block","min":[0.1,-0.2,-0.2],"max":[0.12,1.2,1.2])" + keys + "}";
            Scene scene = dustOf(
                {std::string("time.integrator=") + integrator, "walls.restitution=0",
                 "solids=[" + plate + "]",
                 R"(fluid.bodies=[{"shape":"block","min":[0.2,0.2,0.2],"max":[0.5,0.8,0.8]}])"});
            auto simulation = makeSimulation(scene);
            for (int k = 0; k < 9; ++k) {
                simulation->step();
                const double plateAt = simulation->measure().solids[0].position.x;
                for (const Particle& p : simulation->particles())
                    ASSERT_GT(p.position.x, plateAt) << integrator << isMesh << " step " << k;
            }
        }
}

// 60 or 240 degrees in one step: who was in front of the paddle still is, and lies on it.
TEST(Collisions, PaddlesThatTurnTakeAlongWhatTheyMeet) {
    for (bool isMesh : {false, true})
        for (int degrees : {60, 240}) {
            SCOPED_TRACE(testing::Message() << isMesh << " " << degrees);
            const std::string spin = ",\"spin\":" + std::to_string(100 * degrees);
            const std::string paddle =
                isMesh
                    ? mesh(dentedBoxSurface({0.1, 0.49, 0.1}, {0.9, 0.51, 0.9}), "paddle", spin)
                    : R"({"shape":"block","min":[0.1,0.49,0.1],"max":[0.9,0.51,0.9])" + spin + "}";
            const Scene scene = dustOf(
                {"walls.restitution=0", "solids=[" + paddle + "]",
                 R"(fluid.bodies=[{"shape":"block","min":[0.1,0.1,0.2],"max":[0.9,0.9,0.8]}])"});
            auto simulation = makeSimulation(scene);
            const std::vector<Particle> before = simulation->particles();
            simulation->step();
            const std::vector<Particle> after = simulation->particles();
            int swept = 0;
            const double turn = degrees * std::numbers::pi / 180;
            for (size_t i = 0; i < before.size(); ++i) {
                const Vec3d a = before[i].position - Vec3d{0.5, 0.5, 0.5},
                            b = after[i].position - Vec3d{0.5, 0.5, 0.5};
                const double angle = std::atan2(a.y, a.x), r = std::hypot(a.x, a.y);
                if (r > 0.35 || r < 0.08) continue;
                const double height =
                    -std::sin(turn) * b.x + std::cos(turn) * b.y;  // over the paddle
                // By its one arm from 0 on, or by the other one from 180 degrees on.
                const double first = angle > 0 ? angle : angle + std::numbers::pi;
                if (first > turn) continue;
                ++swept;
                ASSERT_NEAR(height, angle > 0 ? 0.01 : -0.01, 0.001) << a.x << " " << a.y;
                // Along it they slide as if nothing were there.
                const double along = std::cos(turn) * b.x + std::sin(turn) * b.y;
                ASSERT_TRUE(degrees != 60 || std::abs(along - r * std::cos(angle - turn)) < 0.001)
                    << a.x << " " << a.y;
            }
            EXPECT_GT(swept, 300);
        }
}

// Through a side of the domain to the plate behind it, or to a plate that is there by its image
// alone: where they stick.
TEST(Collisions, PeriodicSidesHideNoPlate) {
    struct Case {
        double low, high;
        float speed;
        double sticks;
    };
    for (bool isMesh : {false, true})
        for (const Case& c : {Case{0.9, 0.92, -20, 0.92}, Case{0.9, 0.92, -65, 0.92},
                              Case{-0.08, 0, 20, 0.92}, Case{-0.08, 0, 65, 0.92}}) {
            const std::string range =
                fmt::format(R"("min":[{},-0.2,-0.2],"max":[{},1.2,1.2])", c.low, c.high);
            const std::string plate =
                isMesh ? mesh(dentedBoxSurface({c.low, -0.2, -0.2}, {c.high, 1.2, 1.2}),
                              fmt::format("beyond{}", c.low))
                       : R"({"shape":"block",)" + range + "}";
            Scene scene = dustOf(
                {"domain.periodic_x=true", "walls.restitution=0", "solids=[" + plate + "]",
                 R"(fluid.bodies=[{"shape":"block","min":[0.2,0.2,0.2],"max":[0.5,0.8,0.8]}])"});
            scene.fluid.bodies[0].velocity = {c.speed, 0, 0};
            auto simulation = makeSimulation(scene);
            simulation->step(6);
            for (const Particle& p : simulation->particles()) {
                ASSERT_NEAR(p.position.x, c.sticks, 1e-3) << isMesh << c.low << " " << c.speed;
                ASSERT_NEAR(p.velocity.x, 0, 1e-5);
            }
        }
}

// The way of a particle that bounces off the floor ends on the floor, not where its new velocity
// would have brought it from.
TEST(Collisions, TheBoxAndAPlateInOneStep) {
    for (float restitution : {0.0f, 1.0f}) {
        Scene scene = dustOf(
            {R"(solids=[{"shape":"block","min":[-0.2,0.05,-0.2],"max":[1.2,0.06,1.2]}])", Above});
        scene.walls.restitution = restitution, scene.walls.friction = 0.5f;
        scene.fluid.bodies[0].velocity = {90, -90, 0};
        expectAll("floor", scene, 10, [](const Particle& p) { return p.position.y > 0.06; });
    }
}

// A room that is shaken and turned keeps what is in it.
TEST(Collisions, NobodyLeavesARoomThatMoves) {
    const std::string room = mesh(
        roomSurface({0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}, 0.03), "room",
        R"(,"spin_axis":"y","keyframes":[[0,0,0,0,0],[0.02,0.1,0.1,0,60],[0.05,-0.1,0,0.1,-90],)"
        R"([0.1,0,-0.1,-0.1,200],[0.2,0,0,0,0]])");
    Scene scene = dustOf(
        {"walls.restitution=0.3", "solids=[" + room + "]",
         R"(fluid.bodies=[{"shape":"block","min":[0.35,0.35,0.35],"max":[0.65,0.65,0.65]}])"});
    auto simulation = makeSimulation(scene);
    for (int k = 0; k < 25; ++k) {
        simulation->step();
        const Vec3d middle = simulation->measure().solids[0].position;
        for (const Particle& p : simulation->particles()) {
            ASSERT_LT(std::abs(p.position.y - middle.y), 0.21) << k;
            ASSERT_LT(std::hypot(p.position.x - middle.x, p.position.z - middle.z),
                      0.2 * std::numbers::sqrt2 + 0.01)
                << k;
        }
    }
}

// A mesh of a block does what the block does: pushes as much and feels the same, while the fluid
// has not yet left it as a splash (whose share along the block differs by 30 % when it has, with
// eight particles a side).
TEST(Meshes, PushAsOtherSolidsDo) {
    auto gainedBy = [](const std::string& solid) {
        const Scene scene = cubeWith(
            {"simulation.formulation=delta_sph", "simulation.gravity=0,0,0", "walls.kind=reflect",
             "time.cfl=0.1", "domain.max=3,1,1", "fluid.viscosity=1", "simulation.spacing=0.025",
             R"(fluid.bodies=[{"shape":"block","min":[0.4,0.3,0.3],"max":[0.8,0.7,0.7]}])",
             "solids=[" + solid + "]"});
        auto simulation = makeSimulation(scene);
        Vec3d impulse;
        while (simulation->clock().time < 0.15) {
            const SolidMeasurement load = simulation->measure().solids[0];
            simulation->step();
            impulse = impulse - simulation->measure().dt * (load.pressureForce + load.viscousForce);
        }
        const Vec3d gained = simulation->measure().momentum;
        EXPECT_NEAR(impulse.x / gained.x, 1, 0.03);
        EXPECT_NEAR(impulse.z / gained.z, 1, 0.1);
        return gained;
    };
    const char* motion = R"(,"velocity":[0.4,0,0.2])";
    const Vec3d block = gainedBy(
        std::string(R"({"shape":"block","min":[0.2,0.2,0.2],"max":[0.4,0.8,0.8])") + motion + "}");
    const Vec3d same =
        gainedBy(mesh(dentedBoxSurface({0.2, 0.2, 0.2}, {0.4, 0.8, 0.8}), "pusher", motion));
    EXPECT_NEAR(same.x / block.x, 1, 0.01);
    EXPECT_NEAR(same.z / block.z, 1, 0.03);
}

// Archimedes, for meshes of other places and directions than the fluid's lattice.
TEST(Meshes, AreLiftedByTheWeightOfTheirWater) {
    Surface cube = boxSurface({-0.12, -0.12, -0.12}, {0.12, 0.12, 0.12});
    for (Vec3d& p : cube.vertices) {
        const Vec3d q{p.x * std::cos(0.4) - p.y * std::sin(0.4),
                      p.x * std::sin(0.4) + p.y * std::cos(0.4), p.z};
        p = Vec3d{0.3, 0.23, 0.3} + Vec3d{q.x, q.y * std::cos(0.3) - q.z * std::sin(0.3),
                                          q.y * std::sin(0.3) + q.z * std::cos(0.3)};
    }
    const double pi = std::numbers::pi;
    const std::pair<std::string, double> solids[] = {
        {mesh(cube, "turned"), std::pow(0.24, 3)},
        {mesh(sphereSurface({0.3, 0.23, 0.3}, 0.13, 3), "float"), 4 * pi / 3 * std::pow(0.13, 3)}};
    for (const auto& [solid, volume] : solids) {
        const Scene scene = cubeWith(
            {"simulation.formulation=delta_sph", "simulation.spacing=0.025",
             "domain.max=0.6,0.6,0.6", "fluid.viscosity=0", "fluid.artificial_viscosity=0.3",
             "fluid.speed_ratio=8", "time.cfl=0.5", "solids=[" + solid + "]",
             R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.6,0.45,0.6],)"
             R"("pressure":"hydrostatic"}])"});
        auto simulation = makeSimulation(scene);
        simulation->step(600);
        double lift = 0;
        constexpr int Looks = 20;  // a mean over what is left of the sound
        for (int k = 0; k < Looks; ++k) {
            simulation->step(20);
            lift += simulation->measure().solids[0].pressureForce.y / Looks;
        }
        EXPECT_NEAR(lift / (1000 * 9.81 * volume), 1, 0.04) << solid;
    }
}

}  // namespace
}  // namespace spindrift
