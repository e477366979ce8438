// Elastic objects on one device: what they are, and which particles touch.
#pragma once

#include "scene/sample_object.h"
#include "sim/object_driver.h"
#include "sim/parts/object_passes.h"
#include "sim/object_state.h"
#include "sim/particles/particle_set.h"
#include "sim/parts/floating.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

// Owns the objects and finds which particles touch.
template <class Device> class Objects : public Part {
public:
    Objects(Flow<Device>& flow, Solids<Device>& solids, Floating<Device>& floating)
        : flow_(flow),
          device_(flow.device),
          solids_(solids),
          floating_(floating),
          sample_(sampleObjects(flow.scene)) {
        if (count() == 0) return;
        const Scene& scene = flow.scene;
        fillVectors(home_, sample_.positions);
        mass_.fill(std::vector<real>(sample_.masses.begin(), sample_.masses.end()));
        radius_.fill(std::vector<real>(sample_.radii.begin(), sample_.radii.end()));
        object_.fill(sample_.objects), grip_.fill(sample_.grips),
            atSurface_.fill(sample_.atSurface);
        std::vector<Material> materials;
        for (const Object& o : scene.objects) materials.push_back({o.damping, o.breakingStrain});
        materials_.fill(materials), cuts_.fill(scene.cuts);
        std::vector<GripKeys> grips;
        std::vector<MotionKey> keys;
        for (const Grip& g : scene.grips) {
            const std::vector<MotionKey> own = motionOf(g);
            grips.push_back({int(keys.size()), int(keys.size() + own.size())});
            keys.insert(keys.end(), own.begin(), own.end());
        }
        grips_.fill(grips), keys_.fill(keys);
        given_.resize(vectorSize(padded()));
        if (solids.floats())
            press_.resize(vectorSize(padded())), pressedBy_.resize(size_t(padded()));
        acceleration_.resize(vectorSize(padded())), torn_.resize(sample_.size()),
            slot_.resize(sample_.size()), speed_.resize(1);
        drive_.fill({Drive{}});
        bondEnds();
    }
    int count() const { return int(sample_.size()); }

    // --- as a part (part.h) ---

    void restart(const RunState& run) {
        if (count() == 0) return;
        const Scene& scene = flow_.scene;
        const ObjectState& state = run.objects;
        std::vector<Vec3> velocities;
        for (const int object : sample_.objects)
            velocities.push_back(scene.objects[size_t(object)].velocity);
        fillVectors(position_, state.positions.empty() ? sample_.positions : state.positions);
        fillVectors(velocity_, state.velocities.empty() ? velocities : state.velocities);
        std::vector<BondEnd> bonds = whole_;
        std::vector<real> torn(sample_.size(), 0);
        for (size_t i = 0; i < torn.size(); ++i)
            for (int b = firstBondOnHost_[i]; b < firstBondOnHost_[i + 1]; ++b)
                if (!state.broken.empty() && state.broken[size_t(b)])
                    bonds[size_t(b)].stiffness = 0, torn[i] = 1;
        bonds_.fill(bonds), torn_.fill(torn);
        std::vector<int> slots(sample_.size(), -1);
        slot_.fill(slots);
        std::vector<Vec3> places;
        std::vector<int> ids;
        for (int i = 0; i < count(); ++i)
            if (sample_.atSurface[size_t(i)] || !scene.cuts.empty() ||
                scene.objects[size_t(sample_.objects[size_t(i)])].breakingStrain > 0)
                places.push_back(sample_.positions[size_t(i)]), ids.push_back(i);
        sorted_.upload(places, {}, {}, ids);
        device_.forEach(sorted_.slots(), FetchPlaces{particles(), sorted_.view()});
    }
    void save(RunState& run) {
        if (count() == 0) return;
        ObjectState& s = run.objects;
        const std::vector<real> places = position_.fetch(), velocities = velocity_.fetch();
        const std::vector<BondEnd> bonds = bonds_.fetch();
        device_.wait();
        for (const Vec3d& x : vectorsOf(places, sample_.size())) s.positions.push_back(toFloat(x));
        for (const Vec3d& v : vectorsOf(velocities, sample_.size()))
            s.velocities.push_back(toFloat(v));
        for (const BondEnd& b : bonds) s.broken.push_back(b.stiffness <= 0);
    }
    void refresh() {
        if (count() == 0) return;
        law_ = contactLaw(flow_.model);
        float largest = 0;
        for (const float r : sample_.radii) largest = std::max(largest, r);
        const Scene& scene = flow_.scene;
        const float room = scene.simulation.spacing / 2 + largest;
        reach_ = std::max(scene.contact.influence * room, 2 * largest);
        longestStep_ = stableStep();
    }
    // s, that springs and contacts bear.
    double longestStep() const { return longestStep_; }
    void sorted() {
        if (count() == 0) return;
        device_.forEach(sorted_.slots(), FetchPlaces{particles(), sorted_.view()});
        sorted_.sort(flow_.search.grid());
        resizeSurface();
        placeSurface();
        boxes_.compute(device_, sorted_.view());
        objectsNearFluid_.invalidate(flow_.fluid.view());
        for (NeighbourLists* lists : {&fluidNearObjects_, &objectsNearObjects_})
            lists->invalidate(sorted_.view());
    }
    void findNeighbours() {
        if (count() == 0) return;
        const Grid& grid = flow_.search.grid();
        const float reach = reach_ + flow_.search.skin();
        const Boxes& fluidBoxes = flow_.search.fluidBoxes();
        const int* fluidCells = flow_.fluid.cellStart();
        objectsNearFluid_.build(device_, grid, reach, fluidBoxes, nullptr, boxes_,
                                sorted_.cellStart());
        fluidNearObjects_.build(device_, grid, reach, boxes_, nullptr, fluidBoxes, fluidCells);
        objectsNearObjects_.build(device_, grid, reach, boxes_, nullptr, boxes_,
                                  sorted_.cellStart());
    }
    int64_t bytes() const {
        return objectsNearFluid_.bytes() + fluidNearObjects_.bytes() + objectsNearObjects_.bytes();
    }
    // The fastest of them counts as one of the fluid.
    void findSpeed() {
        if (count() == 0) return;
        device_.reduce(count(), FindObjectSpeed{particles(), flow_.clock.data(), drive_.data()},
                       speed_.data());
        device_.forEach(1, TakeFaster{flow_.extremes.data(), speed_.data()});
    }
    void addForces(Plan& plan, Initial initial) {
        plan.add(
            "contact", [this] { touch(); }, initial, whyNone());
    }
    void move(Plan& plan, ShareOfStep share) {
        if (share.drifts)
            plan.add(
                "objects", [this] { moveOn(); }, Initial::No, whyNone());
    }

    // What is put in order with the fluid.
    ParticleSet<Device>& surfaceSet() { return sorted_; }
    // From now on; null: bonds and grips again.
    void drive(ObjectDriver* driver) {
        driver_ = driver, arrival_ = -1, origin_ = toDouble(flow_.scene.domain.min);
        drive_.fill({Drive{}});
        if (!driver) return;
        const double time = flow_.readClock().time;
        for (auto* field : {&target_, &impulse_}) field->resize(vectorSize(padded()));
        fillVectors(acceleration_, std::vector<Vec3>(sample_.size()));
        exchanged_ = time;
        exchange(time);
    }
    bool isDriven() const { return driver_; }
    double arrival() const { return arrival_; }  // s, when it is to be asked again
    // When its time has come.
    void exchange(double time) {
        if (time < arrival_) return;
        const double passed = time - exchanged_;
        const std::vector<real> impulses = impulse_.fetch(), places = position_.fetch(),
                                speeds = velocity_.fetch();
        device_.wait();
        std::vector<Vec3d> forces = vectorsOf(impulses, sample_.size()),
                           velocities = vectorsOf(speeds, sample_.size());
        for (Vec3d& f : forces) f = passed > 0 ? (1 / passed) * f : Vec3d{};
        const std::vector<Vec3d> before = vectorsOf(places, sample_.size());
        std::vector<Vec3d> positions = before;
        for (Vec3d& x : positions) x = x + origin_;
        driver_->exchange(time, forces, positions, velocities);
        CHECK(positions.size() == sample_.size() && velocities.size() == sample_.size());
        for (Vec3d& x : positions) x = x - origin_;
        double most = 0;
        for (size_t i = 0; i < before.size(); ++i)
            most = std::max(most, length(positions[i] - before[i]) / driver_->interval());
        fillVectors(target_, positions), fillVectors(velocity_, velocities),
            fillVectors(impulse_, std::vector<Vec3d>(sample_.size()));
        exchanged_ = time, arrival_ = time + driver_->interval();
        drive_.fill({Drive{arrival_, real(most)}});
    }
    void writeVertices(Vertex* out, float fluidSpacing) {
        device_.forEach(count(), WriteObjectVertices{particles(), out, real(fluidSpacing / 2)});
    }

private:
    const char* whyNone() const { return count() > 0 ? "" : "there are no objects"; }
    void placeSurface() { device_.forEach(sorted_.slots(), PlaceSurface{particles(), surface()}); }
    // Forces on fluid and objects where they are, and on solids that float.
    void touch() {
        const View v = flow_.view();
        const ContactView c = contactView(v);
        device_.forEach(v.fluid.slots, PushFluid{c});
        device_.forEach(sorted_.slots(), PushObjects{c});
        if (driver_) return;
        device_.forEach(count(), StretchBonds{v,
                                              particles(),
                                              {force_.data()},
                                              materials_.data(),
                                              cuts_.data(),
                                              int(cuts_.size()),
                                              floating_.bodies(),
                                              floating_.springs(),
                                              presses()});
        if (solids_.floats())
            floating_.addTouches(count(), [&](int solid) {
                return SumPresses{v, particles(), presses(), solid};
            });
    }
    void moveOn() {
        const View v = flow_.view();
        if (driver_)
            device_.forEach(count(), FollowDriver{v.state,
                                                  particles(),
                                                  {force_.data()},
                                                  {target_.data()},
                                                  {impulse_.data()},
                                                  drive_.data()});
        else
            device_.forEach(count(), MoveObjects{v,
                                                 particles(),
                                                 grips_.data(),
                                                 keys_.data(),
                                                 floating_.bodies(),
                                                 floating_.held(),
                                                 {given_.data()}});
        placeSurface();
        if (floating_.held() >= 0 && !driver_)
            floating_.feelStops(count(), SumStops{particles(), {given_.data()}});
    }
    ObjectParticles particles() const {
        return {count(),        {position_.data()}, {velocity_.data()}, {acceleration_.data()},
                {home_.data()}, {mass_.data()},     {radius_.data()},   {torn_.data()},
                object_.data(), grip_.data(),       firstBond_.data(),  atSurface_.data(),
                bonds_.data(),  slot_.data()};
    }
    ObjectSurface surface() const {
        const Particles sorted = sorted_.view();
        return {sorted.slots,
                sorted.id,
                sorted.position,
                {surfaceVelocity_.data()},
                {surfaceHome_.data()},
                {surfaceRadius_.data()},
                {surfaceObject_.data()},
                {surfaceTorn_.data()},
                {force_.data()}};
    }
    ContactView contactView(const View& v) {
        const VectorField places = sorted_.view().position;
        ContactView c{v,
                      surface(),
                      {objectsNearFluid_.data(), sorted_.cellStart(), places},
                      {fluidNearObjects_.data(), v.fluidNearFluid.cellStart, v.fluid.position},
                      {objectsNearObjects_.data(), sorted_.cellStart(), places},
                      law_};
        c.v.c.support = real(reach_), c.v.c.support2 = real(reach_ * reach_),
        c.v.c.inverseSupport2 = real(1 / (reach_ * reach_));
        return c;
    }
    void resizeSurface() {
        const int slots = sorted_.slots();
        for (auto* field : {&surfaceVelocity_, &surfaceHome_, &force_})
            field->resize(vectorSize(slots));
        for (auto* field : {&surfaceRadius_, &surfaceObject_, &surfaceTorn_})
            field->resize(size_t(slots));
    }
    // Both ends of each bond, beside those of the same particle.
    void bondEnds() {
        std::vector<int> first(sample_.size() + 1, 0);
        for (const Bond& b : sample_.bonds) ++first[size_t(b.a) + 1], ++first[size_t(b.b) + 1];
        for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
        whole_.resize(2 * sample_.bonds.size());
        std::vector<int> next = first;
        for (const Bond& b : sample_.bonds) {
            whole_[size_t(next[size_t(b.a)]++)] = {b.b, b.length, b.stiffness};
            whole_[size_t(next[size_t(b.b)]++)] = {b.a, b.length, b.stiffness};
        }
        firstBondOnHost_ = first;
        firstBond_.fill(first);
    }
    // A particle on its springs swings at no more than sqrt(2 sum k / m) and is slowed at no more
    // than 2 sum c / m.
    double stableStep() const {
        const Scene& scene = flow_.scene;
        const double contact =
            contactStiffness(flow_.model) * std::exp(double(scene.contact.steepness));
        double fastest = 0;
        for (size_t i = 0; i < sample_.size(); ++i) {
            const double m = sample_.masses[i],
                         share = scene.objects[size_t(sample_.objects[i])].damping;
            double k = 6 * contact, c = 6 * double(law_.damping + law_.shear);
            for (int b = firstBondOnHost_[i]; b < firstBondOnHost_[i + 1]; ++b) {
                const double spring = whole_[size_t(b)].stiffness;
                k += 2 * spring, c += 2 * 2 * share * std::sqrt(spring * m / 2);
            }
            fastest = std::max(fastest, std::sqrt(k / m) + c / m);
        }
        return 1.5 / fastest;  // it is stable to 2
    }
    ContactForces presses() { return {{press_.data()}, {pressedBy_.data()}}; }
    int padded() const { return (count() + clusterSize - 1) / clusterSize * clusterSize; }
    template <class V>
    void fillVectors(Buffer<real, Device>& buffer, const std::vector<V>& values) {
        std::vector<real> x(vectorSize(padded()));
        for (size_t i = 0; i < values.size(); ++i)
            for (int k = 0; k < 3; ++k) x[vectorOffset(int(i), k)] = real(values[i][k]);
        buffer.fill(x);
    }

    Flow<Device>& flow_;
    Device& device_;
    Solids<Device>& solids_;
    Floating<Device>& floating_;
    ObjectSample sample_;
    std::vector<BondEnd> whole_;  // as at the start
    std::vector<int> firstBondOnHost_;
    ContactLaw law_{};
    float reach_ = 0;  // m, of the longest contact
    double longestStep_ = 1e9;
    ObjectDriver* driver_ = nullptr;
    double exchanged_ = 0,
           arrival_ = 0;  // s: when it was asked last, and when particles are to be where it said
    Vec3d origin_;        // m, the domain's lower corner
    Buffer<real, Device> target_{device_}, impulse_{device_}, press_{device_}, pressedBy_{device_},
        given_{device_};
    Buffer<real, Device> position_{device_}, velocity_{device_}, acceleration_{device_},
        home_{device_}, mass_{device_}, radius_{device_}, torn_{device_};
    Buffer<int, Device> object_{device_}, grip_{device_}, firstBond_{device_}, slot_{device_};
    Buffer<uint8_t, Device> atSurface_{device_};
    Buffer<BondEnd, Device> bonds_{device_};
    Buffer<Material, Device> materials_{device_};
    Buffer<Cut, Device> cuts_{device_};
    Buffer<GripKeys, Device> grips_{device_};
    Buffer<MotionKey, Device> keys_{device_};
    Buffer<Extremes, Device> speed_{device_};
    Buffer<Drive, Device> drive_{device_};
    ParticleSet<Device> sorted_{device_, Kind::Objects};
    Buffer<real, Device> surfaceVelocity_{device_}, surfaceHome_{device_}, surfaceRadius_{device_},
        surfaceObject_{device_}, surfaceTorn_{device_}, force_{device_};
    Boxes boxes_;
    NeighbourLists objectsNearFluid_, fluidNearObjects_, objectsNearObjects_;
};

}  // namespace spindrift::LANES
