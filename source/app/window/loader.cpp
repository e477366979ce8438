#include "app/window/loader.h"

#include <utility>

namespace spindrift {

Loader::Loader(std::function<Start()> choose)
    : thread_([this, choose = std::move(choose)] { work(choose); }) {}

Loader::~Loader() {
    task_.unwanted = true;
    if (thread_.joinable()) thread_.join();
}

void Loader::work(const std::function<Start()>& choose) {
    currentTask = &task_;
    try {
        tell("reading the scene", 0);
        loaded_.start = choose();
        tell("placing particles", 0);
        loaded_.simulation = startSimulation(loaded_.start.scene, loaded_.start.state);
    } catch (...) { failure_ = std::current_exception(); }
    done_ = true;
}

Loaded Loader::take() {
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
    return std::move(loaded_);
}

}  // namespace spindrift
