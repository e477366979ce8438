#pragma once
// Makes a run ready on a thread of its own, so that the window lives meanwhile.
#include "app/scene_choice.h"
#include "core/task.h"

#include <exception>
#include <functional>
#include <memory>
#include <thread>

namespace spindrift {

struct Loaded {
    Start start;
    std::unique_ptr<Simulation> simulation;
};

class Loader {
public:
    explicit Loader(std::function<Start()> choose);
    ~Loader();  // cancels

    bool done() const { return done_; }
    const Task& progress() const { return task_; }
    // When it is done. Throws what went wrong.
    Loaded take();

private:
    void work(const std::function<Start()>& choose);

    Task task_;
    Loaded loaded_;
    std::exception_ptr failure_;
    std::atomic<bool> done_ = false;
    std::thread thread_;  // last: it uses the others
};

}  // namespace spindrift
