// Fluid that comes and leaves: as much as was asked for, and nothing else of a run is changed.
#include "core/error.h"
#include "measure/health.h"
#include "measure/validity.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/schema.h"
#include "scene/sources.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>

namespace spindrift {
namespace {

const Formulation Formulations[] = {Formulation::Wcsph, Formulation::DeltaSph,
                                    Formulation::DeltaPlus, Formulation::Incompressible};

std::string nameOf(const Scene& s) {
    return std::string(enumNames(Formulation())[size_t(s.simulation.formulation)]) + " " +
           std::to_string(s.simulation.dimensions) + "D";
}

Scene sceneOf(Formulation f, int dimensions, const std::vector<std::string>& knobs) {
    Scene s;
    s.compute.backend = Backend::Cpu, s.compute.threads = 1;
    s.simulation.formulation = f, s.simulation.dimensions = dimensions;
    s.simulation.spacing = 0.05f;
    s.domain.max = {0.8f, 0.8f, 0.5f};
    s.fluid.bodies.clear();
    for (const std::string& knob : knobs) setKnob(s, knob);
    checkScene(s, nameOf(s));
    return s;
}

void runTo(Simulation& simulation, double time) {
    while (simulation.clock().time < time) simulation.stopAt(time), simulation.step();
}

// Everything that a run is.
void expectSame(const RunState& a, const RunState& b, const std::string& what) {
    EXPECT_EQ(a.particles.positions, b.particles.positions) << what;
    EXPECT_EQ(a.particles.velocities, b.particles.velocities) << what;
    EXPECT_EQ(a.particles.ids, b.particles.ids) << what;
    EXPECT_EQ(a.particles.heldBy, b.particles.heldBy) << what;
    EXPECT_EQ(a.densities, b.densities) << what;
    EXPECT_EQ(a.sources.came, b.sources.came) << what;
    EXPECT_EQ(a.sources.left, b.sources.left) << what;
}

TEST(Sources, GiveTheirFlowTimesTimeToALayer) {
    const char* sources[] = {
        R"(sources=[{"center":[0.4,0.6,0.25],"width":0.2,"height":0.2,"velocity":0.7}])",
        R"(sources=[{"center":[0.3,0.4,0.25],"normal":[1,0,0],"width":0.13,"height":0.2,)"
        R"("flow":0.06}])",
        R"(sources=[{"center":[0.4,0.5,0.25],"normal":[2,1,0],"width":0.2,"velocity":1.5,)"
        R"("profile":"parabolic"}])",
        R"(sources=[{"mouth":"disc","center":[0.4,0.4,0.25],"normal":[1,-1,0.5],"radius":0.1,)"
        R"("velocity":1,"profile":"parabolic","start":0.02},)"
        R"({"center":[0.6,0.3,0.25],"normal":[0,-1,0],"flow":0.004,"stop":0.1}])"};
    for (const Formulation f : Formulations)
        for (const int d : {2, 3})
            for (const char* source : sources)
                for (const char* cfl : {"time.cfl=0.4", "time.cfl=0.1"}) {
                    if (d == 2 && std::string(source).find("disc") != std::string::npos) continue;
                    const Scene s = sceneOf(f, d, {source, cfl});
                    const double time = 0.15, mass = particleMass(s);
                    double wanted = 0, layer = 0;
                    for (const Source& one : s.sources) {
                        const SourceLattice lattice = latticeOf(s, one);
                        wanted +=
                            s.fluid.restDensity * lattice.area * wayAt(scheduleOf(s, one), time);
                        layer += mass * double(lattice.points.size());
                    }
                    const auto simulation = makeSimulation(s);
                    const int before = simulation->fluidCount();
                    runTo(*simulation, time);
                    const Measurement m = simulation->measure();
                    layer += m.dt * wanted / (0.5 * time);  // of the next step's beginning
                    EXPECT_NEAR(m.massIn, wanted, layer) << nameOf(s) << " " << source;
                    EXPECT_GT(m.massIn, 0) << nameOf(s) << " " << source;
                    EXPECT_EQ(mass * (simulation->fluidCount() - before), m.massIn);
                    EXPECT_EQ(divergence(s, m), "") << nameOf(s) << " " << source;
                }
}

TEST(Sources, LetFluidGoWithTheVelocityAskedFor) {
    for (const Formulation f : Formulations) {
        const Scene s = sceneOf(f, 2,
                                {R"(sources=[{"center":[0.4,0.6,0],"width":0.2,"velocity":2}])",
                                 "simulation.gravity=0,0,0"});
        const auto simulation = makeSimulation(s);
        runTo(*simulation, 0.15);
        int free = 0;
        for (const Particle& p : simulation->particles()) {
            const bool held = p.position.y > 0.6 + 1e-3;
            free += !held;
            EXPECT_NEAR(p.velocity.y, -2, held ? 1e-6 : 0.05) << nameOf(s);
            EXPECT_NEAR(p.velocity.x, 0, held ? 1e-6 : 0.05) << nameOf(s);
        }
        EXPECT_GT(free, 20) << nameOf(s);
    }
}

// A tap, a tank and its drain, for long enough that most of what was there has left.
Scene tankOf(Formulation f, int dimensions) {
    return sceneOf(f, dimensions,
                   {R"(sources=[{"center":[0.2,0.6,0.25],"width":0.2,"height":0.2,"velocity":1}])",
                    R"(sinks=[{"min":[0.6,-1,0],"max":[1,0.1,0.5]}])",
                    R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.8,0.2,0.5]}])"});
}

TEST(Sources, NoIdIsUsedTwiceAndWhatIsThereIsWhatCameLessWhatLeft) {
    for (const Formulation f : Formulations)
        for (const int d : {2, 3}) {
            const Scene s = tankOf(f, d);
            const auto simulation = makeSimulation(s);
            const int before = simulation->fluidCount();
            std::set<int> gone, there;
            for (const Particle& p : simulation->particles()) there.insert(p.id);
            while (simulation->clock().time < 0.5) {
                simulation->step();
                std::set<int> now;
                for (const Particle& p : simulation->particles()) {
                    EXPECT_FALSE(gone.contains(p.id)) << nameOf(s) << ": " << p.id << " is back";
                    EXPECT_TRUE(now.insert(p.id).second) << nameOf(s) << ": twice " << p.id;
                }
                for (const int id : there)
                    if (!now.contains(id)) gone.insert(id);
                there = now;
            }
            const Measurement m = simulation->measure();
            EXPECT_GT(gone.size(), 10u) << nameOf(s);
            EXPECT_NEAR(m.massOut / double(particleMass(s)), double(gone.size()), 1e-3);
            EXPECT_NEAR(before + (m.massIn - m.massOut) / double(particleMass(s)),
                        simulation->fluidCount(), 1e-3)
                << nameOf(s);
            EXPECT_EQ(int(there.size()), simulation->fluidCount());
            EXPECT_EQ(simulation->particle(*there.rbegin()).id, *there.rbegin());
            EXPECT_THROW(simulation->particle(*gone.begin()), Error);
            for (const int id : there) {
                const std::optional<Particle> found = simulation->find(id);
                ASSERT_TRUE(found.has_value()) << nameOf(s) << ": " << id;
                EXPECT_EQ(found->id, id);
            }
            for (const int id : gone) EXPECT_FALSE(simulation->find(id)) << nameOf(s);
        }
}

TEST(Sources, GoOnFromAStateWithTheSameBitsForAnyNumberOfThreads) {
    for (const Formulation f : Formulations)
        for (const Integrator i : {Integrator::SymplecticEuler, Integrator::VelocityVerlet,
                                   Integrator::PredictorCorrector, Integrator::Split}) {
            Scene s = tankOf(f, 2);
            s.time.integrator = i;
            if (i == Integrator::Split && f != Formulation::DeltaSph) continue;
            if (i != Integrator::SymplecticEuler && f == Formulation::Incompressible) continue;
            const auto whole = makeSimulation(s);
            while (whole->clock().time < 0.25) whole->step();
            const RunState half = whole->state();
            s.compute.threads = 3;
            const auto rest = makeSimulation(s, half);
            expectSame(half, rest->state(), nameOf(s));
            whole->restart(half);
            for (int k = 0; k < 120; ++k) whole->step(), rest->step();
            expectSame(whole->state(), rest->state(), nameOf(s));
            EXPECT_GT(whole->state().sources.came, half.sources.came);
            EXPECT_GT(whole->state().sources.left, half.sources.left);
            EXPECT_EQ(divergence(s, whole->measure()), "") << nameOf(s);
        }
}

// With obstacles behind and beside what is held; without them a run says so.
TEST(Sources, AreCalmUnderWater) {
    const char* const tap =
        R"(sources=[{"center":[0.4,0.3,0.25],"normal":[1,0,0],"velocity":0.3}])";
    const char* const housing =
        R"(solids=[{"shape":"block","min":[0.1,0.35,0],"max":[0.4,0.45,0.5]},
        {"shape":"block","min":[0.1,0.15,0],"max":[0.4,0.25,0.5]},
        {"shape":"block","min":[0.1,0.25,0],"max":[0.25,0.35,0.5]}])";
    const char* const pool = R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.8,0.6,0.5],)"
                             R"("pressure":"hydrostatic"}])";
    for (const Formulation f : Formulations) {
        const Scene s = sceneOf(f, 2, {pool, tap, housing});
        EXPECT_TRUE(Validity(s).remarks().empty()) << Validity(s).remarks()[0].text;
        const auto simulation = makeSimulation(s);
        double fastest = 0;
        while (simulation->clock().time < 0.6) {
            simulation->step();
            const Measurement m = simulation->measure();
            fastest = std::max(fastest, m.maxSpeed);
            ASSERT_EQ(divergence(s, m), "") << nameOf(s);
        }
        // wcsph begins without the depth's pressure.
        EXPECT_LT(fastest, 0.25 * std::sqrt(2 * 9.81 * 0.6)) << nameOf(s);
        EXPECT_GT(simulation->measure().massIn, 0);
        const auto bare = Validity(sceneOf(f, 2, {pool, tap})).remarks();
        ASSERT_EQ(bare.size(), 1u);
        EXPECT_EQ(bare[0].text.find("sources[0]: fluid lies behind its mouth"), 0u) << bare[0].text;
    }
}

TEST(Sources, StopWhenTheDomainIsFull) {
    const Scene s =
        sceneOf(Formulation::Wcsph, 2,
                {R"(sources=[{"center":[0.4,0.6,0.25],"width":0.4,"velocity":2}])",
                 R"(fluid.bodies=[{"shape":"block","min":[0,0,0],"max":[0.8,0.4,0.5]}])"});
    const auto simulation = makeSimulation(s);
    EXPECT_EQ(simulation->measure().massMissed, 0);
    runTo(*simulation, 0.5);
    const Measurement m = simulation->measure();
    EXPECT_GT(m.massMissed, 0);
    EXPECT_LE(simulation->fluidCount(), mostFluid(s, 300) + 8);
    EXPECT_NEAR(m.massIn + m.massMissed, 1000 * 0.4 * 2 * 0.5, 1000 * 0.4 * 0.05);
}

TEST(Sources, VerticesAreThoseOfTheParticlesThatAreThere) {
    Scene s = tankOf(Formulation::DeltaSph, 2);
    setKnob(s, R"(solids=[{"shape":"block","min":[0.4,0.3,0],"max":[0.6,0.4,0.5]}])");
    const auto simulation = makeSimulation(s);
    simulation->step(80);
    const int fluid = simulation->fluidCount(), walls = simulation->wallCount();
    std::vector<Vertex> vertices(size_t(fluid + walls), Vertex{-9, -9, -9, -9});
    simulation->writeVertices({vertices.data(), hostMemory}, ColorBy::Id, walls);
    std::set<int> shown, there;
    for (int i = 0; i < fluid; ++i) shown.insert(int(vertices[size_t(i)].value));
    for (const Particle& p : simulation->particles()) there.insert(p.id);
    EXPECT_EQ(shown, there);
    const auto ofSolid = [](const Vertex& v) { return v.value == 1; };
    EXPECT_EQ(std::count_if(vertices.begin() + fluid, vertices.end(), ofSolid),
              simulation->solidParticleCount());
    EXPECT_TRUE(std::none_of(vertices.begin(), vertices.end(),
                             [](const Vertex& v) { return v.value == -9; }));
}

TEST(Sources, ATapRunsForAMinute) {
    Scene s = sceneOf(Formulation::Incompressible, 2,
                      {R"(sources=[{"center":[0.2,0.6,0],"width":0.1,"velocity":0.5}])",
                       R"(sinks=[{"min":[0.6,-1,0],"max":[1,0.1,0.5]}])", "output.time=60"});
    const auto simulation = makeSimulation(s);
    int most = 0;
    while (simulation->clock().time < 60) {
        simulation->stopAt(60);
        simulation->step();
        most = std::max(most, simulation->fluidCount());
    }
    const Measurement m = simulation->measure();
    EXPECT_EQ(divergence(s, m), "");
    EXPECT_NEAR(m.massIn, 1000 * 0.1 * 0.5 * 60, 1000 * 0.1 * 0.05);
    EXPECT_EQ(m.massMissed, 0);
    EXPECT_LT(most, 256);
    EXPECT_GT(m.massOut, 0.9 * m.massIn);
}

}  // namespace
}  // namespace spindrift
