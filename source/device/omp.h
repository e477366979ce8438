#pragma once
// The host: its memory, its cores. Results never depend on the number of threads: loops write their
// own elements only, the sort is stable, reductions run over fixed blocks in a fixed order.
#include "core/pass_time.h"
#include "core/system.h"
#include "core/vertex.h"
#include "device/buffer.h"
#include "device/team.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <new>
#include <vector>

namespace spindrift {

class Omp {
public:
    // With `adapts` fewer than these where that is faster: where others use the cores too.
    explicit Omp(int threads, bool adapts = false) : team_(threads, adapts) {}
    int threads() const { return team_.size(); }
    static constexpr int index() { return hostMemory; }
    static constexpr void* stream() { return nullptr; }
    int64_t bytes() const { return bytes_; }  // held by buffers

    // Zeroed memory, aligned for any vector and readable one vector past its end; huge pages when
    // it is large.
    template <class T> T* allocate(size_t n) {
        const size_t page = 2u << 20;
        const size_t wanted = n * sizeof(T) + 64;
        const size_t alignment = wanted >= page ? page : 64;
        const size_t bytes = (wanted + alignment - 1) / alignment * alignment;
        void* p = std::aligned_alloc(alignment, bytes);
        if (!p) throw std::bad_alloc();
        if (alignment == page) os::wishLargePages(p, bytes);
        // Touched first by all threads: on machines with several memories pages are spread.
        const size_t piece = alignment == page ? page : bytes;
        const int64_t pieces = int64_t(bytes / piece);
#pragma omp parallel for schedule(static) num_threads(team_.size()) if (pieces > 1)
        for (int64_t k = 0; k < pieces; ++k)
            std::memset(static_cast<char*>(p) + size_t(k) * piece, 0, piece);
        bytes_ += int64_t(n * sizeof(T));
        return static_cast<T*>(p);
    }
    void release(void* p, size_t bytes) {
        std::free(p);
        bytes_ -= int64_t(bytes);
    }
    template <class T> void upload(T* to, const T* from, size_t n) {
        std::copy(from, from + n, to);
    }
    template <class T> void download(T* to, const T* from, size_t n) const {
        std::copy(from, from + n, to);
    }

    template <class T> void fetch(T* to, const T* from, size_t n) const { download(to, from, n); }

    // Calls body(begin, end) for pieces of [0, n); pieces begin at multiples of `piece`.
    template <class Body> void forRanges(int n, int piece, const Body& body) {
        const int pieces = (n + piece - 1) / piece;
        const int threads = std::min(
            team_.size(), (pieces + 3) / 4);  // waking a thread costs more than a few pieces
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
        for (int k = 0; k < pieces; ++k) body(k * piece, std::min(n, (k + 1) * piece));
    }

    // Calls body(k) for k in [0, n), each some hundred microseconds of work.
    template <class Body> void forTasks(int n, const Body& body) {
        const int threads = std::min(team_.size(), n);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads) if (threads > 1)
        for (int k = 0; k < n; ++k) body(k);
    }

    // Runs a pass over [0, n), a multiple of its lanes' cluster size.
    template <class Pass> void forEach(int n, const Pass& pass) {
        forRanges(n, 256, [&](int begin, int end) { runRange(pass, begin, end); });
    }

    // *out = the sum (Value::add) of what reduction.addTo adds for i in [0, n), block by block.
    template <class Value, class Reduction>
    void reduce(int n, const Reduction& reduction, Value* out) {
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
    // The same, for the host to read.
    template <class Value, class Reduction> Value sum(int n, const Reduction& reduction) {
        Value value;
        reduce(n, reduction, &value);
        return value;
    }

    // How many i in [0, n) fall into each bin: pass.bin(i) in [0, Pass::bins), or -1 for none.
    template <class Pass> std::vector<int> histogram(int n, const Pass& pass) {
        const int block = 16384;
        std::vector<std::vector<int>> partial((n + block - 1) / block,
                                              std::vector<int>(Pass::bins));
        forRanges(n, block, [&](int begin, int end) {
            for (int i = begin; i < end; ++i)
                if (const int bin = pass.bin(i); bin >= 0) ++partial[begin / block][bin];
        });
        std::vector<int> counts(Pass::bins);
        for (const std::vector<int>& p : partial)
            for (int b = 0; b < Pass::bins; ++b) counts[b] += p[b];
        return counts;
    }

    // Stable counting sort of n items by key (a cell, or -1 to drop the item). Cells come in rows
    // of `rowLength`; each row starts at a multiple of `pad` and is filled up with -1. Writes
    // cellStart[rows * rowLength + 1] and order (slot -> item or -1); returns the number of slots.
    int sortByCell(int n, const int* key, int rows, int rowLength, int pad, int* cellStart,
                   Buffer<int, Omp>& order);

    static constexpr bool hostReadable = true;  // its memory is the host's
    static constexpr bool dropsItems = true;    // sortByCell does, with key -1
    // Steps are run pass by pass, and each pass is measured.
    static constexpr bool recordsSteps = false;
    struct Recording {
        void outdate() {}
    };
    template <class F> void timed(PassTime* time, const F& f) {
        time->ms += milliseconds(f);
        ++time->runs;
    }
    void collectTimes() {}
    // A whole step.
    template <class F> void step(const F& f) { team_.note(milliseconds(f)); }
    // The ms that each of `count` calls took.
    template <class F> std::vector<double> timeEach(int count, const F& f) {
        std::vector<double> ms(count);
        for (double& m : ms) m = milliseconds(f);
        return ms;
    }
    // Until the work asked for is done: it always is.
    void wait() {}

private:
    template <class F> static double milliseconds(const F& f) {
        const auto start = std::chrono::steady_clock::now();
        f();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
            .count();
    }

    Team team_;
    int64_t bytes_ = 0;
    std::vector<std::vector<int>>
        counts_;                 // per thread and cell: first the count, then the next free slot
    std::vector<int> rowSlots_;  // slots in a row, then their running sum
};

}  // namespace spindrift
