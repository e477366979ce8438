// Owns the buffers of one kind of particles and keeps them sorted by cell.
#pragma once

#include "device/buffer.h"
#include "sim/output_passes.h"
#include "sim/passes.h"
#include "sim/simulation.h"

#include <numeric>
#include <utility>
#include <vector>

namespace spindrift::LANES {

enum class Kind { Fluid, Walls, Objects };  // of objects just places: the rest is elsewhere

template <class Device> class ParticleSet {
public:
    ParticleSet(Device& device, Kind kind) : device_(device), kind_(kind) {}

    int slots() const { return slots_; }
    const int* cellStart() const { return cellStart_.data(); }

    Particles view() const {
        return {slots_,
                id_.data(),
                {position_.data()},
                {velocity_.data()},
                {acceleration_.data()},
                {addedForce_.data()},
                {normal_.data()},
                {normalLength_.data()},
                {density_.data()},
                {inverseDensity_.data()},
                {weighsViscosity_ ? viscousVolume_.data() : inverseDensity_.data()},
                {pressureOverRho2_.data()},
                {mass_.data()},
                {outward_.data()},
                {ownVelocity_.data()},
                {ownAcceleration_.data()},
                {slip_.data()},
                {slipVelocity_.data()},
                {flowVelocity_.data()},
                {densityRate_.data()},
                {shiftVelocity_.data()},
                {shiftAcceleration_.data()},
                {kept_.position.data()},
                {kept_.velocity.data()},
                {kept_.density.data()},
                {massRatio_.data()},
                {viscosity_.data()},
                {timeBin_.data()},
                active_.data()};
    }

    // Takes over particles with ids firstId, firstId + 1, ...; boundary particles have no
    // velocities. Densities only where they are carried.
    void upload(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                const std::vector<float>& densities, int firstId) {
        std::vector<int> ids(positions.size());
        std::iota(ids.begin(), ids.end(), firstId);
        upload(positions, velocities, densities, ids);
    }
    void upload(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities,
                const std::vector<float>& densities, const std::vector<int>& ids) {
        const int n = int(positions.size());
        resize((n + clusterSize - 1) / clusterSize * clusterSize);
        std::vector<real> x(vectorSize(slots_)), u(vectorSize(slots_)),
            rho(densities.begin(), densities.end());
        std::vector<int> id(slots_, -1);
        for (int i = 0; i < n; ++i) {
            id[i] = ids[i];
            for (int k = 0; k < 3; ++k) {
                x[vectorOffset(i, k)] = positions[i][k];
                if (kind_ == Kind::Fluid) u[vectorOffset(i, k)] = velocities[i][k];
            }
        }
        device_.upload(position_.data(), x.data(), x.size());
        if (kind_ == Kind::Fluid) device_.upload(velocity_.data(), u.data(), u.size());
        if (carriesDensity_) device_.upload(density_.data(), rho.data(), rho.size());
        device_.upload(id_.data(), id.data(), id.size());
    }

    // What each particle of a mixture is, by ids from 0 on: see View.
    void fillMixture(const std::vector<float>& massRatios, const std::vector<float>& viscosities) {
        mixture_ = true;
        resize(slots_);
        if (sortedId_.size() > 0) resizeSorted(slots_);  // a recorded sort can't make room
        const std::vector<int> id = copy(id_);
        std::vector<real> ratio(slots_, 1), mu(slots_, 0);
        for (int i = 0; i < slots_; ++i)
            if (id[i] >= 0) ratio[i] = massRatios[id[i]], mu[i] = viscosities[id[i]];
        device_.upload(massRatio_.data(), ratio.data(), ratio.size());
        device_.upload(viscosity_.data(), mu.data(), mu.size());
    }

    // Particles of one cell end up beside each other, cells of one row too.
    void sort(const Grid& grid) {
        const int rows = grid.cells.y * grid.cells.z;
        key_.resize(slots_);
        cellStart_.resize(size_t(rows) * grid.cells.x + 1);
        device_.forEach(slots_, FindCell{view(), grid, key_.data()});
        const int slots = device_.sortByCell(slots_, key_.data(), rows, grid.cells.x, clusterSize,
                                             cellStart_.data(), order_);
        resizeSorted(slots);
        Particles sorted = view();
        sorted.id = sortedId_.data();
        sorted.position = {sortedPosition_.data()};
        sorted.velocity = {sortedVelocity_.data()};
        sorted.density = {sortedDensity_.data()};
        sorted.keptPosition = {sortedKept_.position.data()};
        sorted.keptVelocity = {sortedKept_.velocity.data()};
        sorted.keptDensity = {sortedKept_.density.data()};
        sorted.massRatio = {sortedMassRatio_.data()};
        sorted.viscosity = {sortedViscosity_.data()};
        sorted.timeBin = {sortedTimeBin_.data()};
        sorted.acceleration = {sortedAcceleration_.data()};
        sorted.densityRate = {sortedDensityRate_.data()};
        device_.forEach(slots, Reorder{order_.data(), view(), sorted});
        flip();
        resize(slots);
    }
    // The sorted copies become the particles: what a recorded sort can't do when it is run again,
    // because it is the host's work. `side` says which buffers are the particles now.
    void flip() {
        id_.swap(sortedId_);
        position_.swap(sortedPosition_);
        if (kind_ == Kind::Fluid) velocity_.swap(sortedVelocity_);
        if (sortsDensity()) density_.swap(sortedDensity_);
        if (hasTimeBins())
            timeBin_.swap(sortedTimeBin_), acceleration_.swap(sortedAcceleration_),
                densityRate_.swap(sortedDensityRate_);
        massRatio_.swap(sortedMassRatio_), viscosity_.swap(sortedViscosity_);
        kept_.position.swap(sortedKept_.position);
        kept_.velocity.swap(sortedKept_.velocity);
        kept_.density.swap(sortedKept_.density);
        side_ = 1 - side_;
    }
    int side() const { return side_; }
    // Boundary particles have a velocity only where fluid sticks to them, a density only where its
    // gradient is wanted. The first call says true: what they carry is to be filled in.
    bool carryVelocity() {
        const bool isNew = !std::exchange(carriesVelocity_, true);
        resize(slots_);
        return isNew;
    }
    void move() { moves_ = true, resize(slots_); }
    void accelerate() { accelerates_ = moves_ = true, resize(slots_); }
    void letSlip() { slips_ = true, resize(slots_); }
    bool slips() const { return slips_; }
    void continueFlow() { continues_ = true, resize(slots_); }
    void haveDensity() { hasDensity_ = true, resize(slots_); }
    // Fluid's density comes from a sum, or goes from step to step with a rate; with shifting its
    // particles leave the fluid's paths.
    void carryDensity() { carriesDensity_ = true; }
    void shift() { shifts_ = true; }
    // What integrators need besides: a velocity, or all of a state.
    void keepVelocity() { keepsVelocity_ = true; }
    void keepState() { keepsVelocity_ = keepsState_ = true; }
    void weighViscosity(bool weighs) {
        weighsViscosity_ = weighs;
        if (!weighs) viscousVolume_.release();
        resize(slots_);
    }
    // Where each began its step, for collisions.
    void keepPlace() { keepsPlace_ = true; }
    // Sums of pairs for forces that come on top of the others; normals of the surface.
    void addForces(bool pairs, bool normals) {
        addsPairs_ = pairs, hasNormals_ = normals;
        if (!pairs) addedForce_.release();
        if (!normals) normal_.release(), normalLength_.release();
        resize(slots_);
    }
    // Particles have steps of their own, or walls are but looked at where fluid is due.
    void stepLocally(bool locally) {
        stepsLocally_ = locally;
        resize(slots_);
        if (locally) {
            if (sortedId_.size() > 0) resizeSorted(slots_);  // a recorded sort can't make room
            return;
        }
        for (auto* b : {&timeBin_, &sortedTimeBin_, &sortedAcceleration_, &sortedDensityRate_})
            b->release();
        active_.release();
    }
    // Particles that never move are sorted once.
    void keepOrder() {
        sortedId_.release(), key_.release(), order_.release();
        sortedPosition_.release(), sortedVelocity_.release();
    }

    // Relative to the domain's lower corner, in the order of ids from firstId on: bit by bit what
    // upload() took, or what became of it.
    std::vector<Vec3> positions(int count, int firstId) const {
        return inOrder(position_, count, firstId);
    }
    std::vector<Vec3> velocities(int count, int firstId) const {
        return inOrder(velocity_, count, firstId);
    }
    // Empty where density is not carried.
    std::vector<float> densities(int count) const {
        if (!carriesDensity_) return {};
        const std::vector<real> values = copy(density_);
        const std::vector<int> id = copy(id_);
        std::vector<float> out(count);
        for (int i = 0; i < slots_; ++i)
            if (id[i] >= 0) out[id[i]] = float(values[i]);
        return out;
    }

    // In the order of ids, in world coordinates.
    std::vector<Particle> download(int count, Vec3 origin) const {
        std::vector<int> id = copy(id_);
        std::vector<real> x = copy(position_), u = copy(velocity_), a = copy(acceleration_);
        std::vector<real> rho = copy(density_), term = copy(pressureOverRho2_),
                          ratio = copy(massRatio_);
        const Particles host = onHost(slots_, id, x, u, a, rho, term, ratio);
        std::vector<Particle> out(count);
        for (int i = 0; i < slots_; ++i)
            if (id[i] >= 0) out[id[i]] = describe(host, i, origin);
        return out;
    }
    // Only the slots around the particle with this id are fetched.
    Particle downloadOne(int id, Vec3 origin) const {
        const std::vector<int> ids = copy(id_);
        const int slot = int(std::find(ids.begin(), ids.end(), id) - ids.begin());
        CHECK(slot < slots_);
        const int first = slot / clusterSize * clusterSize;
        auto vectors = [&](const Buffer<real, Device>& b) {
            return copy(b, vectorOffset(first, 0), vectorSize(clusterSize));
        };
        auto numbers = [&](const Buffer<real, Device>& b) {
            return copy(b, size_t(first), size_t(clusterSize));
        };
        std::vector<real> x = vectors(position_), u = vectors(velocity_),
                          a = vectors(acceleration_);
        std::vector<real> rho = numbers(density_), term = numbers(pressureOverRho2_), ratio;
        if (mixture_) ratio = numbers(massRatio_);
        std::vector<int> own(ids.begin() + first, ids.begin() + first + clusterSize);
        const Particles host = onHost(clusterSize, own, x, u, a, rho, term, ratio);
        return describe(host, slot - first, origin);
    }

private:
    void resize(int slots) {
        slots_ = slots;
        id_.resize(slots);
        position_.resize(vectorSize(slots));
        if (kind_ == Kind::Objects) return;
        pressureOverRho2_.resize(slots);
        if (carriesVelocity_) velocity_.resize(vectorSize(slots));
        if (hasDensity_) density_.resize(slots);
        if (stepsLocally_) active_.resize(size_t(slots / clusterSize));
        if (kind_ == Kind::Walls) {
            mass_.resize(slots);
            if (carriesVelocity_) outward_.resize(vectorSize(slots));
            if (moves_) ownVelocity_.resize(vectorSize(slots));
            if (accelerates_) ownAcceleration_.resize(vectorSize(slots));
            if (continues_)
                slip_.resize(slots), outward_.resize(vectorSize(slots)),
                    flowVelocity_.resize(vectorSize(slots));
            if (slips_) slip_.resize(slots), slipVelocity_.resize(vectorSize(slots));
            return;
        }
        acceleration_.resize(vectorSize(slots));
        if (addsPairs_) addedForce_.resize(vectorSize(slots));
        if (hasNormals_) normal_.resize(vectorSize(slots)), normalLength_.resize(slots);
        inverseDensity_.resize(slots);
        if (weighsViscosity_) viscousVolume_.resize(slots);
        if (carriesDensity_) densityRate_.resize(slots);
        if (mixture_) massRatio_.resize(slots), viscosity_.resize(slots);
        if (shifts_)
            for (auto* field : {&shiftVelocity_, &shiftAcceleration_})
                field->resize(vectorSize(slots));
        if (stepsLocally_) timeBin_.resize(slots);
        resizeKept(kept_, slots);
    }
    void resizeSorted(int slots) {
        sortedId_.resize(slots);
        sortedPosition_.resize(vectorSize(slots));
        if (kind_ == Kind::Fluid) sortedVelocity_.resize(vectorSize(slots));
        if (sortsDensity()) sortedDensity_.resize(slots);
        if (mixture_) sortedMassRatio_.resize(slots), sortedViscosity_.resize(slots);
        if (hasTimeBins())
            sortedTimeBin_.resize(slots), sortedAcceleration_.resize(vectorSize(slots));
        if (hasTimeBins() && carriesDensity_) sortedDensityRate_.resize(slots);
        resizeKept(sortedKept_, slots);
    }
    bool hasTimeBins() const { return stepsLocally_ && kind_ == Kind::Fluid; }
    bool sortsDensity() const { return carriesDensity_ || hasTimeBins(); }
    struct Kept {
        explicit Kept(Device& d) : position(d), velocity(d), density(d) {}
        Buffer<real, Device> position, velocity, density;
    };
    void resizeKept(Kept& kept, int slots) const {
        if (keepsVelocity_) kept.velocity.resize(vectorSize(slots));
        if (keepsState_ || keepsPlace_) kept.position.resize(vectorSize(slots));
        if (keepsState_ && carriesDensity_) kept.density.resize(slots);
    }
    static Particles onHost(int slots, std::vector<int>& id, std::vector<real>& x,
                            std::vector<real>& u, std::vector<real>& a, std::vector<real>& rho,
                            std::vector<real>& term, std::vector<real>& ratio) {
        Particles p{};
        p.slots = slots, p.id = id.data();
        p.position = {x.data()}, p.velocity = {u.data()}, p.acceleration = {a.data()};
        p.density = {rho.data()}, p.pressureOverRho2 = {term.data()},
        p.massRatio = {ratio.empty() ? nullptr : ratio.data()};
        return p;
    }
    static Particle describe(const Particles& host, int i, Vec3 origin) {
        auto toVec3d = [](Vector<real> v) { return Vec3d{double(v.x), double(v.y), double(v.z)}; };
        return {host.id[i],
                toVec3d(load(host.position, i)) + toDouble(origin),
                toVec3d(load(host.velocity, i)),
                toVec3d(load(host.acceleration, i)),
                double(densityOf(host, i)),
                double(pressureOf(host, i))};
    }
    std::vector<Vec3> inOrder(const Buffer<real, Device>& field, int count, int firstId) const {
        std::vector<real> values = copy(field);
        const std::vector<int> id = copy(id_);
        std::vector<Vec3> out(count);
        for (int i = 0; i < slots_; ++i) {
            if (id[i] < 0) continue;
            const Vector<real> v = load(VectorField{values.data()}, i);
            out[id[i] - firstId] = {float(v.x), float(v.y), float(v.z)};
        }
        return out;
    }
    template <class T> std::vector<T> copy(const Buffer<T, Device>& buffer) const {
        return copy(buffer, 0, buffer.size());
    }
    template <class T>
    std::vector<T> copy(const Buffer<T, Device>& buffer, size_t first, size_t count) const {
        std::vector<T> host(count);
        device_.download(host.data(), buffer.data() + first, count);
        return host;
    }

    Device& device_;
    Kind kind_;
    bool carriesVelocity_ = kind_ == Kind::Fluid, hasDensity_ = kind_ == Kind::Fluid,
         carriesDensity_ = false, shifts_ = false, moves_ = false, accelerates_ = false,
         slips_ = false, continues_ = false, keepsVelocity_ = false, keepsState_ = false,
         keepsPlace_ = false, stepsLocally_ = false, addsPairs_ = false, hasNormals_ = false,
         mixture_ = false, weighsViscosity_ = false;
    int slots_ = 0, side_ = 0;
    Buffer<int, Device> id_{device_}, sortedId_{device_}, key_{device_}, order_{device_},
        cellStart_{device_};
    Buffer<real, Device> position_{device_}, velocity_{device_}, acceleration_{device_},
        addedForce_{device_}, normal_{device_}, normalLength_{device_};
    Buffer<real, Device> sortedPosition_{device_}, sortedVelocity_{device_},
        sortedDensity_{device_};
    Buffer<real, Device> densityRate_{device_}, shiftVelocity_{device_},
        shiftAcceleration_{device_};
    Kept kept_{device_}, sortedKept_{device_};
    Buffer<real, Device> massRatio_{device_}, viscosity_{device_}, sortedMassRatio_{device_},
        sortedViscosity_{device_};
    Buffer<uint8_t, Device> active_{device_};
    Buffer<real, Device> timeBin_{device_}, sortedTimeBin_{device_}, sortedAcceleration_{device_},
        sortedDensityRate_{device_};
    Buffer<real, Device> density_{device_}, inverseDensity_{device_}, pressureOverRho2_{device_},
        mass_{device_}, outward_{device_}, ownVelocity_{device_}, ownAcceleration_{device_},
        slip_{device_}, slipVelocity_{device_}, flowVelocity_{device_}, viscousVolume_{device_};
};

}  // namespace spindrift::LANES
