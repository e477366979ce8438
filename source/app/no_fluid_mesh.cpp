#include "app/fluid_mesh.h"

#include "core/error.h"

namespace spindrift {

struct FluidLevelSet::Grid {};

FluidLevelSet::FluidLevelSet(const std::vector<Vec3d>&, double, double, int) {
    throw Error(Failure::Usage,
                "surface: this build has no OpenVDB; install it (apt-get install libopenvdb-dev) "
                "and build anew");
}
FluidLevelSet::~FluidLevelSet() = default;
FluidMesh FluidLevelSet::mesh(double, double&) const { return {}; }
bool FluidLevelSet::writeVdb(const std::string&, double) const { return false; }

}  // namespace spindrift
