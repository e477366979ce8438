// What every pass works on: fluid and walls on one device, how their neighbours are found, what the
// scene comes to, and the clock.
#pragma once

#include "device/buffer.h"
#include "scene/formulation.h"
#include "scene/sources.h"
#include "scene/thin_solid.h"
#include "sim/physics/integrate.h"
#include "sim/neighbours/grid.h"
#include "sim/neighbours/neighbour_search.h"
#include "sim/particles/particle_set.h"
#include "sim/run_state.h"
#include "sim/simulation.h"
#include "sim/physics/model.h"
#include "sim/physics/time_step.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace spindrift::LANES {

template <class Device> struct Flow {
    Flow(const Scene& s, const RunState& state, Device d)
        : device(std::move(d)),
          scene(s),
          extent(state.start),
          fluidCount(int(state.particles.positions.size())),
          wallCount(int(state.particles.walls.size())),
          wallsAtHome(state.particles.walls),
          solidSizes(state.particles.solidSizes),
          bodies(state.particles.bodies),
          solidSamples(state.particles.solids),
          search(device, makeGrid(s, size_t(mostFluid(s, fluidCount)) + size_t(wallCount))) {
        if (solidSamples.empty())  // the run goes on from a checkpoint
            for (const Solid& solid : scene.solids)
                solidSamples.push_back(boundaryOf(scene, solid));
        if (carriesDensity(scene)) fluid.carryDensity();
        if (shiftsParticles(scene)) fluid.shift(), walls.haveDensity();
        if (factsOf(scene).solvesPressure) fluid.solvePressure();
        if (scene.time.integrator == Integrator::VelocityVerlet) fluid.keepVelocity();
        if (scene.time.integrator == Integrator::PredictorCorrector) fluid.keepState();
        uploadWalls();
        clock.resize(1);
        extremes.resize(1), valueRange.resize(1);
        stirring.resize(1);
    }
    Flow(const Flow&) = delete;

    View view() {
        View v{};
        v.fluid = fluid.view(), v.walls = walls.view();
        search.show(v, fluid.cellStart(), walls.cellStart());
        v.c = model.shared;
        v.state = clock.data(), v.stirring = stirring.data();
        v.solids = solids, v.solidCount = solidCount, v.screens = screens;
        v.blocks = blocks;
        if (allActive) v.fluid.active = v.walls.active = nullptr;
        return v;
    }

    // A pass is a struct with a View and operator()(index); it reads neighbours and writes its own
    // particles only, never a field that it gathers. `Index` says how many particles one call works
    // on. What it alone takes from the model are its `Parameters`.
    template <class P> P pass() {
        if constexpr (requires { typename P::Parameters; })
            return {view(), P::Parameters::of(model)};
        else
            return {view()};
    }
    template <class P> void onFluid() { device.forEach(fluid.slots(), pass<P>()); }
    template <class P> void onWalls() { device.forEach(walls.slots(), pass<P>()); }
    // Of lists that hold each pair once where they do, and of all neighbours otherwise.
    template <class P> void onPairsOrFluid() { runOnPairsOrFluid(pass<P>()); }
    template <class P> void runOnPairsOrFluid(const P& pass) {
        if constexpr (NeighbourSearch<Device>::keepsLists)
            if (usesHalfLists()) return search.overPairs(pass);
        device.forEach(fluid.slots(), pass);
    }
    // Of active particles; forces on solids may be asked for at any time.
    void findNeighbours() {
        using Search = NeighbourSearch<Device>;
        search.find(view(), usesHalfLists(),
                    !wallsCarryPressure()                  ? Search::OfWalls::None
                    : solidCount > 0 || asksForWallLoads() ? Search::OfWalls::All
                                                           : Search::OfWalls::Active);
    }
    // Where all that pairs do they do to both: carried density changes at rates that differ, and a
    // limit, which the classic formulation has, is one on a part of the whole.
    bool usesHalfLists() const {
        return NeighbourSearch<Device>::keepsLists && !carriesDensity(scene) &&
               !factsOf(scene).isHistorical && scene.simulation.accelerationLimit <= 0;
    }
    // And look for fluid. Solved pressures are mirrored instead, but solids are told what they
    // feel.
    bool wallsCarryPressure() const {
        const bool asked = !factsOf(scene).solvesPressure || solidCount > 0 || wantsVelocities() ||
                           asksForWallLoads();
        return wallCount > 0 && !factsOf(scene).isHistorical && asked;
    }
    // Whether it is asked for what fluid does to the domain's faces.
    bool asksForWallLoads() const { return scene.output.faceForces || scene.output.energyBalance; }
    bool fluidSticks() const { return wallsCarryPressure() && wantsVelocities(); }
    // Whether terms ask for velocities of walls that make fluid stick.
    bool wantsVelocities() const {
        return isMultiFluid(scene) || scene.simulation.pressureForm == PressureForm::Mean ||
               largestViscosity(scene) > 0 || letsSlip(scene);
    }
    // s, that a step can take.
    double longestStep() const {
        return model.shared.fixedStep > 0
                   ? double(model.shared.fixedStep)
                   : double(min(acousticStep(model.shared, 0), model.shared.maxStep));
    }
    // At the beginning those of the placement, else by the equation of state from the pressures.
    std::vector<float> densitiesOf(const RunState& state) const {
        if (!carriesDensity(scene) || !state.densities.empty()) return state.densities;
        std::vector<float> densities = state.particles.densities;
        for (size_t i = 0; i < densities.size() && !bodies.empty(); ++i)  // of the scene's fluid
            densities[i] *=
                scene.fluid.restDensity / restDensity(scene, scene.fluid.bodies[bodies[i]]);
        for (size_t i = 0; i < state.particles.pressures.size(); ++i) {
            const double power =
                std::max(1 + double(state.particles.pressures[i]) / model.shared.stiffness, 0.1);
            const float density =
                float(model.shared.restDensity * std::pow(power, 1.0 / model.shared.gamma));
            if (i == densities.size()) densities.push_back(density);
            if (densities[i] == 0) densities[i] = density;
        }
        densities.resize(state.particles.positions.size(), float(model.shared.restDensity));
        return densities;
    }
    // p / rho^2 that a solve begins with: at the beginning of a run those of the placement.
    std::vector<float> pressuresOf(const RunState& state) const {
        if (!state.pressures.empty()) return state.pressures;
        std::vector<float> out = state.particles.pressures;
        for (float& p : out) p /= scene.fluid.restDensity * scene.fluid.restDensity;
        return out;
    }
    StepState readClock() const {
        StepState s;
        device.download(&s, clock.data(), 1);
        return s;
    }
    void setClock(const StepState& s) {
        device.upload(clock.data(), &s, 1);
        stop = s.stop;
    }
    void setStir(const Stir& s) {
        stir = s;
        const Stirring now{toVector(s.center - scene.domain.min), toVector(s.velocity), s.radius,
                           s.rate, s.pull};
        device.upload(stirring.data(), &now, 1);
    }
    // Runs ask for the same time step by step, which costs a GPU nothing.
    void stopAt(double time) {
        if (std::exchange(stop, time) != time) device.upload(&clock.data()->stop, &time, 1);
    }
    // A mixture's knobs, particle by particle.
    void fillMixture() {
        if (!isMultiFluid(scene) || fluid.slots() == 0) return;
        CHECK(int(bodies.size()) == fluidCount);
        std::vector<float> ratios, viscosities;
        for (const uint16_t body : bodies) {
            ratios.push_back(restDensity(scene, scene.fluid.bodies[body]) /
                             scene.fluid.restDensity);
            viscosities.push_back(viscosity(scene, scene.fluid.bodies[body]));
        }
        fluid.fillMixture(ratios, viscosities);
    }
    void uploadFluid(const RunState& state) {
        const Placement& p = state.particles;
        p.ids.empty() ? fluid.upload(p.positions, p.velocities, densitiesOf(state), 0)
                      : fluid.upload(p.positions, p.velocities, densitiesOf(state), p.ids);
    }
    void uploadWalls() {
        walls.upload(wallsAtHome, {}, {}, fluidCount);
        walls.setPressures({});  // the classic formulation's keep none
    }
    void addBuffers() {
        fluid.addForces(usesHalfLists() && hasMixingForces(scene),
                        scene.fluid.surfaceTension > 0 || showsFound);
    }

    Device device;
    Scene scene;
    FluidExtent extent;
    int fluidCount, wallCount;      // as it began; walls have ids from fluidCount on
    std::vector<Vec3> wallsAtHome;  // as in Placement
    std::vector<int> solidSizes;
    std::vector<uint16_t> bodies;  // of a mixture: which one each particle is of
    std::vector<SolidSample> solidSamples;
    Model model{&scene};
    Stir stir;
    Buffer<Stirring, Device> stirring{device};
    ParticleSet<Device> fluid{device, Kind::Fluid}, walls{device, Kind::Walls};
    NeighbourSearch<Device> search;
    Buffer<StepState, Device> clock{device};
    double stop = std::numeric_limits<double>::quiet_NaN();  // the clock's, once it has been set
    Buffer<Extremes, Device> extremes{device};
    Buffer<ValueRange, Device> valueRange{device};  // of the last picture
    bool showsFound = false;                        // a picture has asked for what neighbours tell
    // What parts show to all passes.
    SolidState* solids = nullptr;
    int solidCount = 0;
    const Screens* screens = nullptr;
    Blocks blocks{};
    bool allActive = false;                                    // now: flags are needless then
    std::function<double()> fastestPart = [] { return 0.0; };  // m/s
};

// Where it is less than what keeps fluid calm anyway, it makes no difference.
template <class Device> const char* whyViscosityIsNotWeighed(const Flow<Device>& flow) {
    const Scene& scene = flow.scene;
    if (largestViscosity(scene) <= 0 || factsOf(scene).isHistorical)
        return "there is no laminar viscosity";
    if (viscosityForm(scene) != ViscosityForm::Monaghan)
        return "only Monaghan's form of viscosity asks for it";
    if (scene.time.mode == TimeMode::Local) return "steps are local (time.mode)";
    const double nu = largestViscosity(scene) / scene.fluid.restDensity,
                 reach = double(flow.model.shared.soundSpeed) * double(flow.model.shared.support),
                 numerical = std::max(1e-3, scene.fluid.artificialViscosity / 16.0) * reach;
    return nu < numerical ? "viscosity is less than 1e-3 c R, or than the artificial one" : "";
}

}  // namespace spindrift::LANES
