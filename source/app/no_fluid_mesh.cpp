#include "app/fluid_mesh.h"

#include "core/error.h"

namespace spindrift {

bool canMeshFluid() { return false; }

struct FluidLevelSet::Grid {};

FluidLevelSet::FluidLevelSet(const std::vector<Vec3d>&, double, double, int) {
    throw Error(Failure::Usage,
                "surface: there is no spindrift-surface beside this program; `make build` makes it "
                "where OpenVDB is (apt-get install libopenvdb-dev)");
}
FluidLevelSet::~FluidLevelSet() = default;
FluidMesh FluidLevelSet::mesh(double, double&) const { return {}; }
bool FluidLevelSet::writeVdb(const std::string&, double) const { return false; }

}  // namespace spindrift
