#include "app/fluid_mesh.h"

#include "core/error.h"

namespace spindrift {

bool canMeshFluid() { return false; }
void requireFluidMeshes(const std::string& what, double) {
    throw Error(Failure::Usage,
                what +
                    ": there is no spindrift-surface beside this program; `make build` makes it "
                    "where OpenVDB is (apt-get install libopenvdb-dev)");
}

struct FluidLevelSet::Grid {};

FluidLevelSet::FluidLevelSet(const std::vector<Vec3d>&, double, const SurfaceMethod&) {
    requireFluidMeshes("surface", 0);
}
FluidLevelSet::~FluidLevelSet() = default;
FluidMesh FluidLevelSet::mesh(double, double&) const { return {}; }
bool FluidLevelSet::writeVdb(const std::string&, double) const { return false; }

}  // namespace spindrift
