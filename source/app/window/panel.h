#pragma once
// The Dear ImGui side: panel, help, messages.
#include "app/window/ui.h"

namespace spindrift {

// Dark theme and a readable font; `scale` grows with the screen's density.
void setUpPanel(float scale);
// The panel's width in the window's pixels, 0 when it's hidden.
int panelWidth(const Ui&);
// Everything that ImGui shows this frame.
void showPanel(Ui&, int windowHeight);

// Curves over `x`, drawn from 0 up to their largest value.
struct Curve {
    const char* name;
    const std::vector<float>& y;
    unsigned color;
};
void plot(const char* title, const char* unit, const std::vector<float>& x, std::vector<Curve>);

// A widget for each live knob of a group ("view.camera", "fluid"); true when one was changed.
bool editKnobs(Scene&, const std::string& group);

}  // namespace spindrift
