#pragma once
#include <string>
#include <vector>

namespace spindrift {

struct ErrorBenchOptions {
    std::vector<std::string>
        cases;  // names of validation cases; empty = those that the figures are about
    std::string
        out;  // folder of error.csv, error.json, error.md and a chart of each case; "" = none
    bool coarsest = false;  // that resolution alone
};

// Run time against error: each case at its coarsest resolution with all formulations, kernels,
// supports and Courant numbers, the best of them at finer ones; the shipped method everywhere, also
// with fixed steps, in double precision and on the GPU. Marks what is on the Pareto front: nothing
// else is as good in less time. Throws Error.
int benchError(const ErrorBenchOptions&);

}  // namespace spindrift
