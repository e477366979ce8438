#pragma once
// Flows with a free surface whose answers are known: cases of `spindrift validate`. `data` is the
// folder of the reference files.
#include "measure/validation.h"

namespace spindrift {

void runDrop(const Scene&, ValidationRun&);
// Small oscillations that viscosity damps: of a standing wave, of a drop; a disc that turns as a
// solid, in which nothing may happen; a film that flows down an incline (Nusselt 1916).
void runViscousWave(const Scene&, ValidationRun&);
void runViscousDrop(const Scene&, ValidationRun&);
void runRotation(const Scene&, ValidationRun&);
void runFilm(const Scene&, ValidationRun&);
// Targets count from a resolution on. With a submerged solid of that volume (m^3) also its lift.
void runHydrostatic(const Scene&, ValidationRun&, int judgedFrom, double volume = 0);
// A sphere that sinks; `terminal`: the largest speed of the experiment, m/s.
void runSettling(const Scene&, ValidationRun&, double terminal);
void runFront(const Scene&, ValidationRun&, const std::string& data);
void runImpact(const Scene&, ValidationRun&, const std::string& data);
void runKleefsman(const Scene&, ValidationRun&, const std::string& data);

}  // namespace spindrift
