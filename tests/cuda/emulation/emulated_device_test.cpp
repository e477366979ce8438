// Loops, sums, bins and the sort of the emulated GPU.
#include "cuda/device_test.cu"
