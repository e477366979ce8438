// The order of particles in memory, and with SIMD the boxes and lists of clusters: which
// neighbours each has, and for how long that holds.
#pragma once

#ifdef SPINDRIFT_SIMD
#include "core/pass_time.h"
#include "sim/neighbours/half_list_sums.h"
namespace spindrift::LANES {
using Boxes = ClusterBoxes;
using NeighbourLists = ClusterLists;
}  // namespace spindrift::LANES
#else
#include "core/pass_time.h"
#include "sim/particles/view.h"
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

#include "sim/particles/particle_set.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace spindrift::LANES {

// Order and lists reach further than the support by a skin, and hold until two particles may have
// come closer by it. The boundary particles' order is kept where they never move.
template <class Device> class NeighbourSearch {
public:
    static constexpr bool keepsLists = clusterSize > 1;
    static_assert(!keepsLists || Device::hostReadable, "how far particles move is read as they go");

    NeighbourSearch(Device& device, const Grid& grid) : device_(device), grid_(grid) {}

    const Grid& grid() const { return grid_; }

    // No particle has moved by more than this since the last call, m.
    void movedAtMost(double distance) { displacementBound_ += distance; }
    // Other particles, or lists of another kind are wanted: nothing holds.
    void outdate() { displacementBound_ = unknown; }
    // Asked once before each evaluation of forces.
    bool holds() {
        lastMove_ = displacementBound_ - std::exchange(boundBefore_, displacementBound_);
        return keepsLists && displacementBound_ < skin_ / 2;
    }
    // A new order begins, whose skin is `asked`, in support radii, or longer. Where a small share
    // is awake lists are short and the sort, which knows no rest, is what costs: both cost the same
    // with a skin that grows as 1/sqrt(share awake). Blocks are large enough for 0.4 support radii.
    // Where lists would not outlive a step like the last one, they reach no further than they must.
    void renew(float asked, float support, double shareAwake) {
        if constexpr (keepsLists) {
            const float share = float(std::max(shareAwake, 1e-3));
            const float skin = support * std::max(asked, std::min(asked / std::sqrt(share), 0.4f));
            skin_ = displacementBound_ < unknown / 10 && lastMove_ >= skin / 2 ? 0 : skin;
        }
        reach_ = support + skin_;
        displacementBound_ = boundBefore_ = 0;
    }
    // m, how far lists see beyond the support.
    float skin() const { return skin_; }

    void sort(ParticleSet<Device>& fluid) {
        fluid.sort(grid_);
        boxes_.compute(device_, fluid.view());
    }
    void sortWalls(ParticleSet<Device>& walls) {
        walls.sort(grid_);
        wallBoxes_.compute(device_, walls.view());
    }
    // On which sides of thin solids clusters are.
    void findSides(const View& v) {
        boxes_.findSides(device_, v.fluid, v.screens, reach_, false);
        wallBoxes_.findSides(device_, v.walls, v.screens, reach_, true);
    }
    void invalidate(const View& v) {
        for (NeighbourLists* lists : {&fluidNearFluid_, &wallsNearFluid_})
            lists->invalidate(v.fluid);
        fluidNearWalls_.invalidate(v.walls);
    }
    // Of active particles. With `half` each pair of fluid is held once; `ofWalls`: walls look for
    // fluid too, all of them or the active ones.
    enum class OfWalls { None, Active, All };
    void find(const View& v, bool half, OfWalls ofWalls) {
        fluidNearFluid_.build(device_, grid_, reach_, boxes_, v.fluid.active, boxes_,
                              v.fluidNearFluid.cellStart, half,
                              {v.screens, Between::Fluid, v.fluid, v.fluid});
        wallsNearFluid_.build(device_, grid_, reach_, boxes_, v.fluid.active, wallBoxes_,
                              v.wallsNearFluid.cellStart, false,
                              {v.screens, Between::FluidAndWalls, v.fluid, v.walls});
        if (ofWalls == OfWalls::None) return;
        fluidNearWalls_.build(device_, grid_, reach_, wallBoxes_,
                              ofWalls == OfWalls::All ? nullptr : v.walls.active, boxes_,
                              v.fluidNearWalls.cellStart, false,
                              {v.screens, Between::WallsAndFluid, v.walls, v.fluid});
    }
    // All of the fluid's, each pair from both sides, for as long as `use` takes: for pictures,
    // where steps have half of them or leave out what rests. `use` is called with a view of them.
    template <class Use> void amongFluid(View v, const Use& use) {
        NeighbourLists all;
        all.invalidate(v.fluid);
        all.build(device_, grid_, reach_, boxes_, nullptr, boxes_, v.fluidNearFluid.cellStart,
                  false, {v.screens, Between::Fluid, v.fluid, v.fluid});
        v.fluidNearFluid.lists = all.data();
        use(v);
    }
    // Of walls among themselves, for as long as `use` takes: their masses are of it alone.
    template <class Use>
    void amongWalls(ParticleSet<Device>& walls, float support, const Use& use) {
        wallsNearWalls_.invalidate(walls.view());
        wallsNearWalls_.build(device_, grid_, support, wallBoxes_, nullptr, wallBoxes_,
                              walls.cellStart());
        use();
        wallsNearWalls_ = {};
    }

    void show(View& v, const int* fluidCells, const int* wallCells) {
        v.fluidNearFluid = {fluidNearFluid_.data(), fluidCells, v.fluid.position, Between::Fluid};
        v.wallsNearFluid = {wallsNearFluid_.data(), wallCells, v.walls.position,
                            Between::FluidAndWalls};
        v.fluidNearWalls = {fluidNearWalls_.data(), fluidCells, v.fluid.position,
                            Between::WallsAndFluid};
        v.wallsNearWalls = {wallsNearWalls_.data(), wallCells, v.walls.position};
        v.grid = grid_;
    }
    // A pass over pairs that the fluid's half lists hold.
    template <class Pass> void overPairs(const Pass& pass) {
        halfListSums_.run(device_, fluidNearFluid_, pass);
    }
    const Boxes& fluidBoxes() const { return boxes_; }
    PairsSeen pairsSeen() const { return fluidNearFluid_.pairsSeen(); }
    int64_t bytes() const {
        int64_t lists = 0;
        for (const NeighbourLists* l : {&fluidNearFluid_, &wallsNearFluid_, &fluidNearWalls_})
            lists += l->bytes();
        return lists + halfListSums_.bytes();
    }

private:
    static constexpr double unknown = 1e30;

    Device& device_;
    Grid grid_;
    double displacementBound_ = unknown;  // m, of any particle since the order began,
    double boundBefore_ = unknown;        // and when it was last asked for
    double lastMove_ = unknown;           // m, between the last two times
    float skin_ = 0, reach_ = 0;          // m
    Boxes boxes_, wallBoxes_;
    NeighbourLists fluidNearFluid_, wallsNearFluid_, fluidNearWalls_, wallsNearWalls_;
    HalfListSums halfListSums_;
};

}  // namespace spindrift::LANES
