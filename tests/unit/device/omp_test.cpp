#include "device/omp.h"

#include <gtest/gtest.h>

#include <random>

namespace spindrift {
namespace {

struct Sorted {
    int slots;
    std::vector<int> cellStart, order;
};

Sorted sortWith(int threads, const std::vector<int>& keys, int rows, int rowLength, int pad) {
    Omp device(threads);
    Buffer<int, Omp> order(device);
    std::vector<int> cellStart(size_t(rows) * rowLength + 1);
    const int slots = device.sortByCell(int(keys.size()), keys.data(), rows, rowLength, pad,
                                        cellStart.data(), order);
    return {slots, cellStart, std::vector<int>(order.data(), order.data() + slots)};
}

std::vector<int> randomKeys(int n, int cells) {
    std::mt19937 random(3);
    std::uniform_int_distribution<int> cell(-1, cells - 1);  // -1: to be dropped
    std::vector<int> keys(n);
    for (int& key : keys) key = cell(random);
    return keys;
}

TEST(SortByCell, IsStableCompleteAndPadsRows) {
    const int rows = 30, rowLength = 17, pad = 4;
    const std::vector<int> keys = randomKeys(10000, rows * rowLength);
    const Sorted s = sortWith(2, keys, rows, rowLength, pad);
    std::vector<int> seen(keys.size(), 0);
    int previousKey = -1, previousItem = -1;
    for (int slot = 0; slot < s.slots; ++slot) {
        const int item = s.order[slot];
        if (item < 0) continue;
        ++seen[item];
        const int key = keys[item];
        EXPECT_GE(slot, s.cellStart[key]);
        EXPECT_LT(slot, s.cellStart[key + 1]);
        if (key == previousKey) {
            EXPECT_GT(item, previousItem) << "not stable";
        } else {
            EXPECT_GT(key, previousKey);
        }
        previousKey = key, previousItem = item;
    }
    for (size_t i = 0; i < keys.size(); ++i) EXPECT_EQ(seen[i], keys[i] >= 0 ? 1 : 0);
    for (int row = 0; row <= rows; ++row) EXPECT_EQ(s.cellStart[size_t(row) * rowLength] % pad, 0);
}

TEST(SortByCell, SameForAnyNumberOfThreads) {
    const std::vector<int> keys = randomKeys(20000, 200);
    const Sorted one = sortWith(1, keys, 20, 10, 4);
    for (int threads : {2, 3, 7}) {
        const Sorted more = sortWith(threads, keys, 20, 10, 4);
        EXPECT_EQ(one.order, more.order) << threads;
        EXPECT_EQ(one.cellStart, more.cellStart) << threads;
    }
}

TEST(SortByCell, NothingToSort) {
    const Sorted s = sortWith(2, {}, 3, 5, 4);
    EXPECT_EQ(s.slots, 0);
    EXPECT_EQ(s.cellStart, std::vector<int>(16, 0));
}

}  // namespace
}  // namespace spindrift
