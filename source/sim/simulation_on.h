// The simulation, written once for any device and any lanes. Included by simulation_simd.h,
// simulation_double.cpp and simulation_cuda.cu, and by nothing else.
#pragma once

#include "device/buffer.h"
#include "sim/collisions.h"
#include "sim/step_parameters.h"
#include "sim/floating.h"
#include "sim/integrate.h"
#include "sim/block_time_steps.h"
#include "sim/objects.h"
#include "sim/output_passes.h"
#include "sim/particle_set.h"
#include "sim/passes.h"
#include "sim/search.h"
#include "sim/simulation.h"
#include "sim/solids.h"
#include "sim/surface.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

namespace spindrift::LANES {

template <class Device> class SimulationOn final : public Simulation {
public:
    SimulationOn(const Scene& scene, const RunState& state, Device device, std::string deviceName)
        : device_(std::move(device)),
          deviceName_(std::move(deviceName)),
          scene_(scene),
          fluidCount_(int(state.particles.positions.size())),
          wallCount_(int(state.particles.walls.size())),
          bodies_(state.particles.bodies),
          wallsAtHome_(state.particles.walls),
          solidSizes_(state.particles.solidSizes),
          extent_(state.start),
          grid_(makeGrid(scene, size_t(fluidCount_) + size_t(wallCount_))) {
        if (carriesDensity(scene)) fluid_.carryDensity();
        if (shifts()) fluid_.shift(), walls_.haveDensity();
        if (scene.time.integrator == Integrator::VelocityVerlet) fluid_.keepVelocity();
        if (scene.time.integrator == Integrator::PredictorCorrector) fluid_.keepState();
        walls_.upload(wallsAtHome_, {}, {}, fluidCount_);
        solids_.place(scene, wallsAtHome_, solidSizes_, fluidCount_);
        if (wallsMove()) walls_.move();
        if (solids_.moves()) walls_.accelerate();
        if (solids_.floats())
            solids_.reserveLoads(walls_.slots()),
                floating_.bounces((fluidCount_ + clusterSize - 1) / clusterSize * clusterSize);
        objects_.place(scene, solids_.floats());
        floating_.place(scene);
        if (solids_.count() > 0) fluid_.keepPlace();
        clock_.resize(1);
        extremes_.resize(1);
        apply(scene);
        weighWalls();
        restart(state);
    }

    void restart(const RunState& state) override {
        CHECK(int(state.particles.positions.size()) == fluidCount_);
        fluid_.upload(state.particles.positions, state.particles.velocities, densitiesOf(state), 0);
        fillMixture();
        StepState clock = state.clock;
        clock.speed = 0;  // a checkpoint doesn't know it
        device_.upload(clock_.data(), &clock, 1);
        wake();
        if (std::any_of(state.solids.begin(), state.solids.end(),
                        [](const SolidMotion& m) { return m.place != Vec3d{}; }))
            letSolidsMove();
        if (solids_.moves()) walls_.upload(wallsAtHome_, {}, {}, fluidCount_);
        floating_.restart(scene_, state.solids);
        objects_.restart(scene_, state.objects);
        displacementBound_ = 1e30;
        // Density and acceleration of the first picture.
        for (Row& row : plan_)
            if (row.initial == Initial::Yes) (this->*row.run)();
    }

    void apply(const Scene& scene) override {
        refresh(scene);
        fillMixture();
        wake();
    }
    void stir(const Stir& s) override {
        stir_ = s;
        refresh(scene_);
    }
    void hold(const Hold& h) override {
        CHECK(h.solid < solids_.count());
        if (h.solid >= 0) letSolidsMove();
        if (h.solid != hold_.solid) floating_.letGo(), floating_.takeInHand(scene_, h.solid);
        hold_ = {h.solid, h.target - scene_.domain.min};
        refresh(scene_);
    }
    std::vector<SolidPose> solidPoses() override {
        if (solids_.moves()) moveSolids();
        std::vector<SolidPose> poses;
        auto wide = [](Vector<real> a) { return Vec3d{a.x, a.y, a.z}; };
        for (const SolidState& s : solids_.download())
            poses.push_back({wide(s.middle), {wide(s.axis[0]), wide(s.axis[1]), wide(s.axis[2])}});
        return poses;
    }
    int solidAt(Vec3d point) override {
        const std::vector<SolidState> solids = solids_.download();
        const Vec3d x = point - toDouble(scene_.domain.min);
        for (size_t s = 0; s < solids.size(); ++s) {
            const Vector<real> arm =
                Vector<real>{real(x.x), real(x.y), real(x.z)} - solids[s].middle;
            const Vector<real> own{dot(arm, solids[s].axis[0]), dot(arm, solids[s].axis[1]),
                                   dot(arm, solids[s].axis[2])};
            if (convexOf(scene_.solids[s], scene_.simulation.dimensions)
                    .nearest(Vec3d{double(own.x), double(own.y), double(own.z)})
                    .distance < double(scene_.simulation.spacing))
                return int(s);
        }
        return -1;
    }
    void drive(ObjectDriver* driver) override {
        CHECK(objects_.count() > 0 && (!driver || driver->interval() > 0));
        objects_.drive(driver, clock().time, scene_.domain.min);
        refresh(scene_);
    }
    void stopAt(double time) override { device_.upload(&clock_.data()->stop, &time, 1); }

    void step(int count) override {
        for (int k = 0; k < count; ++k) stepOnce();
    }
    std::vector<double> timeSteps(int count) override {
        return device_.timeEach(count, [&] { stepOnce(); });
    }
    void wait() override { device_.wait(); }

    int fluidCount() const override { return fluidCount_; }
    int wallCount() const override { return wallCount_; }
    std::string deviceName() const override { return deviceName_; }
    int cudaDevice() const override { return device_.index(); }

    int solidParticleCount() const override {
        return std::accumulate(solidSizes_.begin(), solidSizes_.end(), 0);
    }

    int objectParticleCount() const override { return objects_.count(); }

    Range writeVertices(VertexMemory out, ColorBy by, int walls) override {
        if (out.device == device_.index()) return writeVertices(out.data, by, walls);
        CHECK(out.device == hostMemory);
        const int count = fluidCount_ + walls + objects_.count();
        staging_.resize(count);
        const Range range = writeVertices(staging_.data(), by, walls);
        device_.download(out.data, staging_.data(), count);
        return range;
    }

    Measurement measure() override;
    StepState clock() override {
        StepState clock;
        device_.download(&clock, clock_.data(), 1);
        return clock;
    }
    RunState state() override {
        RunState s;
        s.particles = {fluid_.positions(fluidCount_, 0),
                       fluid_.velocities(fluidCount_, 0),
                       wallsAtHome_,
                       {},
                       solidSizes_,
                       {},
                       bodies_};
        s.clock = clock();
        s.start = extent_;
        s.densities = fluid_.densities(fluidCount_);
        if (solids_.moves()) s.solids = floating_.download();
        if (objects_.count() > 0) s.objects = objects_.state();
        return s;
    }
    std::vector<Particle> particles() override {
        return fluid_.download(fluidCount_, scene_.domain.min);
    }
    Particle particle(int id) override { return fluid_.downloadOne(id, scene_.domain.min); }

    PairsSeen pairsSeen() override { return fluidNearFluid_.pairsSeen(); }
    std::vector<PlanRow> plan() const override { return rows_; }
    int64_t bytes() const override {
        int64_t lists = 0;
        for (const NeighbourLists* l : {&fluidNearFluid_, &wallsNearFluid_, &fluidNearWalls_})
            lists += l->bytes();
        return device_.bytes() + lists + objects_.listBytes() + halfListSums_.bytes();
    }

    std::vector<PassTime> times() override {
        device_.collectTimes();
        std::vector<PassTime> rows;
        for (const PassTime& t : times_)
            if (t.runs > 0) rows.push_back(t);
        return rows;
    }
    void resetTimes() override {
        device_.collectTimes();
        for (PassTime& t : times_) t.ms = 0, t.runs = 0;
        measureNext_ = true;
    }

private:
    using PassFunction = void (SimulationOn::*)();
    enum class Initial : bool {
        No,
        Yes
    };  // also run before the first step, so that there is something to see?
    struct Row {
        const char* name;
        PassFunction run;
        Initial initial;
        PassTime* time = nullptr;
    };

    // A mixture's knobs, particle by particle.
    void fillMixture() {
        if (!isMultiFluid(scene_) || fluid_.slots() == 0) return;
        CHECK(int(bodies_.size()) == fluidCount_);
        std::vector<float> ratios, viscosities;
        for (const uint16_t body : bodies_) {
            ratios.push_back(restDensity(scene_, scene_.fluid.bodies[body]) /
                             scene_.fluid.restDensity);
            viscosities.push_back(viscosity(scene_, scene_.fluid.bodies[body]));
        }
        fluid_.fillMixture(ratios, viscosities);
    }
    void refresh(const Scene& scene) {
        const bool before = usesHalfLists();
        scene_ = scene;
        if (usesHalfLists() != before) displacementBound_ = 1e30;  // other lists
        if (letsSlip(scene)) walls_.letSlip();
        if (!*whyFlowEndsAtWalls()) walls_.continueFlow();
        const bool sticksNow = fluidSticks() && walls_.carryVelocity();
        withKernel(scene_.simulation.kernel, [&](auto kernel) {
            using K = decltype(kernel);
            parameters_ = makeStepParameters<K>(scene_, extent_);
            objects_.setLaw(scene_, parameters_.soundSpeed);
            parameters_.maxStep = min(parameters_.maxStep, real(objects_.longestStep()));
            floating_.setSprings(scene_, longestStep());
            makePlan<K>();
        });
        if (solids_.anyThin()) solids_.screen(parameters_);
        addBuffers();
        fluid_.weighViscosity(!*whyViscosityIsNotWeighed());
        fluid_.stepLocally(hasBlockTimeSteps());
        walls_.stepLocally(hasBlockTimeSteps());
        if (hasBlockTimeSteps() && !blockTimeSteps_.used())
            blockTimeSteps_.resize(grid_,
                                   real(2 * supportRadius(scene_) * (1 + scene_.compute.skin)));
        // A face slides at another speed or lets fluid slip, or walls are to know which way they
        // face.
        if (sticksNow || ((wallsMove() || walls_.slips()) && !solids_.moves()))
            solids_.placeWalls(view());
        outdateRecordings();
    }
    void outdateRecordings() {
        if constexpr (Device::recordsSteps)
            for (auto& recording : recordings_) recording.outdate();
    }
    // plan.h: the passes that this scene needs, in order. What it doesn't need isn't in the list.
    template <class K> void makePlan();
    template <class K> void evaluateForces(Initial);
    void chooseStep();
    void moveThings(PassFunction moveSolids);
    struct Names {
        const char *both, *kick, *drift;
    };
    template <class K, unsigned kick, unsigned drift> void advance(Names);
    template <class K> void stepLocally();
    template <class K> void addRate();
    template <class K> PassFunction wallPass() const;
    template <class K> PassFunction forcePass() const;
    template <class K, ViscosityForm form> PassFunction forcesOf() const;
    template <class K> PassFunction loadPass() const;
    template <class K> PassFunction ratePass() const;
    void addPass(const char* name, PassFunction run, Initial initial = Initial::No,
                 const char* skipped = "") {
        const bool said = std::any_of(rows_.begin(), rows_.end(), [&](const PlanRow& r) {
            return r.name == name && !r.skipped.empty();
        });
        if (!said) rows_.push_back({name, skipped});
        if (!*skipped) plan_.push_back({name, run, initial});
    }
    // Of lists that hold each pair once where they do, and of all neighbours otherwise.
    template <class Pass> PassFunction pairPass() const {
        if constexpr (keepsLists)
            if (usesHalfLists()) return &SimulationOn::template onPairs<Pass>;
        return &SimulationOn::template onFluid<Pass>;
    }
    // Where all that pairs do they do to both: carried density changes at rates that differ, and a
    // limit, which the classic formulation has, is one on a part of the whole.
    bool usesHalfLists() const {
        return keepsLists && !carriesDensity(scene_) &&
               scene_.simulation.formulation != Formulation::Classic &&
               scene_.simulation.accelerationLimit <= 0;
    }
    bool hasBlockTimeSteps() const { return scene_.time.mode == TimeMode::Local; }
    bool shifts() const { return shiftsParticles(scene_); }
    bool fillsSpace() const {
        return scene_.simulation.formulation == Formulation::TransportVelocity;
    }
    // Or there are terms that would ask.
    bool fluidSticks() const {
        const bool asked =
            isMultiFluid(scene_) || scene_.simulation.pressureForm == PressureForm::Mean;
        return wallsCarryPressure() && (asked || largestViscosity(scene_) > 0 || letsSlip(scene_));
    }
    template <class... Ts> void noteTerms(TermList<Ts...>) {
        (rows_.push_back({std::string("forces: ") + Ts::name, Ts::skipped(scene_)}), ...);
    }
    // Where it is less than what keeps fluid calm anyway, it makes no difference.
    const char* whyViscosityIsNotWeighed() const {
        if (largestViscosity(scene_) <= 0 || scene_.simulation.formulation == Formulation::Classic)
            return "there is no laminar viscosity";
        if (viscosityForm(scene_) != ViscosityForm::Monaghan)
            return "only Monaghan's form of viscosity asks for it";
        if (hasBlockTimeSteps()) return "steps are local (time.mode)";
        const double nu = largestViscosity(scene_) / scene_.fluid.restDensity,
                     reach = double(parameters_.soundSpeed) * double(parameters_.support),
                     numerical = std::max(1e-3, scene_.fluid.artificialViscosity / 16.0) * reach;
        return nu < numerical ? "viscosity is less than 1e-3 c R, or than the artificial one" : "";
    }
    const char* whyNoObjects() const { return objects_.count() > 0 ? "" : "there are no objects"; }
    const char* whyNothingFloats() const {
        return solids_.floats()      ? ""
               : solids_.count() > 0 ? "no solid floats"
                                     : "there are no solids";
    }
    const char* whyFlowEndsAtWalls() const {
        if (!wallsCarryPressure() || !carriesDensity(scene_))
            return "no divergence is asked for at walls";
        return solids_.moves() || letsSlip(scene_) ? "" : "no solid moves, and no wall lets slip";
    }
    const char* whyNoWallPressure() const {
        if (wallCount_ == 0) return "there are no boundary particles";
        return wallsCarryPressure() ? "" : "walls have no pressure in the classic formulation";
    }

    void runPlan() {
        const bool measured = std::exchange(measureNext_, false);
        if constexpr (Device::recordsSteps) {
            if (!measured) return stepFromRecording();
        }
        for (Row& row : plan_) device_.timed(row.time, [&] { (this->*row.run)(); });
    }
    // With local steps the plan leads to the next moment at which anybody is due.
    void stepOnce() {
        if (allRest()) {
            beginStep();
            device_.forEach(1, ChooseSubstep{view(), blockTimeSteps_.motion(), fluidCount_});
            return;
        }
        device_.step([&] {
            do runPlan();
            while (hasBlockTimeSteps() && clock().substep != 0);
        });
        if (objects_.isDriven() && objects_.exchange(clock().time)) outdateRecordings();
    }
    // There is nothing to be done but to let time pass. (A GPU would have to be asked.)
    bool allRest() {
        return !Device::recordsSteps && hasBlockTimeSteps() && clock().allRest &&
               stir_.radius <= 0 && !solids_.moves();
    }
    // One recording for each side of the particles' buffers; walls are sorted only when they move.
    void stepFromRecording() {
        auto& recording = recordings_[4 * objects_.side() + 2 * walls_.side() + fluid_.side()];
        if (device_.replay(recording)) {
            if (sortsInStep_ % 2 == 0) return;
            fluid_.flip();
            if (solids_.moves()) walls_.flip();
            if (objects_.count() > 0) objects_.flip();
            return;
        }
        device_.record(recording, [&] {
            for (Row& row : plan_) (this->*row.run)();
        });
    }
    template <class K, Lists lists, class... Ts> static PassFunction forces(TermList<Ts...>) {
        return &SimulationOn::template onFluid<ComputeForces<K, lists, TermList<Ts...>>>;
    }
    // At the beginning those of the placement, else by the equation of state from the pressures.
    std::vector<float> densitiesOf(const RunState& state) const {
        if (!carriesDensity(scene_) || !state.densities.empty()) return state.densities;
        std::vector<float> densities = state.particles.densities;
        for (size_t i = 0; i < densities.size() && !bodies_.empty();
             ++i)  // those of the scene's fluid
            densities[i] *=
                scene_.fluid.restDensity / restDensity(scene_, scene_.fluid.bodies[bodies_[i]]);
        for (size_t i = 0; i < state.particles.pressures.size(); ++i) {
            const double power =
                std::max(1 + double(state.particles.pressures[i]) / parameters_.stiffness, 0.1);
            const float density =
                float(parameters_.restDensity * std::pow(power, 1.0 / parameters_.gamma));
            if (i == densities.size()) densities.push_back(density);
            if (densities[i] == 0) densities[i] = density;
        }
        densities.resize(state.particles.positions.size(), float(parameters_.restDensity));
        return densities;
    }
    // Times survive a change of plan.
    PassTime* timeOf(const char* name) {
        for (PassTime& t : times_)
            if (t.name == name) return &t;
        times_.reserve(48);  // rows point into it
        CHECK(times_.size() < times_.capacity());
        return &times_.emplace_back(PassTime{name, 0, 0});
    }

    bool wallsCarryPressure() const {
        return wallCount_ > 0 && scene_.simulation.formulation != Formulation::Classic;
    }
    // s, that a step can take.
    double longestStep() const {
        return parameters_.fixedStep > 0
                   ? double(parameters_.fixedStep)
                   : double(min(acousticStep(parameters_, 0), parameters_.maxStep));
    }
    // Those that stood still until now as well: their particles are sorted and placed from here on.
    void letSolidsMove() {
        if (solids_.moves()) return;
        solids_.keepMasses(walls_.view());
        solids_.letMove();
        walls_.accelerate();
        refresh(scene_);
    }
    bool wallsMove() const {
        return solids_.moves() || (wallCount_ > 0 && scene_.walls.movingFace != Face::None);
    }
    template <class Pass> void findLoads() { solids_.template findLoads<Pass>(view()); }
    const RigidBody* whatFloats() const { return solids_.floats() ? floating_.bodies() : nullptr; }
    void touchObjects() {
        const View v = view();
        objects_.touch(v, whatFloats(), floating_.springs());
        if (solids_.floats() && !objects_.isDriven())
            floating_.addTouches(scene_, objects_.count(),
                                 [&](int solid) { return objects_.pressesOn(v, solid); });
    }
    void moveObjects() {
        objects_.move(view(), whatFloats(), hold_.solid);
        if (hold_.solid >= 0 && !objects_.isDriven())
            floating_.feelStops(objects_.count(), objects_.stops());
    }
    void findSolidForces() {
        const View v = view();
        findAllLoads(v);
        floating_.findForces(scene_, v, solids_.home(),
                             [&](int solid) { return solids_.sumOf(v, solid); });
    }
    void findAllLoads(const View& v) {
        (this->*findLoads_)();
        for (int s = 0; s < v.solidCount; ++s)
            if (scene_.solids[size_t(s)].floats()) solids_.pressFromGaps(v, floating_.bodies(), s);
    }
    template <int halvesOfKick, bool drifts> void moveFloating() {
        floating_.move(view(), particleMass(scene_), hold_, 0.5 * halvesOfKick, drifts ? 1 : 0);
    }
    template <class Pass> void onFluid() { device_.forEach(fluid_.slots(), Pass{view()}); }
    template <class Pass> void onPairs() {
        halfListSums_.run(device_, fluidNearFluid_, Pass{view()});
    }
    template <class Pass> void onWalls() { device_.forEach(walls_.slots(), Pass{view()}); }
    // Order and lists hold until two particles may have come closer by the skin.
    bool nothingMovedFar() const { return keepsLists && displacementBound_ < skin_ / 2; }
    // Where few are awake lists are short and the sort, which knows no rest, is what costs: both
    // cost the same with a skin that grows as 1/sqrt(share awake). Blocks are large enough for 0.4
    // support radii. Where lists would not outlive a step, by what the last one `moved` (unless
    // nobody knows), they reach no further than they must.
    float chooseSkin(double moved) {
        const float asked = scene_.compute.skin,
                    share = hasBlockTimeSteps() ? float(std::max(clock().awake, 1e-3)) : 1;
        const float skin =
            supportRadius(scene_) * std::max(asked, std::min(asked / std::sqrt(share), 0.4f));
        return displacementBound_ < 1e29 && moved >= skin / 2 ? 0 : skin;
    }
    void moveSolids() { placeSolids(0); }
    void moveSolidsHalfWay() {
        placeSolids(0.5);
    }  // the clock is at the step's end, what floats at its beginning
    void keepOutOfSolids() {
        if (solids_.moves()) solids_.sweep(clock_.data(), floating_.bodies(), floating_.motions());
        const bool floats = solids_.floats();
        device_.forEach(
            fluid_.slots(),
            KeepOutOfSolids{view(), floats ? floating_.bounces(fluid_.slots()) : Bounces{}});
        if (floats) floating_.takeMomentum(scene_, view());
    }
    void tellWallsVelocity() {
        solids_.tellVelocity(view(), floating_.bodies(), floating_.motions());
    }
    void placeSolids(double halfWay) {
        solids_.move(clock_.data(), halfWay, halfWay, floating_.bodies(), floating_.motions());
        solids_.placeWalls(view());
    }
    void sort() {
        const double moved =
            displacementBound_ - std::exchange(displacementBoundBefore_, displacementBound_);
        if (nothingMovedFar()) return;
        if constexpr (keepsLists) skin_ = chooseSkin(moved);
        fluid_.sort(grid_);
        boxes_.compute(device_, fluid_.view());
        if (hasBlockTimeSteps()) onFluid<ApplyEquationOfState>();  // of those who aren't due
        if (solids_.moves()) {
            walls_.sort(grid_);
            solids_.placeWalls(view());  // all but their places, which the sort took along
            wallBoxes_.compute(device_, walls_.view());
        }
        if (solids_.anyThin()) findScreens();
        if (objects_.count() > 0) {
            objects_.sort(grid_);
            objects_.invalidateLists(fluid_.view());
        }
        for (NeighbourLists* lists : {&fluidNearFluid_, &wallsNearFluid_})
            lists->invalidate(fluid_.view());
        fluidNearWalls_.invalidate(walls_.view());
        displacementBound_ = displacementBoundBefore_ = 0;
    }
    // On which sides of thin solids clusters are.
    void findScreens() {
        solids_.meetWalls(parameters_);
        const float reach = supportRadius(scene_) + skin_;
        boxes_.findSides(device_, fluid_.view(), solids_.screens(), reach, false);
        wallBoxes_.findSides(device_, walls_.view(), solids_.screens(), reach, true);
    }
    // Of those who are looked at now; forces on solids may be asked for at any time.
    void findNeighbours() {
        const View v = view();
        const float reach = supportRadius(scene_) + skin_;
        fluidNearFluid_.build(device_, grid_, reach, boxes_, v.fluid.active, boxes_,
                              fluid_.cellStart(), usesHalfLists(),
                              {v.screens, Between::Fluid, v.fluid, v.fluid});
        wallsNearFluid_.build(device_, grid_, reach, boxes_, v.fluid.active, wallBoxes_,
                              walls_.cellStart(), false,
                              {v.screens, Between::FluidAndWalls, v.fluid, v.walls});
        if (objects_.count() > 0) objects_.findNeighbours(grid_, skin_, boxes_, fluid_.cellStart());
        if (!wallsCarryPressure()) return;
        const uint8_t* active = solids_.count() > 0 ? nullptr : v.walls.active;
        fluidNearWalls_.build(device_, grid_, reach, wallBoxes_, active, boxes_, fluid_.cellStart(),
                              false, {v.screens, Between::WallsAndFluid, v.walls, v.fluid});
    }
    template <bool volume> void findExtremes() {
        device_.reduce(fluid_.slots(), FindExtremes<volume>{fluid_.view(), parameters_.restDensity},
                       extremes_.data());
        if (objects_.count() > 0) objects_.findSpeed(clock_.data(), extremes_.data());
    }
    void chooseTimeStep() {
        device_.forEach(1, ChooseTimeStep{view(), extremes_.data()});
        const double share = scene_.time.integrator == Integrator::PredictorCorrector ? 0.5
                             : scene_.time.integrator == Integrator::Split            ? 0
                                                                                      : 1;
        if constexpr (keepsLists)
            displacementBound_ += share * clock_.data()->dt * largestSpeed(clock_.data()->dt);
    }
    void beginStep() { device_.forEach(1, BeginStep{view()}); }
    void findResting() {
        device_.forEach(int(blockTimeSteps_.blocks()), MeasureBlocks{view()});
        device_.forEach(int(blockTimeSteps_.blocks()), RestBlocks{view()});
    }
    void findActive() {
        allActive_ = !Device::recordsSteps && clock().allActive;  // (a recording can't look)
        if (allActive_) return;
        device_.forEach(fluid_.slots() / clusterSize, FindActiveClusters{view()});
        device_.forEach(int(blockTimeSteps_.blocks()), FindActiveBlocks{view()});
        device_.forEach(walls_.slots() / clusterSize, ClearActive{walls_.view()});
        device_.forEach(int(blockTimeSteps_.blocks()), FindNearBlocks{view()});
        device_.forEach(int(blockTimeSteps_.blocks()), SpreadActive{view()});
    }
    void chooseSubstep() {
        device_.reduce(fluid_.slots(), FindMotion{fluid_.view(), clock_.data()},
                       blockTimeSteps_.motion());
        device_.forEach(1, ChooseSubstep{view(), blockTimeSteps_.motion(), fluidCount_});
        if constexpr (keepsLists) {
            const double solids = solids_.largestSpeed();
            displacementBound_ +=
                clock_.data()->dt * std::max({clock_.data()->speed, stir_.speed(), solids});
        }
    }
    void wake() {
        if (!hasBlockTimeSteps()) return;
        blockTimeSteps_.wake();
        StepState awake = clock();
        awake.allActive = awake.allRest = false, awake.awake = 1;
        device_.upload(clock_.data(), &awake, 1);
        device_.forEach(fluid_.slots(), WakeParticles{fluid_.view()});
    }
    // From the middle of the step to its end, where the middle's accelerations lead: dt/2 v +
    // dt^2/2 a, and a shift that may turn round. Of the whole step, which before the pressure
    // nobody knew.
    void countPressure() {
        findExtremes<false>();
        if constexpr (keepsLists)
            displacementBound_ += clock_.data()->dt * largestSpeed(clock_.data()->dt);
    }
    void countCorrection() {
        findExtremes<false>();
        if constexpr (!keepsLists) return;
        const StepState& clock = *clock_.data();
        const double start = std::max<double>(clock.speed, stir_.speed());
        const double pull = std::sqrt(extremes_.data()->acceleration2);
        const double own = 0.5 * (start + clock.dt * pull) + (shifts() ? 0.75 * clock.speed : 0);
        displacementBound_ += clock.dt * std::max(own, 0.5 * double(solids_.largestSpeed()));
    }
    // Of any particle at the end of a step of length dt, stirring included.
    double largestSpeed(double dt) const {
        const Extremes& e = *extremes_.data();
        const double most = std::max<double>(std::sqrt(e.speed2), stir_.speed());
        const double own = most + dt * std::sqrt(e.acceleration2);
        return std::max(shifts() ? 1.5 * own : own,
                        solids_.largestSpeed());  // the shift is at most half as fast
    }

    // Sorted once where they never move; their masses stay.
    void weighWalls() {
        walls_.sort(grid_);
        wallBoxes_.compute(device_, walls_.view());
        wallsNearWalls_.invalidate(walls_.view());
        wallsNearWalls_.build(device_, grid_, supportRadius(scene_), wallBoxes_, nullptr,
                              wallBoxes_, walls_.cellStart());
        withKernel(scene_.simulation.kernel, [&](auto kernel) {
            device_.forEach(walls_.slots(), ComputeWallMass<decltype(kernel)>{view()});
        });
        wallsNearWalls_ = {};
        if (solids_.moves()) return solids_.keepMasses(walls_.view());
        solids_.placeWalls(view());
        walls_.keepOrder();
    }

    View view() {
        View v{fluid_.view(),
               walls_.view(),
               solids_.data(),
               solids_.count(),
               {fluidNearFluid_.data(), fluid_.cellStart(), fluid_.view().position, Between::Fluid},
               {wallsNearFluid_.data(), walls_.cellStart(), walls_.view().position,
                Between::FluidAndWalls},
               {fluidNearWalls_.data(), fluid_.cellStart(), fluid_.view().position,
                Between::WallsAndFluid},
               {wallsNearWalls_.data(), walls_.cellStart(), walls_.view().position},
               grid_,
               parameters_,
               clock_.data(),
               blockTimeSteps_.view(),
               solids_.screens()};
        if (allActive_) v.fluid.active = v.walls.active = nullptr;
        v.c.stirCenter = toVector(stir_.center - scene_.domain.min);
        v.c.stirVelocity = toVector(stir_.velocity);
        v.c.stirRadius = stir_.radius, v.c.stirRate = stir_.rate, v.c.stirPull = stir_.pull;
        return v;
    }
    // picture.h
    Range writeVertices(Vertex* out, ColorBy by, int walls);
    Range writeSurface(Vertex* out);
    template <class Value> Range write(const Particles& p, Vertex* out);
    void addBuffers() {
        fluid_.addForces(usesHalfLists() && hasMixingForces(scene_),
                         scene_.fluid.surfaceTension > 0 || showsSurface_);
    }

    Device device_;
    std::string deviceName_;
    Scene scene_;
    Stir stir_;
    int fluidCount_, wallCount_;
    std::vector<uint16_t> bodies_;   // of a mixture: which one each particle is of
    std::vector<Vec3> wallsAtHome_;  // as in Placement
    std::vector<int> solidSizes_;
    FluidExtent extent_;
    Grid grid_;
    StepParameters parameters_{};
    std::vector<Row> plan_;
    std::vector<PlanRow> rows_;
    std::vector<PassTime> times_;
    ParticleSet<Device> fluid_{device_, Kind::Fluid}, walls_{device_, Kind::Walls};
    Solids<Device> solids_{device_};
    Floating<Device> floating_{device_};
    Objects<Device> objects_{device_};
    Hold hold_;  // target relative to the domain's lower corner
    PassFunction findLoads_ = nullptr;
    Buffer<StepState, Device> clock_{device_};
    Buffer<Extremes, Device> extremes_{device_};
    BlockTimeSteps<Device> blockTimeSteps_{device_};
    bool showsSurface_ = false;                // somebody has asked
    bool allActive_ = false;                   // at this moment: flags are needless then
    Buffer<Vertex, Device> staging_{device_};  // for vertices that the host is to have
    bool measureNext_ = true;
    typename Device::Recording recordings_[8];
    int sortsInStep_ = 1;  // each exchanges the particles' two sides of buffers
    static constexpr bool keepsLists = clusterSize > 1;
    static constexpr const char* allAlike = "all take the same steps (time.mode)";
    static constexpr const char* noLists = "rows of cells are walked instead of lists";
    double displacementBound_ = 1e30;  // m, bound of any particle's way since the lists were built
    double displacementBoundBefore_ = 1e30;  // the same when sorting was last considered
    float skin_ = 0;                         // m, how much further than the support these reach
    Boxes boxes_, wallBoxes_;
    NeighbourLists fluidNearFluid_, wallsNearFluid_, fluidNearWalls_, wallsNearWalls_;
    HalfListSums halfListSums_;
};

}  // namespace spindrift::LANES

#include "sim/measure.h"
#include "sim/picture.h"
#include "sim/plan.h"
