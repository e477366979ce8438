#include "device/omp.h"

namespace spindrift {

int Omp::sortByCell(int n, const int* key, int rows, int rowLength, int pad, int* cellStart,
                    Buffer<int, Omp>& order) {
    const int threads = std::max(1, std::min(team_.size(), n / 1024));
    const size_t cells = size_t(rows) * rowLength;
    counts_.resize(threads);
    rowSlots_.resize(rows + 1);
    auto firstItem = [&](int t) { return int(int64_t(n) * t / threads); };
    auto firstRow = [&](int t) { return int(int64_t(rows) * t / threads); };

#pragma omp parallel for schedule(static) num_threads(threads)
    for (int t = 0; t < threads; ++t) {
        counts_[t].assign(cells, 0);
        for (int i = firstItem(t); i < firstItem(t + 1); ++i)
            if (key[i] >= 0) ++counts_[t][key[i]];
    }
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int r = 0; r < rows; ++r) {
        int items = 0;
        for (const std::vector<int>& count : counts_)
            for (int c = 0; c < rowLength; ++c) items += count[size_t(r) * rowLength + c];
        rowSlots_[r + 1] = (items + pad - 1) / pad * pad;
    }
    rowSlots_[0] = 0;
    for (int r = 0; r < rows; ++r) rowSlots_[r + 1] += rowSlots_[r];
    const int slots = rowSlots_[rows];
    order.resize(slots);
    int* slotItem = order.data();

    // Counts become first slots: row by row, cell by cell, thread by thread, which keeps the sort
    // stable.
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int t = 0; t < threads; ++t)
        for (int r = firstRow(t); r < firstRow(t + 1); ++r) {
            int next = rowSlots_[r];
            for (size_t c = size_t(r) * rowLength; c < size_t(r + 1) * rowLength; ++c) {
                cellStart[c] = next;
                for (std::vector<int>& count : counts_) {
                    const int items = count[c];
                    count[c] = next;
                    next += items;
                }
            }
            std::fill(slotItem + next, slotItem + rowSlots_[r + 1], -1);
        }
    cellStart[cells] = slots;
#pragma omp parallel for schedule(static) num_threads(threads)
    for (int t = 0; t < threads; ++t)
        for (int i = firstItem(t); i < firstItem(t + 1); ++i)
            if (key[i] >= 0) slotItem[counts_[t][key[i]]++] = i;
    return slots;
}

}  // namespace spindrift
