// Lent GL buffers, compiled for the emulated GPU.
#include "render/cuda_interop.cpp"
