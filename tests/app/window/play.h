#pragma once
// Players of tests: made ready, played until something is so.
#include "app/window/player.h"
#include "scene/json.h"

#include <chrono>
#include <string>
#include <thread>

namespace spindrift {

inline Loaded ready(Scene scene) {
    return Loader([scene = std::move(scene)] { return Start{scene, {}}; }).take();
}

// Plays until `done` or for some seconds.
template <class Done> bool play(Player& player, Done done, double seconds = 10) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end) {
        bool moved = false;
        if (player.collect(moved)) {
            if (done()) return true;
            player.proceed(0.005);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

}  // namespace spindrift
