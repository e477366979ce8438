#pragma once
// Work that a run does not wait for: files that are written, pictures that are encoded.
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace spindrift {

// Does one thing after the other on a thread of its own. A caller waits when too many are undone.
// After one has thrown no other is done, and each call throws the same.
class Beside {
public:
    Beside() : thread_([this] { work(); }) {}
    ~Beside();
    void add(std::function<void()> thing);
    // Until all is done.
    void wait();

private:
    static constexpr size_t Most = 8;
    void work();
    void tellTrouble();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> undone_;
    std::exception_ptr trouble_;  // the first
    bool busy_ = false, ends_ = false;
    std::thread thread_;  // last: the rest is there when it begins
};

}  // namespace spindrift
