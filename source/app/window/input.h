#pragma once
// What keys, mouse and dropped files do.
#include "app/window/ui.h"

#include <SDL.h>

#include <optional>
#include <set>

namespace spindrift {

// One row of the help: what to press and what it does.
struct Control {
    const char* keys;
    const char* action;
};
extern const std::vector<Control> controls;

// The panel knows a key only while it is down. One that was tapped between two pictures stays down
// until the next one, and what came after it waits until then. Letters come as text.
class Taps {
public:
    // What was kept, to begin with.
    std::optional<SDL_Event> beginPicture();
    // Whether this one, and those after it, are for the next picture.
    bool keeps(const SDL_Event&);

private:
    std::set<SDL_Keycode> pressed_;
    std::optional<SDL_Event> kept_;
};

void handleEvent(Ui&, const SDL_Event&);
void pressKey(Ui&, SDL_Keycode);

}  // namespace spindrift
