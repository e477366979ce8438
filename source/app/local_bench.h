#pragma once
#include <string>

namespace spindrift {

struct LocalBenchOptions {
    std::string only;  // cases whose name contains this; "" = all
    std::string out;   // folder of local.json, local.md and a chart of each case; "" = none
};

// Local steps against the step of all (time.mode): the same simulated time in both, how long it
// takes, and how far the results are apart, beside how far those of the step of all are apart from
// half and twice that step. A dam break, a pool at rest, a drop into a large still pool, balls that
// drop and come to rest. Writes a table to standard output. Returns Exit::Ok. Throws Error.
int benchLocalSteps(const LocalBenchOptions&);

}  // namespace spindrift
