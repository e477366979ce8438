// The cells that particles are sorted by.
#pragma once

#include "scene/lattice.h"
#include "sim/particles/view.h"

#include <algorithm>
#include <cmath>

namespace spindrift::LANES {

// Rows two spacings wide, cells half a spacing long; larger when the box is so empty that cells
// would outnumber particles by far. One support radius more on each side than the domain, for
// boundary particles; along a periodic axis just the domain, in whole cells.
inline Grid makeGrid(const Scene& s, size_t particles) {
    const float dx = s.simulation.spacing;
    Vec3 rim, size = s.domain.max - s.domain.min;
    for (int k = 0; k < 3; ++k) {
        rim[k] = s.domain.periodic(k) ? 0 : supportRadius(s);
        size[k] += 2 * rim[k];
    }
    double length = 0.5 * dx, row = 2 * dx;
    auto cellsAlong = [](double extent, double cell) {
        return std::max(1.0, std::ceil(extent / cell));
    };
    auto total = [&] {
        return cellsAlong(size.x, length) * cellsAlong(size.y, row) * cellsAlong(size.z, row);
    };
    const double most =
        std::clamp<double>(16.0 * double(particles), 4e6, 2e9);  // cells are counted in 32 bits
    while (total() > most) {
        length *= 2;
        if (length > row) row = length;
    }
    Grid g;
    g.low = toVector(Vec3{} - rim);
    g.cells = {int(cellsAlong(size.x, length)), int(cellsAlong(size.y, row)),
               int(cellsAlong(size.z, row))};
    g.perMetre = {real(1 / length), real(1 / row), real(1 / row)};
    if (s.simulation.dimensions == 2) g.cells.z = 1, g.perMetre.z = real(1 / size.z);
    g.wraps = {s.domain.periodicX, s.domain.periodicY, s.domain.periodicZ};
    if (g.wraps.x) g.perMetre.x = real(g.cells.x / size.x);
    if (g.wraps.y) g.perMetre.y = real(g.cells.y / size.y);
    if (g.wraps.z) g.perMetre.z = real(g.cells.z / size.z);
    return g;
}

}  // namespace spindrift::LANES
