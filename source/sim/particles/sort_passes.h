// How particles are put in order by their cells.
#pragma once

#include "sim/particles/view.h"

namespace spindrift::LANES {

// Empty slots lie beyond this coordinate, m.
inline constexpr real farAway = 1e6;

// Sort key: the particle's cell, or `none` for an empty slot. One that is nowhere (not finite) has
// no neighbours in any cell; such particles are spread, because all of them in one cell would take
// forever.
struct FindCell {
    using Index = int;
    Particles p;
    Grid grid;
    int* key;
    int none;
    HD void operator()(int i) const {
        const Vector<real> x = load(p.position, i);
        const bool somewhere = dot(x, x) - dot(x, x) == 0;
        key[i] = p.id[i] < 0 ? none
                 : somewhere ? grid.cell(x)
                             : i % (grid.cells.x * grid.cells.y * grid.cells.z);
    }
};

// Fields that go along as particles are put in order.
struct Carried {
    static constexpr int most = 12;
    struct Field {
        real *from, *to;
        bool isVector, isPosition;
        real empty;
    } fields[most];
    int count;
};

// Moves what a particle carries from step to step to its new slot.
struct Reorder {
    using Index = int;
    const int* order;
    const int* id;
    int* sortedId;
    Carried carried;
    HD void operator()(int i) const {
        const int s = order[i];
        sortedId[i] = s < 0 ? -1 : id[s];
        // Empty slots: so far out that no distance to any particle is small or equal.
        const real far = 2 * farAway * real(1 + i % 4);
        for (int k = 0; k < carried.count; ++k) {
            const Carried::Field& f = carried.fields[k];
            const real empty = f.isPosition ? far : f.empty;
            if (f.isVector)
                store(VectorField{f.to}, i,
                      s < 0 ? Vector<real>{empty, empty, empty} : load(VectorField{f.from}, s));
            else
                store(ScalarField{f.to}, i, s < 0 ? empty : load(ScalarField{f.from}, s));
        }
    }
};

}  // namespace spindrift::LANES
