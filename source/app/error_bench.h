#pragma once
#include <string>
#include <vector>

namespace spindrift {

struct ErrorBenchOptions {
    std::vector<std::string> cases;   // names of validation cases; empty = those that the figures are about
    std::string out;                  // folder of error.csv, error.json, error.md and a chart of each case; "" = none
};

// Run time against error: each case at its resolutions with other formulations, kernels, supports, time steps and precision,
// one of them changed at a time. Marks what is on the Pareto front: nothing else is as good in less time. Throws Error.
int benchError(const ErrorBenchOptions&);

}  // namespace spindrift
