#pragma once
// A long computation on a thread of its own says how far it is, and learns when it is unwanted.
#include <atomic>

namespace spindrift {

struct Task {
    std::atomic<const char*> doing = "";
    std::atomic<double> share = 0;  // done, 0 to 1
    std::atomic<bool> unwanted = false;
};

// What ends a task that is unwanted. That is no mistake.
struct Unwanted {};

// The task of this thread; null: none is watched.
inline thread_local Task* currentTask = nullptr;

// Throws Unwanted.
inline void tell(const char* doing, double share) {
    if (!currentTask) return;
    currentTask->doing = doing, currentTask->share = share;
    if (currentTask->unwanted) throw Unwanted{};
}

}  // namespace spindrift
