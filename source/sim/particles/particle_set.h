// Owns the buffers of one kind of particles and keeps them sorted by cell.
#pragma once

#include "device/buffer.h"
#include "core/error.h"
#include "sim/particles/on_host.h"
#include "sim/particles/particle_fields.h"
#include "sim/particles/sort_passes.h"
#include "sim/run_state.h"
#include "sim/simulation.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numeric>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace spindrift::LANES {

template <class Device> class ParticleSet {
public:
    ParticleSet(Device& device, Kind kind) : device_(device), holds_{} {
        holds_.kind = kind, holds_.velocity = holds_.density = kind == Kind::Fluid;
    }

    int slots() const { return slots_; }
    const int* cellStart() const { return cellStart_.data(); }

    Particles view() const {
        Particles p = shownIn(now_);
        p.id = id_.data();
        if (!holds_.viscousVolume) p.viscousVolume = p.inverseDensity;
        return p;
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
        resize(std::max(wholeClusters(n), Device::recordsSteps ? reserved_ : 0));
        std::vector<real> x(vectorSize(slots_), 2 * farAway), u(vectorSize(slots_)),
            rho(densities.begin(), densities.end());
        rho.resize(size_t(slots_), rho.empty() ? 0 : rho[0]);
        std::vector<int> id(slots_, -1);
        for (int i = 0; i < n; ++i) {
            id[i] = ids[i];
            for (int k = 0; k < 3; ++k) {
                x[vectorOffset(i, k)] = positions[i][k];
                if (kind() == Kind::Fluid) u[vectorOffset(i, k)] = velocities[i][k];
            }
        }
        upload(&Particles::position, x);
        if (kind() == Kind::Fluid) upload(&Particles::velocity, u);
        if (holds_.densityRate) upload(&Particles::density, rho);
        device_.upload(id_.data(), id.data(), id.size());
    }

    // Particles come and go from now on, in so many slots at most: no step allocates any. A device
    // that records steps has all of them always, empty ones behind the others.
    void comeAndGo(int slots) {
        holds_.comesAndGoes = true;
        reserved_ = wholeClusters(slots);
    }
    int reserved() const { return reserved_; }
    // Empty slots for `count` particles behind the others, until the next sort. Returns the first,
    // in memory of the device.
    const int* makeRoom(int count) {
        if constexpr (!Device::recordsSteps) {
            const int slots = slots_ + wholeClusters(count);
            CHECK(slots <= reserved_);
            resize(slots);
        }
        return cellStart_.data() + cellStart_.size() - 2;
    }
    // Which point of a source holds each, in the order of the upload just done.
    void setHeldBy(const std::vector<int>& points) {
        std::vector<real> values(points.begin(), points.end());
        values.resize(size_t(slots_), 0);
        upload(&Particles::heldBy, values);
    }

    // What each particle of a mixture is, by ids from 0 on: see View.
    void fillMixture(const std::vector<float>& massRatios, const std::vector<float>& viscosities) {
        holds_.mixture = true;
        resize(slots_);
        if (sortedId_.size() > 0) resizeSorted(slots_);  // a recorded sort can't make room
        const std::vector<int> id = id_.download();
        std::vector<real> ratio(slots_, 1), mu(slots_, 0);
        for (int i = 0; i < slots_; ++i)
            if (id[i] >= 0) ratio[i] = massRatios[id[i]], mu[i] = viscosities[id[i]];
        upload(&Particles::massRatio, ratio);
        upload(&Particles::viscosity, mu);
    }

    // Particles of one cell end up beside each other, cells of one row too.
    void sort(const Grid& grid) {
        const int rows = grid.cells.y * grid.cells.z;
        const size_t cells = size_t(rows) * grid.cells.x;
        fit(key_, slots_, reserved_);
        fit(order_, slots_, reserved_);
        cellStart_.resize(cells + 2);
        device_.forEach(slots_,
                        FindCell{view(), grid, key_.data(), Device::dropsItems ? -1 : int(cells)});
        const int slots = device_.sortByCell(slots_, key_.data(), rows, grid.cells.x, clusterSize,
                                             cellStart_.data(), order_);
        resizeSorted(slots);
        device_.forEach(slots, Reorder{order_.data(), id_.data(), sortedId_.data(), carried()});
        flip();
        resize(slots);
    }
    // The sorted copies become the particles: what a recorded sort can't do when it is run again,
    // because it is the host's work. `side` says which buffers are the particles now.
    void flip() {
        id_.swap(sortedId_);
        forFields([&](const ParticleField& field, size_t k) {
            if (field.sorted(holds_)) now_[k].swap(sorted_[k]);
        });
        side_ = 1 - side_;
    }
    int side() const { return side_; }
    // What it is to hold (Holdings). carryVelocity() says whether that is new: what boundary
    // particles carry is to be filled in.
    bool carryVelocity() { return !std::exchange(holds_.velocity, true) && (resize(slots_), true); }
    void move() { holds_.moves = true, resize(slots_); }
    void accelerate() { holds_.accelerates = holds_.moves = true, resize(slots_); }
    void continueFlow() { holds_.continues = true, resize(slots_); }
    void letSlip() { holds_.slips = true, resize(slots_); }
    bool slips() const { return holds_.slips; }
    void haveDensity() { holds_.density = true, resize(slots_); }
    void carryDensity() { holds_.densityRate = true; }
    void shift() { holds_.shifts = true; }
    void solvePressure() { holds_.solvesPressure = true; }
    void keepVelocity() { holds_.keepsVelocity = true; }
    void keepState() { holds_.keepsVelocity = holds_.keepsState = true; }
    void keepPlace() { holds_.keepsPlace = true; }
    void weighViscosity(bool weighs) { holds_.viscousVolume = weighs, resize(slots_); }
    void addForces(bool pairs, bool normals) {
        holds_.addsPairs = pairs, holds_.normals = normals;
        resize(slots_);
    }
    void stepInBlocks(bool blocks) {
        holds_.timeBins = blocks;
        resize(slots_);
        if (sortedId_.size() > 0) resizeSorted(slots_);  // a recorded sort can't make room
    }
    // Particles that never move are sorted once.
    void keepOrder() {
        sortedId_.release(), key_.release(), order_.release();
        for (Numbers& field : sorted_) field.release();
    }

    // Into a state, relative to the domain's lower corner and in the order of ids: bit by bit what
    // upload() took, or what became of it. All of it is fetched at once.
    void save(RunState& state) const {
        std::vector<int> id = id_.fetch();
        std::vector<real> x = now(&Particles::position).fetch(),
                          u = now(&Particles::velocity).fetch(), rho, p, held;
        if (holds_.densityRate) rho = now(&Particles::density).fetch();
        if (holds_.solvesPressure) p = now(&Particles::pressureOverRho2).fetch();
        if (holds_.comesAndGoes) held = now(&Particles::heldBy).fetch();
        device_.wait();
        const std::vector<int> slots = slotsInOrder(id);
        const auto vectors = [&](std::vector<real>& field, std::vector<Vec3>& out) {
            out.reserve(slots.size());
            for (const int slot : slots) {
                const Vector<real> v = load(VectorField{field.data()}, slot);
                out.push_back({float(v.x), float(v.y), float(v.z)});
            }
        };
        vectors(x, state.particles.positions), vectors(u, state.particles.velocities);
        for (const int slot : slots) {
            if (!rho.empty()) state.densities.push_back(float(rho[size_t(slot)]));
            if (!p.empty()) state.pressures.push_back(float(p[size_t(slot)]));
            if (held.empty()) continue;
            state.particles.ids.push_back(id[size_t(slot)]);
            state.particles.heldBy.push_back(int(held[size_t(slot)]));
        }
    }
    // p / rho^2 in the order of the upload just done, 0 of those behind.
    void setPressures(const std::vector<float>& pressures) {
        std::vector<real> values(pressures.begin(), pressures.end());
        values.resize(size_t(slots_), 0);
        upload(&Particles::pressureOverRho2, values);
    }

    // In the order of ids, in world coordinates.
    std::vector<Particle> download(Vec3 origin) const {
        std::vector<int> id = id_.fetch();
        std::vector<real> x = now(&Particles::position).fetch(),
                          u = now(&Particles::velocity).fetch(),
                          a = now(&Particles::acceleration).fetch(),
                          rho = now(&Particles::density).fetch(),
                          term = now(&Particles::pressureOverRho2).fetch(),
                          ratio = now(&Particles::massRatio).fetch();
        device_.wait();
        const Particles host = onHost(slots_, id, x, u, a, rho, term, ratio);
        std::vector<Particle> out;
        for (const int slot : slotsInOrder(id)) out.push_back(describe(host, slot, origin));
        return out;
    }
    // Only the slots around the particle with this id are fetched. Nothing where there is none.
    std::optional<Particle> downloadOne(int id, Vec3 origin) const {
        const int slot =
            device_.template sum<SlotFound>(slots_, FindSlot{id_.data(), id}).number - 1;
        if (slot < 0) return {};
        const int first = slot / clusterSize * clusterSize;
        auto vectors = [&](VectorField Particles::*field) {
            return piece(now(field), size_t(vectorOffset(first, 0)), vectorSize(clusterSize));
        };
        auto numbers = [&](ScalarField Particles::*field) {
            return piece(now(field), size_t(first), size_t(clusterSize));
        };
        std::vector<real> x = vectors(&Particles::position), u = vectors(&Particles::velocity),
                          a = vectors(&Particles::acceleration), rho = numbers(&Particles::density),
                          term = numbers(&Particles::pressureOverRho2), ratio;
        if (holds_.mixture) ratio = numbers(&Particles::massRatio);
        std::vector<int> own = piece(id_, size_t(first), size_t(clusterSize));
        device_.wait();
        const Particles host = onHost(clusterSize, own, x, u, a, rho, term, ratio);
        return describe(host, slot - first, origin);
    }

private:
    using Numbers = Buffer<real, Device>;
    static constexpr size_t fieldCount = std::size(particleFields);
    using Fields = std::array<Numbers, fieldCount>;

    static int wholeClusters(int particles) {
        return (particles + clusterSize - 1) / clusterSize * clusterSize;
    }
    // So many elements, of a buffer that has room for as many as there may ever be.
    template <class T> static void fit(Buffer<T, Device>& buffer, size_t n, size_t most) {
        buffer.resize(std::max(n, most));
        buffer.resize(n);
    }
    Kind kind() const { return holds_.kind; }
    // f(field, its number) for each field that there is.
    template <class F> static void forFields(const F& f) {
        for (size_t k = 0; k < fieldCount; ++k) f(particleFields[k], k);
    }
    static size_t numbersIn(const ParticleField& field, int slots) {
        return field.isVector() ? size_t(vectorSize(slots)) : size_t(slots);
    }
    void resize(int slots) {
        slots_ = slots;
        fit(id_, slots, reserved_);
        forFields([&](const ParticleField& field, size_t k) {
            if (field.held(holds_))
                fit(now_[k], numbersIn(field, slots), numbersIn(field, reserved_));
            else
                now_[k].release();
        });
        if (holds_.timeBins)
            active_.resize(size_t(slots / clusterSize));
        else
            active_.release();
    }
    void resizeSorted(int slots) {
        fit(sortedId_, slots, reserved_);
        forFields([&](const ParticleField& field, size_t k) {
            if (field.sorted(holds_))
                fit(sorted_[k], numbersIn(field, slots), numbersIn(field, reserved_));
            else
                sorted_[k].release();
        });
    }
    Particles shownIn(const Fields& fields) const {
        Particles p{};
        p.slots = slots_, p.active = active_.data();
        forFields([&](const ParticleField& field, size_t k) {
            if (field.isVector())
                p.*field.vector = {fields[k].data()};
            else
                p.*field.scalar = {fields[k].data()};
        });
        return p;
    }
    Carried carried() const {
        Carried all{};
        forFields([&](const ParticleField& field, size_t k) {
            if (!field.sorted(holds_)) return;
            CHECK(all.count < Carried::most);
            all.fields[all.count++] = {now_[k].data(), sorted_[k].data(), field.isVector(),
                                       field.isPosition(), field.empty};
        });
        return all;
    }
    template <class Field> const Numbers& now(Field Particles::*field) const {
        size_t found = fieldCount;
        forFields([&](const ParticleField& f, size_t k) {
            if constexpr (std::is_same_v<Field, VectorField>) {
                if (f.vector == field) found = k;
            } else {
                if (f.scalar == field) found = k;
            }
        });
        return now_[found];
    }
    template <class Field> void upload(Field Particles::*field, const std::vector<real>& values) {
        device_.upload(now(field).data(), values.data(), values.size());
    }
    template <size_t... k> static Fields makeFields(Device& device, std::index_sequence<k...>) {
        return {((void)k, Numbers(device))...};
    }
    // There once the device has been waited for.
    template <class T>
    std::vector<T> piece(const Buffer<T, Device>& buffer, size_t first, size_t count) const {
        std::vector<T> host(count);
        device_.fetch(host.data(), buffer.data() + first, count);
        return host;
    }

    Device& device_;
    Holdings holds_;
    int slots_ = 0, side_ = 0, reserved_ = 0;
    Buffer<int, Device> id_{device_}, sortedId_{device_}, key_{device_}, order_{device_},
        cellStart_{device_};
    Buffer<uint8_t, Device> active_{device_};
    Fields now_ = makeFields(device_, std::make_index_sequence<fieldCount>{}),
           sorted_ = makeFields(device_, std::make_index_sequence<fieldCount>{});
};

}  // namespace spindrift::LANES
