// Taps, inlets, drains and outlets: fluid comes and leaves while a run goes on. Nothing is
// allocated for that in a step: there is room for the most that there may ever be (mostFluid).
#pragma once

#include "scene/sources.h"
#include "sim/parts/part.h"
#include "sim/parts/source_passes.h"
#include "sim/step/flow.h"

#include <algorithm>
#include <vector>

namespace spindrift::LANES {

template <class Device> class Sources : public Part {
public:
    explicit Sources(Flow<Device>& flow) : flow_(flow) {
        if (!any()) return;
        const Scene& scene = flow.scene;
        std::vector<SourceFace> faces;
        std::vector<SourcePoint> points;
        std::vector<SourceKey> keys;
        for (const Source& source : scene.sources) addSource(source, faces, points, keys);
        std::vector<SinkBox> sinks;
        for (const Sink& sink : scene.sinks) {
            SinkBox box{toVector(sink.min - scene.domain.min),
                        toVector(sink.max - scene.domain.min)};
            if (scene.simulation.dimensions == 2) box.low.z = -farAway, box.high.z = farAway;
            sinks.push_back(box);
        }
        faces_.fill(faces), points_.fill(points), keys_.fill(keys), sinks_.fill(sinks);
        tally_.resize(1), counts_.resize(3);
        most_ = int(mostFluid(scene, flow.fluidCount)) + int(points.size());
        flow.fluid.comeAndGo(slotsFor(most_, int(points.size())));
    }
    // Asks for what count() and tally() say, once the device has been waited for; the host's own
    // memory is looked at whenever they are asked.
    void look() {
        if (any()) flow_.device.fetch(&seen_, tally_.data(), 1);
    }
    int count() { return any() ? tally().there : flow_.fluidCount; }
    const Tally& tally() {
        if constexpr (Device::hostReadable) look();
        return seen_;
    }

    // For pictures: see VertexPlaces.
    const int* vertexNumbers() {
        if (!any()) return nullptr;
        const int slots = flow_.fluid.slots();
        numbers_.resize(size_t(slots));
        if constexpr (Device::hostReadable) {
            const int* id = flow_.fluid.view().id;
            for (int i = 0, next = 0; i < slots; ++i) numbers_.data()[i] = next, next += id[i] >= 0;
        } else {
            flow_.device.forEach(slots, NumberSlots{numbers_.data()});
        }
        return numbers_.data();
    }

    // --- as a part (part.h) ---

    double longestStep() const { return longestStep_; }
    void restart(const RunState& state) {
        if (!any()) return;
        Tally t;
        t.there = int(state.particles.positions.size());
        const SourceState& s = state.sources;
        t.firstId = s.firstId >= 0 ? s.firstId : t.there;
        t.time = s.time, t.came = s.came, t.left = s.left, t.missed = s.missed;
        flow_.device.upload(tally_.data(), &t, 1);
        flow_.fluid.setHeldBy(state.particles.heldBy);
    }
    void save(RunState& state) {
        if (!any()) return;
        const Tally& t = tally();
        state.sources = {t.time, t.came, t.left, t.missed, t.firstId};
    }
    // Once a step, where forces are evaluated for the first time.
    void place(Plan& plan, Initial initial, bool) {
        if (initial != Initial::Yes) return;
        plan.add(
            "sources and sinks", [this] { comeAndGo(); }, Initial::No,
            any() ? "" : "there are none");
    }
    void refresh() {
        withCompiledKernel(flow_.scene.simulation.kernel, [&](auto kernel) {
            using K = decltype(kernel);
            constexpr Lists inner = buildsInner ? Lists::Inner : Lists::All;
            borrow_ = carriesDensity(flow_.scene)
                          ? &Flow<Device>::template onFluid<BorrowPressure<K, Lists::All, true>>
                          : &Flow<Device>::template onPairsOrFluid<BorrowPressure<K, inner, false>>;
        });
    }
    void borrowPressure(Plan& plan, Initial initial) {
        if (points_.size() == 0 || factsOf(flow_.scene).solvesPressure) return;
        plan.add(
            "pressure before mouths",
            [this] {
                (flow_.*borrow_)();
                carriesDensity(flow_.scene) ? onSlots(TakePressure<true>{flow_.view()})
                                            : onSlots(TakePressure<false>{flow_.view()});
            },
            carriesDensity(flow_.scene) ? Initial::No : initial);  // a state has it already
    }
    void holdBack(Plan& plan, Initial initial) {
        if (points_.size() == 0) return;
        plan.add(
            "hold back", [this] { onSlots(HoldBack{flow_.view()}); }, initial);
    }

private:
    bool any() const { return comesAndGoes(flow_.scene); }
    void addSource(const Source& source, std::vector<SourceFace>& faces,
                   std::vector<SourcePoint>& points, std::vector<SourceKey>& keys) {
        const Scene& scene = flow_.scene;
        const SourceLattice lattice = latticeOf(scene, source);
        const std::vector<SourceKey> own = scheduleOf(scene, source);
        const auto vector = [](Vec3d a) { return toVector(toFloat(a)); };
        const Vec3d low = toDouble(scene.domain.min);
        const int face = int(faces.size()), firstKey = int(keys.size());
        keys.insert(keys.end(), own.begin(), own.end());
        const bool flat = scene.simulation.dimensions == 2, round = source.mouth == Mouth::Disc;
        // What is not held keeps half a spacing off on all sides: a particle that comes has none
        // nearer than a spacing.
        const double apart = lattice.apart, beside = 0.49 * apart;
        faces.push_back({vector(toDouble(source.center) - low), vector(lattice.normal),
                         vector(lattice.across), vector(lattice.up),
                         real(source.width / 2 + beside),
                         flat ? real(farAway) : real(source.height / 2 + beside),
                         round ? real(source.radius + beside) : real(0), apart,
                         real((lattice.layers - 0.5) * apart), real(lattice.depth() + 0.5 * apart),
                         firstKey, int(keys.size())});
        for (const SourceLattice::Point& p : lattice.points)
            points.push_back({vector(p.at - low), p.share, face});
        // No point is to give two particles at once.
        longestStep_ =
            std::min(longestStep_,
                     0.5 * lattice.apart / std::max(spindrift::largestSpeed(scene, source), 1e-9));
    }
    // Rows of cells are filled up to whole clusters.
    int slotsFor(int particles, int points) const {
        const Int3 cells = flow_.search.grid().cells;
        return particles + (clusterSize - 1) * cells.y * cells.z + points + clusterSize;
    }
    SourceView sources() const {
        return {faces_.data(),      points_.data(),      keys_.data(),       sinks_.data(),
                int(faces_.size()), int(points_.size()), int(sinks_.size()), tally_.data()};
    }
    template <class Pass> void onSlots(const Pass& pass) {
        flow_.device.forEach(flow_.fluid.slots(), pass);
    }
    // A device that records steps does all of it in every step; another one only what is due, after
    // which there is a new order.
    void comeAndGo() {
        Count *left = counts_.data(), *due = left + 1, *came = left + 2;
        Device& device = flow_.device;
        const int points = int(points_.size());
        device.reduce(flow_.fluid.slots(), HoldAndDrain{flow_.view(), sources()}, left);
        device.reduce(points, CountDue{sources(), flow_.clock.data()}, due);
        if constexpr (Device::recordsSteps) {
            come(points, came);
        } else {
            *came = {};
            flow_.search.movedAtMost(left->farthest);
            if (due->number > 0) come(points, came), flow_.search.outdate();
        }
        device.forEach(1, KeepTally{flow_.clock.data(), left, due, came, tally_.data()});
    }
    void come(int points, Count* came) {
        const int slots = flow_.fluid.slots();
        const int* free = flow_.fluid.makeRoom(points);
        if constexpr (!Device::recordsSteps) onSlots(ClearSlots{flow_.view(), slots});
        flow_.device.reduce(points, Come{flow_.view(), sources(), free, most_}, came);
    }

    Flow<Device>& flow_;
    Buffer<SourceFace, Device> faces_{flow_.device};
    Buffer<SourcePoint, Device> points_{flow_.device};
    Buffer<SourceKey, Device> keys_{flow_.device};
    Buffer<SinkBox, Device> sinks_{flow_.device};
    Buffer<Tally, Device> tally_{flow_.device};
    Buffer<Count, Device> counts_{flow_.device};
    Buffer<int, Device> numbers_{flow_.device};
    void (Flow<Device>::*borrow_)() = nullptr;
    Tally seen_;
    int most_ = 0;
    double longestStep_ = 1e9;  // s
};

}  // namespace spindrift::LANES
