// device_test.cu, compiled for the emulated GPU: CMake and Meson know .cu files as nvcc's.
#include "cuda/device_test.cu"
