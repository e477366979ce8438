// Particles of a device once the host has copied them.
#pragma once

#include "sim/particles/output_passes.h"
#include "sim/simulation.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace spindrift::LANES {

// Those that hold a particle, by rising ids.
inline std::vector<int> slotsInOrder(const std::vector<int>& id) {
    std::vector<int> slots;
    int least = std::numeric_limits<int>::max(), most = -1;
    for (int i = 0; i < int(id.size()); ++i)
        if (id[i] >= 0) {
            slots.push_back(i);
            least = std::min(least, id[i]), most = std::max(most, id[i]);
        }
    if (int64_t(most) - least + 1 == int64_t(slots.size())) {  // none is missing
        for (int i = 0; i < int(id.size()); ++i)
            if (id[i] >= 0) slots[size_t(id[i] - least)] = i;
    } else {
        std::sort(slots.begin(), slots.end(), [&](int a, int b) { return id[a] < id[b]; });
    }
    return slots;
}

// The first ones of a field.
inline std::vector<Vec3d> vectorsOf(const std::vector<real>& field, size_t count) {
    std::vector<Vec3d> out(count);
    for (size_t i = 0; i < count; ++i)
        for (int k = 0; k < 3; ++k) out[i][k] = double(field[vectorOffset(int(i), k)]);
    return out;
}

inline Particles onHost(int slots, std::vector<int>& id, std::vector<real>& x, std::vector<real>& u,
                        std::vector<real>& a, std::vector<real>& rho, std::vector<real>& term,
                        std::vector<real>& ratio) {
    Particles p{};
    p.slots = slots, p.id = id.data();
    p.position = {x.data()}, p.velocity = {u.data()}, p.acceleration = {a.data()};
    p.density = {rho.data()}, p.pressureOverRho2 = {term.data()},
    p.massRatio = {ratio.empty() ? nullptr : ratio.data()};
    return p;
}
inline Particle describe(const Particles& host, int i, Vec3 origin) {
    auto toVec3d = [](Vector<real> v) { return Vec3d{double(v.x), double(v.y), double(v.z)}; };
    return {host.id[i],
            toVec3d(load(host.position, i)) + toDouble(origin),
            toVec3d(load(host.velocity, i)),
            toVec3d(load(host.acceleration, i)),
            double(densityOf(host, i)),
            double(pressureOf(host, i))};
}

}  // namespace spindrift::LANES
