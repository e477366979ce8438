// Density and forces on the emulated GPU, against the sum over all pairs.
#include "unit/sim/neighbours_test.cpp"
