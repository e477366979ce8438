// The two sorts on the emulated GPU.
#include "cuda/sort_bench.cu"
