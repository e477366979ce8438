// The simulation, written once for any device and any lanes. Included by simulation_simd.cpp,
// simulation_double.cpp and simulation_cuda.cu, and by nothing else.
#if defined(SPINDRIFT_SIM_SIMULATION_ON_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SPINDRIFT_SIM_SIMULATION_ON_H
#undef SPINDRIFT_SIM_SIMULATION_ON_H
#else
#define SPINDRIFT_SIM_SIMULATION_ON_H
#endif

#include "device/buffer.h"
#include "sim/constants.h"
#include "sim/output_passes.h"
#include "sim/particle_set.h"
#include "sim/passes.h"
#include "sim/search.h"
#include "sim/simulation.h"

#include <chrono>
#include <numeric>
#include <string>

namespace spindrift::LANES {

template <class Device> class SimulationOn final : public Simulation {
public:
    SimulationOn(const Scene& scene, const Placement& placement, Device device, std::string deviceName)
        : device_(std::move(device)), deviceName_(std::move(deviceName)), scene_(scene),
          fluidCount_(int(placement.positions.size())), wallCount_(int(placement.walls.size())),
          extent_(extentOf(placement)),
          grid_(makeGrid(scene, placement.positions.size() + placement.walls.size())) {
        fluid_.upload(placement.positions, placement.velocities, 0);
        walls_.upload(placement.walls, {}, fluidCount_);
        state_.resize(1);
        const StepState start;
        device_.upload(state_.data(), &start, 1);
        extremes_.resize(1);
        apply(scene);
        placeWalls();
        // Density and acceleration of the first picture.
        for (Row& row : plan_)
            if (row.initial) (this->*row.run)();
    }

    void apply(const Scene& scene) override {
        scene_ = scene;
        withKernel([&](auto kernel) {
            using K = decltype(kernel);
            constants_ = makeConstants<K>(scene_, extent_);
            makePlan<K>();
        });
    }
    void stir(const Stir& s) override {
        stir_ = s;
        apply(scene_);
    }

    void step(int count) override {
        for (int k = 0; k < count; ++k)
            for (Row& row : plan_) {
                const auto start = std::chrono::steady_clock::now();
                (this->*row.run)();
                row.time->ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
                ++row.time->runs;
            }
    }

    int fluidCount() const override { return fluidCount_; }
    int wallCount() const override { return wallCount_; }
    std::string deviceName() const override { return deviceName_; }

    Range writeVertices(Vertex* out, ColorBy by, bool withWalls) override {
        const View v = view();
        ValueRange unused;
        if (withWalls) device_.reduce(v.walls.slots, WriteVertices<PlainValue>{v.walls, out}, &unused);
        switch (by) {
            case ColorBy::Plain: return write<PlainValue>(v.fluid, out);
            case ColorBy::Velocity: return write<SpeedValue>(v.fluid, out);
            case ColorBy::Pressure: return write<PressureValue>(v.fluid, out);
            case ColorBy::Density: return write<DensityValue>(v.fluid, out);
            case ColorBy::Acceleration: return write<AccelerationValue>(v.fluid, out);
            case ColorBy::Id: return write<IdValue>(v.fluid, out);
        }
        return {0, 0};
    }

    Measurement measure() override;
    std::vector<Particle> particles() override { return fluid_.download(fluidCount_, scene_.domain.min); }
    Particle particle(int id) override { return fluid_.downloadOne(id, scene_.domain.min); }

    std::vector<PassTime> times() const override {
        std::vector<PassTime> rows;
        for (const PassTime& t : times_)
            if (t.runs > 0) rows.push_back(t);
        return rows;
    }
    void resetTimes() override {
        for (PassTime& t : times_) t.ms = 0, t.runs = 0;
    }

private:
    struct Row {
        const char* name;
        void (SimulationOn::*run)();
        bool initial = false;        // also run before the first step, so that there is something to see
        PassTime* time = nullptr;
    };

    // The passes that this scene needs, in order. What it doesn't need isn't in the list.
    template <class K> void makePlan() {
        plan_.clear();
        plan_.push_back({"sort", &SimulationOn::sortFluid, true});
        if (keepsLists) plan_.push_back({"neighbours", &SimulationOn::findNeighbours, true});
        plan_.push_back({"density", &SimulationOn::template onFluid<ComputeDensity<K>>, true});
        if (wallsCarryPressure())
            plan_.push_back({"wall pressure", &SimulationOn::template onWalls<ExtrapolateWallPressure<K>>, true});
        plan_.push_back({"forces", chooseTerms(scene_, [](auto terms) { return forces<K>(terms); },
                                               TermList<PressureForce>{}, OptionalTerms{}), true});
        if (keepsLists || constants_.fixedStep <= 0) plan_.push_back({"extremes", &SimulationOn::findExtremes});
        plan_.push_back({"time step", &SimulationOn::chooseTimeStep});
        if (stir_.radius > 0) plan_.push_back({"stir", &SimulationOn::template onFluid<StirFluid>});
        plan_.push_back({"integrate", &SimulationOn::template onFluid<Integrate>});
        for (Row& row : plan_) row.time = timeOf(row.name);
    }
    template <class K, class... Ts> static auto forces(TermList<Ts...>) {
        return &SimulationOn::template onFluid<ComputeForces<K, TermList<Ts...>>>;
    }
    template <class F> void withKernel(F f) {
        scene_.simulation.kernel == Kernel::WendlandC2 ? f(WendlandC2Kernel{}) : f(CubicSplineKernel{});
    }
    // Times survive a change of plan.
    PassTime* timeOf(const char* name) {
        for (PassTime& t : times_)
            if (t.name == name) return &t;
        times_.reserve(16);   // rows point into it
        CHECK(times_.size() < times_.capacity());
        return &times_.emplace_back(PassTime{name, 0, 0});
    }

    bool wallsCarryPressure() const { return wallCount_ > 0 && scene_.simulation.formulation == Formulation::Wcsph; }
    template <class Pass> void onFluid() { device_.forEach(fluid_.slots(), Pass{view()}); }
    template <class Pass> void onWalls() { device_.forEach(walls_.slots(), Pass{view()}); }
    // Order and lists hold until two particles may have come closer by the skin.
    bool nothingMovedFar() const { return keepsLists && travel_ < skin() / 2; }
    float skin() const { return scene_.compute.skin * supportRadius(scene_); }
    void sortFluid() {
        if (!nothingMovedFar()) fluid_.sort(grid_);
    }
    void findNeighbours() {
        if (nothingMovedFar()) return;
        const float reach = supportRadius(scene_) + skin();
        boxes_.compute(device_, fluid_.view());
        fluidNearFluid_.build(device_, grid_, reach, boxes_, fluid_.view(), boxes_, fluid_.cellStart());
        wallsNearFluid_.build(device_, grid_, reach, boxes_, fluid_.view(), wallBoxes_, walls_.cellStart());
        if (wallsCarryPressure())
            fluidNearWalls_.build(device_, grid_, reach, wallBoxes_, walls_.view(), boxes_, fluid_.cellStart());
        travel_ = 0;
    }
    void findExtremes() { device_.reduce(fluid_.slots(), FindExtremes{fluid_.view()}, extremes_.data()); }
    void chooseTimeStep() {
        device_.forEach(1, ChooseTimeStep{view(), extremes_.data()});
        if (keepsLists) travel_ += state_.data()->dt * largestSpeed(state_.data()->dt);
    }
    // Of any particle at the end of a step of length dt, stirring included.
    double largestSpeed(double dt) const {
        const Extremes& e = *extremes_.data();
        return std::max<double>(std::sqrt(e.speed2), length(stir_.velocity)) + dt * std::sqrt(e.acceleration2);
    }

    // Walls never move: sorted once, and their masses stay.
    void placeWalls() {
        walls_.sort(grid_);
        wallBoxes_.compute(device_, walls_.view());
        wallsNearWalls_.build(device_, grid_, supportRadius(scene_), wallBoxes_, walls_.view(), wallBoxes_, walls_.cellStart());
        withKernel([&](auto kernel) {
            device_.forEach(walls_.slots(), ComputeWallMass<decltype(kernel)>{view()});
        });
        wallsNearWalls_ = {};
    }

    View view() {
        View v{fluid_.view(), walls_.view(),
               {fluidNearFluid_.data(), fluid_.cellStart(), fluid_.view().position},
               {wallsNearFluid_.data(), walls_.cellStart(), walls_.view().position},
               {fluidNearWalls_.data(), fluid_.cellStart(), fluid_.view().position},
               {wallsNearWalls_.data(), walls_.cellStart(), walls_.view().position},
               grid_, constants_, state_.data()};
        v.c.stirCenter = toVector(stir_.center - scene_.domain.min);
        v.c.stirVelocity = toVector(stir_.velocity);
        v.c.stirRadius = stir_.radius;
        return v;
    }
    template <class Value> Range write(const Particles& p, Vertex* out) {
        ValueRange range;
        device_.reduce(p.slots, WriteVertices<Value>{p, out}, &range);
        if (!(range.high > range.low)) return {range.low, range.high};
        Histogram histogram;
        device_.reduce(p.slots, CountValues<Value>{p, range}, &histogram);
        return withoutOutliers(range, histogram);
    }
    static Range withoutOutliers(ValueRange range, const Histogram& h) {
        const int all = std::accumulate(h.count, h.count + Histogram::bins, 0), outliers = all / 200;
        int low = 0, high = Histogram::bins - 1;
        for (int n = h.count[low]; n <= outliers && low < high; n += h.count[low]) ++low;
        for (int n = h.count[high]; n <= outliers && high > low; n += h.count[high]) --high;
        const float bin = (range.high - range.low) / (Histogram::bins - 1);
        return {range.low + bin * float(low), std::min(range.high, range.low + bin * float(high + 1))};
    }

    Device device_;
    std::string deviceName_;
    Scene scene_;
    Stir stir_;
    int fluidCount_, wallCount_;
    FluidExtent extent_;
    Grid grid_;
    Constants constants_{};
    std::vector<Row> plan_;
    std::vector<PassTime> times_;
    ParticleSet<Device> fluid_{device_, Kind::Fluid}, walls_{device_, Kind::Walls};
    Buffer<StepState, Device> state_{device_};
    Buffer<Extremes, Device> extremes_{device_};
    static constexpr bool keepsLists = clusterSize > 1;
    double travel_ = 1e30;      // m, bound of any particle's way since the lists were built
    Boxes boxes_, wallBoxes_;
    NeighbourLists fluidNearFluid_, wallsNearFluid_, fluidNearWalls_, wallsNearWalls_;
};

template <class Device> Measurement SimulationOn<Device>::measure() {
    Totals t;
    device_.reduce(fluid_.slots(), SumUp{fluid_.view(), scene_.fluid.restDensity}, &t);
    StepState state;
    device_.download(&state, state_.data(), 1);
    const double n = fluidCount_, mass = particleMass(scene_), rho0 = scene_.fluid.restDensity;
    const Vec3d center = (1 / n) * Vec3d{t.position[0], t.position[1], t.position[2]};
    Measurement m;
    m.time = state.time, m.dt = state.dt, m.steps = state.steps;
    m.kineticEnergy = mass * t.speed2 / 2;
    m.potentialEnergy = mass * n * dot(-1.0 * toDouble(scene_.simulation.gravity), center) + 0.0;   // no minus zero
    m.momentum = mass * Vec3d{t.velocity[0], t.velocity[1], t.velocity[2]};
    m.centerOfMass = center + toDouble(scene_.domain.min);
    m.meanDensity = t.density / n;
    m.densityError = t.compression / n;
    m.maxDensityError = t.maxDensity / rho0 - 1;
    m.maxSpeed = std::sqrt(t.maxSpeed2);
    m.finite = t.notFinite == 0;
    return m;
}

}  // namespace spindrift::LANES

#endif
