// The simulation, written once for any device and any lanes: fluid, what else a scene may have, and
// the plan of its steps.
#pragma once

#include "sim/parts/block_time_steps.h"
#include "sim/parts/energy_balance.h"
#include "sim/parts/floating.h"
#include "sim/step/flow.h"
#include "sim/particles/measure.h"
#include "sim/parts/objects.h"
#include "sim/particles/picture.h"
#include "sim/parts/rare_forces.h"
#include "sim/parts/solids.h"
#include "sim/parts/sources.h"
#include "sim/step/step.h"
#include "sim/step/step_runner.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace spindrift::LANES {

template <class Device> class SimulationOn final : public Simulation {
public:
    SimulationOn(const Scene& scene, const RunState& state, Device device, std::string deviceName)
        : deviceName_(std::move(deviceName)), flow_(scene, state, std::move(device)) {
        flow_.fastestPart = [this] {
            double most = 0;
            forEachPart(parts(), [&](auto& part) { most = std::max(most, part.fastestSpeed()); });
            return most;
        };
        apply(scene);
        solids_.weighWalls();
        restart(state);
    }

    // --- steps ---

    void restart(const RunState& state) override {
        require(
            int(state.particles.positions.size()) == flow_.fluidCount || comesAndGoes(flow_.scene),
            "restart: the state has another number of particles than the run");
        flow_.uploadFluid(state);
        if (factsOf(flow_.scene).solvesPressure) flow_.fluid.setPressures(flow_.pressuresOf(state));
        flow_.fillMixture();
        StepState clock = state.clock;
        clock.speed = 0;  // a checkpoint doesn't know it
        flow_.setClock(clock);
        known_ = false, seen_ = clock, asked_ = clock.steps;
        if constexpr (Device::recordsSteps) flow_.device.dropGlance();
        blocks_.wake();
        if (std::any_of(state.solids.begin(), state.solids.end(),
                        [](const SolidMotion& m) { return m.dragged != Vec3d{}; }))
            letSolidsMove();
        if (solids_.moves()) flow_.uploadWalls();
        forEachPart(parts(), [&](auto& part) { part.restart(state); });
        flow_.search.outdate();
        runner_.runInitial();  // there is something to see
        if (energy_.isOn()) energy_.begin(measureFluid(flow_, fluidCount()));
    }
    void apply(const Scene& scene) override {
        if (const std::string why = whyNotForGpus(scene); Device::recordsSteps && !why.empty())
            throw Error(Failure::NoDevice, why + "; or use --backend cpu");
        refresh(scene);
        flow_.fillMixture();
        blocks_.wake();
    }
    void stir(const Stir& s) override {
        const bool stirred = flow_.stir.radius > 0;
        flow_.setStir(s);
        if (stirred != (s.radius > 0)) refresh(flow_.scene);
    }
    void hold(const Hold& h) override {
        require(h.solid < solids_.count(), "hold: the scene has no solid of that number");
        if (h.solid >= 0) letSolidsMove();
        if (floating_.hold(h)) refresh(flow_.scene);
    }
    void drive(ObjectDriver* driver) override {
        require(objects_.count() > 0, "drive: the scene has no elastic objects");
        require(!driver || driver->interval() > 0, "drive: the driver's interval must be above 0");
        objects_.drive(driver);
        refresh(flow_.scene);
    }
    void stopAt(double time) override { flow_.stopAt(time); }
    void step(int count) override {
        for (int k = 0; k < count; ++k) stepOnce();
    }
    std::vector<double> timeSteps(int count) override {
        return flow_.device.timeEach(count, [&] { stepOnce(); });
    }
    void wait() override {
        if constexpr (Device::recordsSteps) know();
    }

    // --- what it is like ---

    int fluidCount() override {
        if constexpr (!Device::hostReadable) know();
        return sources_.count();
    }
    int wallCount() const override { return flow_.wallCount; }
    int solidParticleCount() const override {
        return std::accumulate(flow_.solidSizes.begin(), flow_.solidSizes.end(), 0);
    }
    int objectParticleCount() const override { return objects_.count(); }
    std::vector<SolidPose> solidPoses() override {
        know();
        return solids_.poses();
    }
    int solidAt(Vec3d point) override {
        know();
        return solids_.at(point);
    }

    Range writeVertices(VertexMemory out, ColorBy by, int walls) override {
        if (out.device == flow_.device.index()) return writeVertices(out.data, by, walls);
        require(out.device == hostMemory, "writeVertices: memory of a device that doesn't step");
        const int count = fluidCount() + walls + objects_.count();
        staging_.resize(count);
        const Range range = writeVertices(staging_.data(), by, walls);
        flow_.device.download(out.data, staging_.data(), count);
        return range;
    }
    Measurement measure() override {
        Measurement m = measureFluid(flow_, fluidCount());
        countSteps(m, clock(), blocks_.areOn(), fluidCount());
        countComers(m, flow_.scene, sources_.tally());
        m.solvesPressure = factsOf(flow_.scene).solvesPressure;
        if (m.solvesPressure) m.solve = solver_.report();
        solids_.measure(m);
        energy_.measure(m);
        return m;
    }
    StepState clock() override {
        if constexpr (Device::hostReadable) return flow_.readClock();
        know();
        return seen_;
    }
    bool hasReached(double time) override {
        const double nearly = time * (1 - 1e-9);
        return mayBeAt(nearly) && clock().time >= nearly;
    }
    RunState state() override {
        RunState s;
        s.particles.walls = flow_.wallsAtHome, s.particles.solidSizes = flow_.solidSizes;
        s.particles.bodies = flow_.bodies;
        s.start = flow_.extent;
        if constexpr (!Device::hostReadable) look();
        flow_.fluid.save(s);
        s.clock = clock();
        forEachPart(parts(), [&](auto& part) { part.save(s); });
        return s;
    }
    std::vector<Particle> particles() override {
        return flow_.fluid.download(flow_.scene.domain.min);
    }
    std::optional<Particle> find(int id) override {
        return flow_.fluid.downloadOne(id, flow_.scene.domain.min);
    }
    Particle particle(int id) override {
        const std::optional<Particle> found = find(id);
        require(found.has_value(), "particle: the run has none of that number");
        return *found;
    }

    // --- what it costs ---

    std::string deviceName() const override { return deviceName_; }
    int cudaDevice() const override { return flow_.device.index(); }
    void* cudaStream() const override { return flow_.device.stream(); }
    PairsSeen pairsSeen() override { return flow_.search.pairsSeen(); }
    std::vector<PlanRow> plan() const override { return runner_.plan().told(); }
    std::vector<PassTime> times() override { return runner_.times(); }
    void resetTimes() override { runner_.resetTimes(); }
    int64_t bytes() const override {
        return flow_.device.bytes() + flow_.search.bytes() + objects_.bytes();
    }

private:
    static void require(bool sound, const char* otherwise) {
        if (!sound) throw Error(Failure::Usage, otherwise);
    }
    auto parts() {
        return std::tie(sources_, tension_, mixing_, solids_, floating_, objects_, resistance_,
                        blocks_, energy_);
    }
    void refresh(const Scene& scene) {
        const bool halfListsBefore = flow_.usesHalfLists();
        flow_.scene = scene;
        if (flow_.usesHalfLists() != halfListsBefore) flow_.search.outdate();
        flow_.model = makeModel(flow_.scene, flow_.extent);
        StepParameters& c = flow_.model.shared;
        c.maxStep = min(c.maxStep, real(longestStepOf(flow_.model, OptionalTerms{})));
        forEachPart(parts(), [&](auto& part) { part.refresh(); });
        forEachPart(parts(),
                    [&](auto& part) { c.maxStep = min(c.maxStep, real(part.longestStep())); });
        const double step = flow_.longestStep();
        longest_ = std::max(longest_, step);
        forEachPart(parts(), [&](auto& part) { part.knowLongestStep(step); });
        flow_.addBuffers();
        flow_.fluid.weighViscosity(!*whyViscosityIsNotWeighed(flow_));
        withCompiledKernel(scene.simulation.kernel, [&](auto kernel) {
            using Maker = StepMaker<Device, decltype(kernel), decltype(parts())>;
            runner_.take(Maker(flow_, blocks_, solver_, parts()).plan());
        });
    }
    // What the host may ask for between steps is fetched from a GPU together, and waited for once.
    void look() {
        if (known_) return;
        flow_.device.fetch(&seen_, flow_.clock.data(), 1);
        sources_.look(), solids_.look();
        known_ = Device::recordsSteps;
    }
    void know() {
        look();
        flow_.device.wait();
        if constexpr (Device::recordsSteps) flow_.device.dropGlance();  // it is older
        asked_ = seen_.steps, longest_ = flow_.longestStep();
    }
    // Whether the run may be at that time, s, by what is known of the GPU's clock without waiting:
    // where it stood some steps ago, and how long they can have been.
    bool mayBeAt(double time) {
        if constexpr (Device::recordsSteps)
            if (!known_) {
                flow_.device.glance(&seen_, flow_.clock.data());
                return seen_.time + (double(asked_ - seen_.steps) + 1e-3) * longest_ >= time;
            }
        return true;
    }
    void letSolidsMove() {
        if (solids_.letMove()) refresh(flow_.scene);
    }
    void stepOnce() {
        const bool still = flow_.stir.radius <= 0 && !solids_.moves();
        if (still && blocks_.letTimePass()) return;
        flow_.device.step([&] { runner_.run(); });
        known_ = false, ++asked_;
        if (objects_.isDriven() && mayBeAt(objects_.arrival())) objects_.exchange(clock().time);
    }
    Range writeVertices(Vertex* out, ColorBy by, int walls) {
        const View v = flow_.view();
        const int fluid = fluidCount(), firstWall = flow_.fluidCount, endWall = firstWall + walls;
        if (walls > 0)
            flow_.device.forEach(v.walls.slots,
                                 WriteWallVertices{v, solids_.home(), out + (fluid - firstWall),
                                                   firstWall + solidParticleCount(), endWall});
        objects_.writeVertices(out + fluid + walls, flow_.scene.simulation.spacing);
        return writeFluid(flow_, {out, sources_.vertexNumbers()}, by);
    }

    std::string deviceName_;
    Flow<Device> flow_;
    Sources<Device> sources_{flow_};
    SurfaceTension<Device> tension_{flow_};
    MixingForces<Device> mixing_{flow_};
    Solids<Device> solids_{flow_};
    Floating<Device> floating_{flow_, solids_};
    Objects<Device> objects_{flow_, solids_, floating_};
    Resistance<Device> resistance_{flow_};
    BlockTimeSteps<Device> blocks_{flow_};
    EnergyBalance<Device> energy_{flow_, solids_};
    PressureSolver<Device> solver_{flow_};
    StepRunner<Device> runner_{flow_.device, {&flow_.fluid, &flow_.walls, &objects_.surfaceSet()}};
    bool known_ = false;                            // what look() asks for, since the last step
    StepState seen_;                                // the clock, some steps ago
    int64_t asked_ = 0;                             // steps of the run, until now
    double longest_ = 0;                            // s, that any of them since then can have had
    Buffer<Vertex, Device> staging_{flow_.device};  // for vertices that the host is to have
};

}  // namespace spindrift::LANES
