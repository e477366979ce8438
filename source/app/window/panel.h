#pragma once
// The Dear ImGui side: panel, help, messages.
#include "app/window/ui.h"

#include <imgui.h>

#include <functional>
#include <optional>

namespace spindrift {

// Windows that stay where they are; those over the picture, which are as large as their text.
constexpr ImGuiWindowFlags fixedWindow = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                         ImGuiWindowFlags_NoMove |
                                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav;
constexpr ImGuiWindowFlags noteWindow =
    fixedWindow | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing;
constexpr float margin = 12;  // px at scale 1, from the picture's edges to them

// Colours and a readable font, both so many times their usual size. Again whenever that changes.
void setUpPanel(float scale, Theme = Theme::Dark);
bool isLight();
// Of what differs or wants a look; of what has gone wrong or is marked in the picture.
ImVec4 amber();
ImVec4 red();
// The panel's width in the window's pixels, 0 when it's hidden.
int panelWidth(const Ui&);
// The time line's height below panel and picture, 0 when it's hidden.
int timeLineHeight(const Ui&);
void showTimeLine(Ui&, int windowHeight);
// How far a run is being made ready, around this place of the window.
void showLoading(const Task&, float x, float y);
// Everything that ImGui shows this frame.
void showPanel(Ui&, int windowHeight);

// What the run says at the picture's upper left; "" when nothing.
std::string notesOf(const Ui&);
void showNotes(const Ui&);

// Curves over `x`, with axes that name round numbers, and a line where `shown` is.
struct Curve {
    const char* name;
    const std::vector<float>& y;
    unsigned color;
};
void plot(const char* title, const char* unit, const std::vector<float>& x,
          std::optional<double> shown, std::vector<Curve>);

// What a knob that is 0 stands for, by its path: "31.3 m/s"; "" when just 0.
using InForce = std::function<std::string(const std::string& path)>;
// A widget for each live knob of a group ("view.camera", "fluid"), marked where it differs from
// what was loaded, and greyed where it has no effect; true when one was changed.
bool editKnobs(Scene&, const Scene& loaded, const std::string& group, const InForce&);

}  // namespace spindrift
