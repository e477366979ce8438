#pragma once
// Scenes as text: files in both layouts, single knobs, and descriptions of the format. Everything
// is made from schema.h.
#include "scene/scene.h"

#include <string>
#include <utility>
#include <vector>

namespace spindrift {

// Reads a scene file: `//` comments allowed; without the key "version" it is in the historical
// layout. Throws Error(Failure::Scene), one line with file, JSON path and remedy.
Scene loadScene(const std::string& file);
// The same from text; `place` names it in messages.
Scene parseScene(const std::string& text, const std::string& place);

// The whole effective scene. parseScene(writeScene(s)) is s.
std::string writeScene(const Scene&);

// "path=value", e.g. "fluid.viscosity=0.1", "fluid.bodies[0].min=[0,0,0]" or
// "fluid.bodies=[{...}]". Names and text need no quotes, vectors no brackets. `origin` names it in
// messages. Throws Error(Failure::Scene); then the scene is unchanged.
void setKnob(Scene&, const std::string& assignment, const std::string& origin = "--set");

// Path and value, as text, of each knob that can't change while a run goes on.
std::vector<std::pair<std::string, std::string>> restartKnobs(const Scene&);

// Any knob's value is out of its range (a NaN, a value that didn't come from a file): throws
// Error(Failure::Scene).
void requireRanges(const Scene&, const std::string& place);

// JSON Schema (draft 2020-12) of a scene file, for editors.
std::string jsonSchema();
// One line a knob: path, default, range and unit, help. Restart knobs are marked.
std::string knobTable();
// The same as Markdown, a table for each part of a scene: what docs/SCENES.md ends with.
std::string knobReference();

}  // namespace spindrift
