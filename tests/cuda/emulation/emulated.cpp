// The GPU's code and its tests, compiled for the emulated GPU.
#include "device/cuda.cu"
#include "sim/simulation_cuda.cu"
#undef SPINDRIFT_REAL
#undef LANES
