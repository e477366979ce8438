// What a neighbour search keeps between passes: boxes and lists of clusters with SIMD, nothing
// otherwise.
#pragma once

#ifdef SPINDRIFT_SIMD
#include "sim/half_list_sums.h"
namespace spindrift::LANES {
using Boxes = ClusterBoxes;
using NeighbourLists = ClusterLists;
}  // namespace spindrift::LANES
#else
#include "sim/view.h"
namespace spindrift::LANES {
// One particle at a time walks the rows of cells: no boxes, no lists.
struct Boxes {
    template <class... A> void compute(A&&...) {}
    template <class... A> void findSides(A&&...) {}
};
// What lists would have to know of thin solids.
struct Sight {
    const Screens* screens = nullptr;
    Between between = Between::Nobody;
    Particles own{}, other{};
};
struct NeighbourLists {
    template <class... A> void invalidate(A&&...) {}
    template <class D> void build(D&, const Grid&, float, const Boxes&, const uint8_t*,
                                  const Boxes&, const int*, bool = false, const Sight& = {}) {}
    ClusterList* data() { return nullptr; }
    PairsSeen pairsSeen() const { return {}; }
    int64_t bytes() const { return 0; }
};
struct HalfListSums {
    template <class... A> void run(A&&...) {}
    int64_t bytes() const { return 0; }
};
}  // namespace spindrift::LANES
#endif
