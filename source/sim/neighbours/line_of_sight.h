#pragma once
// How much two points see of each other past a scene's thin solids, as fluid does (screens.h).
#include "sim/simulation.h"

#include <functional>

namespace spindrift {

class LineOfSight {
public:
    explicit LineOfSight(const Scene&);
    bool anyThin() const;
    // With solids at these poses: from 0, where they hide all, to 1. Points in m, relative to the
    // domain's lower corner.
    std::function<double(Vec3d, Vec3d)> past(const std::vector<SolidPose>&) const;

private:
    struct Solids;
    std::shared_ptr<const Solids> solids_;
};

}  // namespace spindrift
