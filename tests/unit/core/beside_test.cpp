// Work on a thread of its own: in order, all of it, and nothing that fails goes unnoticed.
#include "core/beside.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace spindrift {
namespace {

using namespace std::chrono_literals;

TEST(Beside, DoesAllInOrder) {
    std::vector<int> done;  // by one thread
    {
        Beside beside;
        for (int k = 0; k < 100; ++k) beside.add([&done, k] { done.push_back(k); });
        beside.wait();
        EXPECT_EQ(done.size(), 100u);
        for (int k = 100; k < 120; ++k) beside.add([&done, k] { done.push_back(k); });
    }  // what is undone is done before it ends
    ASSERT_EQ(done.size(), 120u);
    for (int k = 0; k < 120; ++k) EXPECT_EQ(done[size_t(k)], k);
}

TEST(Beside, LetsTheCallerGoOnUntilTooMuchIsUndone) {
    std::atomic<bool> go = false;
    std::atomic<int> added = 0;
    Beside beside;
    std::thread caller([&] {
        for (int k = 0; k < 20; ++k)
            beside.add([&] {
                while (!go) std::this_thread::sleep_for(1ms);
            }),
                ++added;
    });
    std::this_thread::sleep_for(100ms);
    EXPECT_GE(added, 2) << "nothing was done, and the caller goes on";
    EXPECT_LT(added, 20) << "it waits before memory runs out";
    go = true;
    caller.join();
    beside.wait();
    EXPECT_EQ(added, 20);
}

// An index must not name a file that could not be written.
TEST(Beside, DoesNothingAfterTrouble) {
    std::atomic<bool> go = false, done = false;
    Beside beside;
    beside.add([&] {
        while (!go) std::this_thread::sleep_for(1ms);
        throw std::runtime_error("the disk is full");
    });
    beside.add([&] { done = true; });
    go = true;
    EXPECT_THROW(beside.wait(), std::runtime_error);
    EXPECT_THROW(beside.add([&] { done = true; }), std::runtime_error);
    EXPECT_FALSE(done);
}

}  // namespace
}  // namespace spindrift
