#pragma once
// Flows with a known answer: how wrong is a run, and what did it cost?
#include "measure/chart.h"
#include "scene/scene.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace spindrift {

// One number that says how wrong a run is, and what it must stay below (in absolute value) where a
// target is set.
struct Metric {
    std::string name, unit;
    double value = 0;
    std::optional<double> target;
};

struct RunCost {
    int particles = 0, walls = 0;
    int64_t steps = 0;
    double seconds = 0;
    double megabytes = 0;
};

struct ValidationRun {
    int resolution = 0;
    std::string method;
    RunCost cost;
    std::vector<Metric> metrics;  // the first one tells the order of convergence
    Chart chart;
    bool diverged = false;  // and ended there; the metrics are NaN then
};

struct ValidationCase {
    std::string name, title;
    std::string scene;                    // in configs/validation/
    std::string reference;                // where the answer is from
    std::string length;                   // what the resolution counts particles along: "L / dx"
    std::vector<int> resolutions, quick;  // all, and what a short check takes
    std::function<void(Scene&, int)>
        adjust;  // what this case changes in its scene, at a resolution
    std::function<void(const Scene&, ValidationRun&)> run;
};

// `data` is the folder of the reference files, configs/validation/data. Throws Error (Scene) when
// one is missing.
std::vector<ValidationCase> validationCases(const std::string& data);

// Runs one case in its scene, which adjust() has made for that resolution. Throws as makeSimulation
// does.
ValidationRun validate(const ValidationCase&, const Scene& scene, int resolution);

}  // namespace spindrift
