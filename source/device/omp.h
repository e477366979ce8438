#pragma once
// The host: its memory, its cores. Results never depend on the number of threads: loops write their own
// elements only, the sort is stable, reductions run over fixed blocks in a fixed order.
#include "device/buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

namespace spindrift {

class Omp {
public:
    explicit Omp(int threads) : threads_(threads) {}
    int threads() const { return threads_; }

    // Zeroed memory, aligned for any vector and readable one vector past its end; huge pages when it is large.
    template <class T> T* allocate(size_t n) {
        const size_t page = 2u << 20;
        const size_t wanted = n * sizeof(T) + 64;
        const size_t alignment = wanted >= page ? page : 64;
        const size_t bytes = (wanted + alignment - 1) / alignment * alignment;
        void* p = std::aligned_alloc(alignment, bytes);
        if (!p) throw std::bad_alloc();
        if (alignment == page) madvise(p, bytes, MADV_HUGEPAGE);
        std::memset(p, 0, bytes);
        return static_cast<T*>(p);
    }
    void release(void* p) { std::free(p); }
    template <class T> void upload(T* to, const T* from, size_t n) { std::copy(from, from + n, to); }
    template <class T> void download(T* to, const T* from, size_t n) { std::copy(from, from + n, to); }

    // Calls body(begin, end) for pieces of [0, n); pieces begin at multiples of `piece`.
    template <class Body> void forRanges(int n, int piece, const Body& body) {
        const int pieces = (n + piece - 1) / piece;
        const int threads = std::min(threads_, (pieces + 3) / 4);   // waking a thread costs more than a few pieces
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
        for (int k = 0; k < pieces; ++k) body(k * piece, std::min(n, (k + 1) * piece));
    }

    // Runs a pass over [0, n), a multiple of its lanes' cluster size.
    template <class Pass> void forEach(int n, const Pass& pass) {
        forRanges(n, 256, [&](int begin, int end) { runRange(pass, begin, end); });
    }

    // *out = the sum (Value::add) of reduction.of(i) for i in [0, n), block by block.
    template <class Value, class Reduction> void reduce(int n, const Reduction& reduction, Value* out) {
        const int block = 1024;
        const int blocks = (n + block - 1) / block;
        std::vector<Value> partial(blocks);
        forRanges(n, block, [&](int begin, int end) {
            Value sum;
            sumRange(reduction, begin, end, sum);
            partial[begin / block] = sum;
        });
        Value sum;
        for (const Value& p : partial) sum.add(p);
        *out = sum;
    }

    // Stable counting sort of n items by key (a cell, or -1 to drop the item). Cells come in rows of
    // `rowLength`; each row starts at a multiple of `pad` and is filled up with -1.
    // Writes cellStart[rows * rowLength + 1] and order (slot -> item or -1); returns the number of slots.
    int sortByCell(int n, const int* key, int rows, int rowLength, int pad, int* cellStart, Buffer<int, Omp>& order);

private:
    int threads_;
    std::vector<std::vector<int>> counts_;  // per thread and cell: first the count, then the next free slot
    std::vector<int> rowSlots_;             // slots in a row, then their running sum
};

}  // namespace spindrift
