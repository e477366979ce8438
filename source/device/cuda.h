#pragma once
// One NVIDIA GPU: its memory, and its kernels on one stream. The host waits only where it wants to
// know something at once. Results don't depend on the order in which threads run: loops write their
// own elements only, the sort is stable, sums go by a fixed tree, and the only atomic operations
// add integers. Compiled by nvcc, and by the host compiler over the emulation of tests/cuda.
#include "core/error.h"
#include "core/pass_time.h"
#include "device/buffer.h"
#include "device/cuda_devices.h"

#include <cuda_runtime.h>

#include <algorithm>
#include <cstdint>
#include <new>
#include <utility>
#include <vector>

namespace spindrift {

// Throws Error (Memory, NoDevice, DeviceLost) unless the call succeeded; `what` says what was being
// done.
void requireCuda(cudaError_t, const char* what);

namespace cudaKernels {

inline constexpr int blockSize = 128;     // threads that run a pass
inline constexpr int sumBlockSize = 128;  // threads that add up
inline constexpr int sumBlocks = 1024;    // at most; their sums are added by one more block

template <class Pass> __global__ void __launch_bounds__(blockSize) runPass(int n, Pass pass) {
    const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
    if (i < n) pass(i);
}

// sums[block] = what reduction.addTo adds for the i of this block.
template <class Value, class Reduction> __global__ void __launch_bounds__(sumBlockSize)
    addUp(int n, Reduction reduction, Value* sums) {
    __shared__ __align__(16) unsigned char memory[sizeof(Value) * sumBlockSize];
    Value* parts = reinterpret_cast<Value*>(memory);
    const int thread = int(threadIdx.x);
    Value sum;
    for (int i = int(blockIdx.x) * sumBlockSize + thread; i < n; i += int(gridDim.x) * sumBlockSize)
        reduction.addTo(sum, i);
    new (parts + thread) Value(sum);
    for (int half = sumBlockSize / 2; half > 0; half /= 2) {
        __syncthreads();
        if (thread < half) parts[thread].add(parts[thread + half]);
    }
    if (thread == 0) sums[blockIdx.x] = parts[0];
}
template <class Value> struct AddParts {
    const Value* parts;
    __device__ void addTo(Value& sum, int i) const { sum.add(parts[i]); }
};

template <class Pass> __global__ void __launch_bounds__(blockSize)
    countBins(int n, Pass pass, int* counts) {
    __shared__ int own[Pass::bins];
    for (int b = int(threadIdx.x); b < Pass::bins; b += blockSize) own[b] = 0;
    __syncthreads();
    for (int i = int(blockIdx.x) * blockSize + int(threadIdx.x); i < n;
         i += int(gridDim.x) * blockSize)
        if (const int bin = pass.bin(i); bin >= 0) atomicAdd(&own[bin], 1);
    __syncthreads();
    for (int b = int(threadIdx.x); b < Pass::bins; b += blockSize)
        if (own[b] > 0) atomicAdd(&counts[b], own[b]);
}

}  // namespace cudaKernels

// A stretch of work on the GPU, recorded once and run again as a whole.
class CudaRecording {
public:
    CudaRecording() = default;
    ~CudaRecording();
    CudaRecording(const CudaRecording&) = delete;
    CudaRecording& operator=(const CudaRecording&) = delete;
    // What was recorded no longer holds: constants or the plan have changed. (When memory is given
    // back that it may use, the device knows.)
    void outdate() { current_ = false; }

private:
    friend class Cuda;
    cudaGraphExec_t graph_ = nullptr;
    bool current_ = false;
    int64_t layout_ = 0;
};

// Memory of the host that a GPU reads and writes by itself, for copies under way.
class PinnedMemory {
public:
    PinnedMemory() = default;
    ~PinnedMemory();
    PinnedMemory(const PinnedMemory&) = delete;
    PinnedMemory& operator=(const PinnedMemory&) = delete;
    void* take(size_t bytes);
    // All of it: no copy is under way.
    void giveBack();
    size_t taken() const { return taken_; }

private:
    struct Block {
        char* memory;
        size_t bytes;
    };
    std::vector<Block> blocks_;    // each twice as large as the one before
    size_t used_ = 0, taken_ = 0;  // bytes of the last one; of all
};

class Cuda {
public:
    // Throws Error (NoDevice) with what cudaProblem(index) says.
    explicit Cuda(int index);
    ~Cuda();
    Cuda(Cuda&& other) noexcept;
    Cuda& operator=(Cuda&&) = delete;

    int index() const { return index_; }
    cudaStream_t stream() const { return stream_; }
    int64_t bytes() const { return bytes_; }  // held by buffers

    // Memory full of anything. Throws Error (Memory).
    template <class T> T* allocate(size_t n) {
        return static_cast<T*>(allocateBytes(n * sizeof(T)));
    }
    void release(void* p, size_t bytes);
    // In the order of the work that is asked for; `from` may change at once.
    template <class T> void upload(T* to, const T* from, size_t n) {
        send(to, from, n * sizeof(T));
    }
    // The next wait() fills `to`: so what is wanted together is waited for once.
    template <class T> void fetch(T* to, const T* from, size_t n) const {
        bring(to, from, n * sizeof(T));
    }
    template <class T> void download(T* to, const T* from, size_t n) const {
        fetch(to, from, n);
        wait();
    }
    // True: `to` is what *from was some work ago. Nobody waits for it; one value can be looked at
    // so.
    template <class T> bool glance(T* to, const T* from) {
        static_assert(sizeof(T) <= glanceBytes);
        return glance(to, from, sizeof(T));
    }
    void dropGlance() { glanceAsked_ = false; }  // what is on its way is out of date

    // Runs a pass over [0, n), one particle a thread.
    template <class Pass> void forEach(int n, const Pass& pass) {
        if (n > 0)
            launch(cudaKernels::runPass<Pass>, blocksFor(n), cudaKernels::blockSize, n, pass);
    }

    // *out = the sum (Value::add) of what reduction.addTo adds for i in [0, n); `out` is memory of
    // the device.
    template <class Value, class Reduction>
    void reduce(int n, const Reduction& reduction, Value* out) {
        using namespace cudaKernels;
        static_assert(sizeof(Value) * (sumBlocks + 1) <= scratchBytes);
        Value* parts = static_cast<Value*>(scratch_);
        const int blocks = std::max(1, std::min(sumBlocks, (n + sumBlockSize - 1) / sumBlockSize));
        launch(addUp<Value, Reduction>, blocks, sumBlockSize, n, reduction, parts);
        launch(addUp<Value, AddParts<Value>>, 1, sumBlockSize, blocks, AddParts<Value>{parts}, out);
    }
    // The same, for the host to read.
    template <class Value, class Reduction> Value sum(int n, const Reduction& reduction) {
        Value* out = static_cast<Value*>(scratch_) + cudaKernels::sumBlocks;
        reduce(n, reduction, out);
        Value value;
        download(&value, out, 1);
        return value;
    }

    // How many i in [0, n) fall into each bin: pass.bin(i) in [0, Pass::bins), or -1 for none.
    template <class Pass> std::vector<int> histogram(int n, const Pass& pass) {
        static_assert(Pass::bins * sizeof(int) <= scratchBytes);
        int* counts = static_cast<int*>(scratch_);
        clear(counts, Pass::bins * sizeof(int));
        if (n > 0)
            launch(cudaKernels::countBins<Pass>, std::min(blocksFor(n), 256),
                   cudaKernels::blockSize, n, pass, counts);
        std::vector<int> host(Pass::bins);
        download(host.data(), counts, host.size());
        return host;
    }

    // As Omp::sortByCell, without padding (pad 1). No item is dropped: those with a key of `cells`,
    // the number of cells, come behind all others, in any order. Writes cellStart[cells + 2], the
    // last but one of them where those begin; returns n.
    int sortByCell(int n, const int* key, int rows, int rowLength, int pad, int* cellStart,
                   Buffer<int, Cuda>& order);

    static constexpr bool hostReadable = false;
    static constexpr bool dropsItems = false;
    // Steps are recorded as CUDA graphs. `f` launches work and reads nothing; it is not run, it is
    // noted and then run.
    static constexpr bool recordsSteps = true;
    using Recording = CudaRecording;
    bool replay(Recording&);  // false: nothing was done, the recording doesn't hold
    template <class F> void record(Recording& recording, const F& f) {
        beginRecording();
        try {
            f();
        } catch (...) {
            abandonRecording();
            throw;
        }
        endRecording(recording);
    }
    // While recording: `f`, and again as long as *again, memory of the device that `f` writes, is
    // not zero. The host does not read it.
    template <class F> void repeat(const int* again, const F& f) {
        const Loop loop = beginLoop();
        try {
            f();
            noteCondition(loop, again);
        } catch (...) {
            leaveLoop(loop);
            throw;
        }
        requireCuda(leaveLoop(loop), "recording a loop");
    }

    template <class F> void step(const F& f) { f(); }

    // Measures f() by events; what they say is added to `time` by collectTimes(), which waits.
    template <class F> void timed(PassTime* time, const F& f) {
        const cudaEvent_t begin = mark();
        f();
        spans_.push_back({begin, mark(), time});
    }
    void collectTimes();
    // The ms that each of `count` calls took.
    template <class F> std::vector<double> timeEach(int count, const F& f) {
        std::vector<cudaEvent_t> events = {mark()};
        for (int k = 0; k < count; ++k) {
            f();
            events.push_back(mark());
        }
        return intervals(events);
    }
    void wait() const;

private:
    struct Nothing {};
    Cuda(int index, Nothing)
        : index_(index) {}  // once this is done the destructor cleans up, whatever fails next

    static constexpr size_t scratchBytes = 256 << 10, glanceBytes = 256;
    // What was copied for the host and where it wants it.
    struct Landing {
        void* to;
        const void* from;
        size_t bytes;
    };
    struct Span {
        cudaEvent_t begin, end;
        PassTime* time;
    };

    static int blocksFor(int n) {
        return (n + cudaKernels::blockSize - 1) / cudaKernels::blockSize;
    }
    template <class... Parameters, class... Arguments>
    void launch(void (*kernel)(Parameters...), int blocks, int threads, Arguments&&... arguments) {
        activate();
        busy_ = true;
        cudaLaunchConfig_t config{};
        config.gridDim = dim3(unsigned(blocks));
        config.blockDim = dim3(unsigned(threads));
        config.stream = stream_;
        requireCuda(cudaLaunchKernelEx(&config, kernel, std::forward<Arguments>(arguments)...),
                    "starting a kernel");
    }
    void activate() const;  // CUDA calls go to the device that the calling thread chose last
    void* allocateBytes(size_t bytes);
    void send(void* to, const void* from, size_t bytes);
    void bring(void* to, const void* from, size_t bytes) const;
    bool glance(void* to, const void* from, size_t bytes);
    void clear(void* memory, size_t bytes);

    void beginRecording();
    void abandonRecording();
    void endRecording(Recording&);
    // A loop's body is recorded on a stream of its own into a graph of its own.
    struct Loop {
        cudaStream_t around;
        cudaGraphConditionalHandle condition;
    };
    Loop beginLoop();
    void noteCondition(const Loop&, const int* again);
    cudaError_t leaveLoop(const Loop&);
    cudaEvent_t mark();
    std::vector<double> intervals(const std::vector<cudaEvent_t>&);

    int index_;
    cudaStream_t stream_ = nullptr;
    void* scratch_ = nullptr;  // for partial sums
    void* sortSpace_ = nullptr;
    size_t sortSpaceBytes_ = 0;
    int64_t bytes_ = 0;
    int64_t layout_ = 0;  // grows when memory is given back: what was recorded may use it
    bool recording_ = false;
    mutable bool busy_ = true;  // work was asked for since the last wait
    mutable PinnedMemory pinned_;
    mutable std::vector<Landing> landings_;
    void* glanced_ = nullptr;  // pinned
    cudaEvent_t glanceMade_ = nullptr;
    bool glanceAsked_ = false;
    std::vector<Span> spans_;
    std::vector<cudaEvent_t> idle_;  // events to be used again
};

}  // namespace spindrift
