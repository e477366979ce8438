#include "core/beside.h"

#include <utility>

namespace spindrift {

Beside::~Beside() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Beside::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ends_ || !undone_.empty(); });
        if (undone_.empty()) return;
        const std::function<void()> thing = std::move(undone_.front());
        undone_.pop_front();
        busy_ = true;
        lock.unlock();
        std::exception_ptr trouble;
        try {
            thing();
        } catch (...) { trouble = std::current_exception(); }
        lock.lock();
        busy_ = false;
        if (trouble) trouble_ = trouble, undone_.clear();
        changed_.notify_all();
    }
}

void Beside::tellTrouble() {
    if (trouble_) std::rethrow_exception(trouble_);
}

void Beside::add(std::function<void()> thing) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return trouble_ || undone_.size() < Most; });
    tellTrouble();
    undone_.push_back(std::move(thing));
    changed_.notify_all();
}

void Beside::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return undone_.empty() && !busy_; });
    tellTrouble();
}

}  // namespace spindrift
