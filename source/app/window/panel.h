#pragma once
// The Dear ImGui side: panel, help, messages.
#include "app/window/ui.h"

#include <imgui.h>

#include <functional>

namespace spindrift {

// Colours and a readable font, both so many times their usual size. Again whenever that changes.
void setUpPanel(float scale, Theme = Theme::Dark);
bool isLight();
// Of what differs or wants a look.
ImVec4 amber();
// The panel's width in the window's pixels, 0 when it's hidden.
int panelWidth(const Ui&);
// How far a run is being made ready, around this place of the window.
void showLoading(const Task&, float x, float y);
// Everything that ImGui shows this frame.
void showPanel(Ui&, int windowHeight);

// What the run says at the picture's upper left; "" when nothing.
std::string notesOf(const Ui&);

// Curves over `x`, with axes that name round numbers.
struct Curve {
    const char* name;
    const std::vector<float>& y;
    unsigned color;
};
void plot(const char* title, const char* unit, const std::vector<float>& x, std::vector<Curve>);

// What a knob that is 0 stands for, by its path: "31.3 m/s"; "" when just 0.
using InForce = std::function<std::string(const std::string& path)>;
// A widget for each live knob of a group ("view.camera", "fluid"), marked where it differs from
// what was loaded, and greyed where it has no effect; true when one was changed.
bool editKnobs(Scene&, const Scene& loaded, const std::string& group, const InForce&);

}  // namespace spindrift
