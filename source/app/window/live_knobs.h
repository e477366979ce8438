#pragma once
// Knobs that may change while the fluid runs: which were changed, and how that is taken back.
#include "scene/schema.h"

#include <string>
#include <vector>

namespace spindrift {

struct FluidExtent;

// All of them; those that the run follows; those but the camera's and the
// particle whose path is drawn, which the mouse chooses.
enum class KnobKind { All, Physics, ButCamera };
bool isOfKind(const std::string& path, KnobKind);

// Calls act(path, the value in a, the value in b, knob) for each live knob. Members of lists have
// none, so that all scenes have the same.
template <class A, class Act> void visitLiveKnobs(A& a, const Scene& b, Act act) {
    std::vector<const void*> values;
    visitKnobs(b, [&](const std::string&, const auto& value, const Knob& knob) {
        if (knob.live) values.push_back(&value);
    });
    size_t next = 0;
    visitKnobs(a, [&](const std::string& path, auto& value, const Knob& knob) {
        using T = std::remove_cvref_t<decltype(value)>;
        if (knob.live) act(path, value, *static_cast<const T*>(values[next++]), knob);
    });
}

// The paths of those that differ.
std::vector<std::string> changedKnobs(const Scene&, const Scene&, KnobKind);
void copyKnobs(Scene& to, const Scene& from, KnobKind);
// "fluid.viscosity, time.cfl"
std::string joined(const std::vector<std::string>& paths);

// What was changed one after the other, to be taken back in the opposite order.
class KnobHistory {
public:
    explicit KnobHistory(const Scene& scene) : settled_(scene) {}
    // Now that no slider is held: all that has changed since the last call is one change.
    void settle(const Scene&);
    const Scene& settled() const { return settled_; }  // as of the last call
    // Takes the last change back and returns its paths; none when there is nothing left.
    std::vector<std::string> undo(Scene&);

private:
    Scene settled_;
    std::vector<Scene> before_;  // each change
};

// A scene on the way from what is in force to what is wanted, `passed` seconds of the run later:
// all knobs at once, but sound speed (and stiffness), background pressure and the walls' margin in
// so small steps that the fluid follows without a blow. `start` is the fluid's place at the run's
// beginning.
Scene towards(const Scene& wanted, const Scene& inForce, const FluidExtent& start, double passed);

}  // namespace spindrift
