#pragma once
// Runs that are meant to break the physics, and what counts as broken.
#include "scene/scene.h"
#include "sim/simulation.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace spindrift {

struct StressCase {
    std::string name;
    Scene scene;
    int steps = 300;
    std::function<RunState(const Scene&)> start;  // empty: as the scene says
    std::function<void(Simulation&, Scene&, int step)>
        disturb;  // called before each tenth step, live knobs are taken over; empty: none is called
    bool energyIsConserved = true;  // nothing stirs, tilts or slides
};

// Sound: finite, inside the box, no energy from nothing, density within bounds. Stopped: not sound
// any more, and the health guard said so before anything else. Broken: wrong, and not a word.
enum class Verdict { Sound, Stopped, Broken };
struct StressResult {
    Verdict verdict = Verdict::Sound;
    std::string what;  // what was wrong, "" when sound
    int particles = 0;
    int64_t steps = 0;
    int retries = 0;  // how often the health guard went back
    double energyGain =
        0;  // largest gain of kinetic, potential and internal energy / (what of it can move at the
            // start: kinetic, internal, M g H, and M (c / 50)^2 / 2)
    double density = 0;          // largest rho / rho0 - 1
    double time = 0, speed = 0;  // of handle(): s simulated; the fastest particle, m/s
};

StressResult stress(const StressCase&);

// For so many seconds of the clock a hand drags the scene's solids and stirs its fluid at random,
// 60 times a second, between which the run does at most ten steps. Sound: nothing of what
// handled.h looks for.
StressResult handle(const Scene&, uint64_t seed, double seconds);

// Impacts, jets, sheets, single and coinciding particles, tilted gravity and so on, for each
// formulation that can do them. `full` adds those that take minutes: a million steps of a still
// pool, three million particles.
std::vector<StressCase> tortures(bool full);

// Some valid small scene: the same for the same seed.
StressCase randomCase(uint64_t seed);

// A coarse scene in a box of 1 m, with the knobs set ("path=value").
StressCase boxCase(const std::string& formulation, const std::vector<std::string>& knobs,
                   int steps);

}  // namespace spindrift
