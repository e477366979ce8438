#pragma once
// What keys, mouse and dropped files do.
#include "app/window/ui.h"

#include <SDL.h>

namespace spindrift {

// One row of the help: what to press and what it does.
struct Control {
    const char* keys;
    const char* action;
};
extern const std::vector<Control> controls;

void handleEvent(Ui&, const SDL_Event&);
void pressKey(Ui&, SDL_Keycode);

}  // namespace spindrift
