#pragma once
// Flows without a free surface whose answers are known: cases of `spindrift validate`.
#include "measure/validation.h"

namespace spindrift {

// At `until` s; targets of L1: from which resolution on, and how large.
void runTaylorGreen(const Scene&, ValidationRun&, double until,
                    const std::vector<std::pair<int, double>>& targets);
void runPoiseuille(const Scene&, ValidationRun&);
// The same where fluid slides freely on the upper plate, and where it slips on both by walls.slip.
void runHalfChannel(const Scene&, ValidationRun&);
void runSlipChannel(const Scene&, ValidationRun&);
void runCouette(const Scene&, ValidationRun&);
// Against a column of the reference files in the folder `data`, mean of the last tenth before `end`
// s; rms below `target` % is wanted at resolutions of `from` and above.
void runCavity(const Scene&, ValidationRun&, const std::string& data, const std::string& column,
               double end, double target, int from);
void runConservation(const Scene&, ValidationRun&);
void runSoundWave(const Scene&, ValidationRun&);

}  // namespace spindrift
