#pragma once
// Flows with a free surface whose answers are known: cases of `spindrift validate`. `data` is the
// folder of the reference files.
#include "measure/validation.h"

namespace spindrift {

void runDrop(const Scene&, ValidationRun&);
// Targets count from a resolution on. With a submerged solid of that volume (m^3) also its lift.
void runHydrostatic(const Scene&, ValidationRun&, int judgedFrom, double volume = 0);
// A sphere that sinks; `terminal`: the largest speed of the experiment, m/s.
void runSettling(const Scene&, ValidationRun&, double terminal);
void runFront(const Scene&, ValidationRun&, const std::string& data);
void runImpact(const Scene&, ValidationRun&, const std::string& data);
void runKleefsman(const Scene&, ValidationRun&, const std::string& data);

}  // namespace spindrift
