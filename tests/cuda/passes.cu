// The physics compiled for CUDA: every pass as a kernel with one particle a thread, from the same source as the CPU's.
// Proof that nothing in it is bound to the host; the CUDA device that runs them comes with the GPU backend.
#define SPINDRIFT_REAL float
#define LANES cudaLanes
#include "sim/output_passes.h"
#include "sim/passes.h"

namespace spindrift::cudaLanes {

template <class Pass> __global__ void forEach(int n, Pass pass) {
    const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < n) pass(i);
}
template <class Reduction, class Value> __global__ void addAll(int n, Reduction reduction, Value* sum) {
    for (int i = 0; i < n; ++i) reduction.addTo(*sum, i);
}

template __global__ void forEach(int, FindCell);
template __global__ void forEach(int, Reorder);
template __global__ void forEach(int, ComputeWallMass<WendlandC2Kernel>);
template __global__ void forEach(int, ComputeDensity<WendlandC2Kernel>);
template __global__ void forEach(int, ComputeDensity<CubicSplineKernel>);
template __global__ void forEach(int, ExtrapolateWallPressure<WendlandC2Kernel>);
template __global__ void forEach(
    int, ComputeForces<WendlandC2Kernel, TermList<PressureForce, LaminarViscosity, ArtificialViscosity>>);
template __global__ void forEach(int, ComputeForces<CubicSplineKernel, TermList<PressureForce, ClassicViscosity>>);
template __global__ void forEach(int, ChooseTimeStep);
template __global__ void forEach(int, StirFluid);
template __global__ void forEach(int, Integrate);
template __global__ void addAll(int, FindExtremes, Extremes*);
template __global__ void addAll(int, SumUp, Totals*);
template __global__ void addAll(int, WriteVertices<SpeedValue>, ValueRange*);

}  // namespace spindrift::cudaLanes
