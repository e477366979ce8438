#include "app/window/remedies.h"

#include "core/error.h"
#include "measure/validity.h"
#include "scene/check.h"
#include "scene/formulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace spindrift {

namespace {

using How = Remedy::How;

// Nor one that would be outside its validity where the scene is not.
void addIfAllowed(std::vector<Remedy>& all, const Scene& scene, Remedy remedy) {
    try {
        Scene ofRun = remedy.scene;
        ofRun.view = {};  // no view makes a run impossible
        checkScene(ofRun);
    } catch (const Error&) { return; }
    if (remarksOn(remedy.scene).size() <= remarksOn(scene).size()) all.push_back(std::move(remedy));
}

Remedy incompressible(Scene scene) {
    scene.simulation.formulation = Formulation::Incompressible;
    return {
        "Solve for pressures",
        "simulation.formulation = incompressible\nFrom here on steps are bounded by how fast the "
        "fluid moves,\nnot by sound: fewer, longer ones. R brings the scene back as loaded.",
        How::GoOn, std::move(scene)};
}

Remedy preview(Scene scene) {
    scene.solver.densityError = 0.01f, scene.time.cfl = 1;
    return {"Preview: larger error, longer steps",
            "solver.density_error = 0.01, time.cfl = 1\nDensities may be wrong by 1 % in the mean. "
            "Ctrl + Z takes it back.",
            How::Live, std::move(scene)};
}

Remedy coarser(Scene scene) {
    const double longer = scene.simulation.dimensions == 2 ? std::sqrt(2.0) : std::cbrt(2.0);
    scene.simulation.spacing = float(longer * double(scene.simulation.spacing));
    return {"Half as many particles",
            fmt::format("simulation.spacing = {:.3g} m\nBegins anew, with longer steps as "
                        "well.\nThe list of scenes has it as it was.",
                        scene.simulation.spacing),
            How::Again, std::move(scene)};
}

}  // namespace

std::vector<Remedy> remediesFor(const Scene& scene, bool isGoingOn) {
    std::vector<Remedy> all;
    const FormulationFacts& facts = factsOf(scene);
    if (!facts.solvesPressure && !facts.isHistorical)
        addIfAllowed(all, scene, incompressible(scene));
    if (facts.solvesPressure && (scene.solver.densityError < 0.01f || scene.time.cfl < 1))
        addIfAllowed(all, scene, preview(scene));
    if (!isGoingOn) addIfAllowed(all, scene, coarser(scene));
    return all;
}

std::string slowestPasses(const std::vector<PassTime>& times) {
    std::vector<PassTime> sorted = times;
    std::sort(sorted.begin(), sorted.end(),
              [](const PassTime& a, const PassTime& b) { return a.ms > b.ms; });
    double all = 0;
    for (const PassTime& t : sorted) all += t.ms;
    std::string said;
    for (size_t k = 0; k < std::min<size_t>(2, sorted.size()) && all > 0; ++k)
        said += fmt::format("{}{} {:.0f} %", said.empty() ? "" : ", ", sorted[k].name,
                            100 * sorted[k].ms / all);
    return said;
}

}  // namespace spindrift
