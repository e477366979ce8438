#include "device/cuda.h"

#include <cub/device/device_scan.cuh>

#include <algorithm>
#include <cstring>

namespace spindrift {

using namespace cudaKernels;

// --- the passes of the sort ---
// A counting sort: particles per cell, running sum, a place in its cell for each. Atomic operations
// hand the places out in any order; each particle then counts those of its cell that come before
// it, which makes the sort stable.

namespace {

struct CountCells {
    const int* key;
    int* counts;
    __device__ void operator()(int i) const { atomicAdd(&counts[key[i]], 1); }
};
struct PlaceInCell {
    const int* key;
    const int* cellStart;
    int* counts;
    int* unordered;
    __device__ void operator()(int i) const {
        unordered[cellStart[key[i]] + atomicSub(&counts[key[i]], 1) - 1] = i;
    }
};
struct OrderInCell {
    const int* key;
    const int* cellStart;
    const int* unordered;
    int* order;
    int cells;
    __device__ void operator()(int slot) const {
        const int item = unordered[slot];
        if (key[item] == cells) {  // in no cell
            order[slot] = item;
            return;
        }
        const int begin = cellStart[key[item]], end = cellStart[key[item] + 1];
        int before = 0;
        for (int s = begin; s < end; ++s) before += unordered[s] < item;
        order[begin + before] = item;
    }
};

}  // namespace

// --- which devices ---

static std::string version(int number) {
    return std::to_string(number / 1000) + "." + std::to_string(number % 1000 / 10);
}

static std::string noDriverOrTooOld() {
    int driver = 0, runtime = 0;
    cudaDriverGetVersion(&driver);
    cudaRuntimeGetVersion(&runtime);
    if (driver == 0) return "there is no NVIDIA driver on this machine";
    return "the NVIDIA driver knows CUDA " + version(driver) + ", this program needs " +
           version(runtime) + "; update the driver";
}

std::string cudaProblem(int index) {
    int count = 0;
    const cudaError_t code = cudaGetDeviceCount(&count);
    if (code != cudaSuccess) cudaGetLastError();
    if (code == cudaErrorInsufficientDriver) return noDriverOrTooOld();
    if (code == cudaErrorNoDevice || (code == cudaSuccess && count == 0)) return "no CUDA device";
    if (code != cudaSuccess) return std::string("CUDA does not start: ") + cudaGetErrorString(code);
    if (index < 0 || index >= count)
        return "no CUDA device " + std::to_string(index) + "; there are " + std::to_string(count) +
               ", counted from 0";
    // A kernel that the build has for no architecture of this device can't be loaded.
    cudaFuncAttributes attributes{};
    cudaDeviceProp device{};
    if (cudaGetDeviceProperties(&device, index) != cudaSuccess ||
        cudaSetDevice(index) != cudaSuccess)
        return "CUDA device " + std::to_string(index) +
               " does not answer: " + cudaGetErrorString(cudaGetLastError());
    if (const cudaError_t load = cudaFuncGetAttributes(&attributes, runPass<CountCells>);
        load != cudaSuccess) {
        cudaGetLastError();
        const std::string architecture =
            std::to_string(device.major) + std::to_string(device.minor);
        return "this build has no code for " + std::string(device.name) + " (" +
               cudaGetErrorString(load) +
               "); build with -DSPINDRIFT_CUDA_ARCHITECTURES=" + architecture;
    }
    return "";
}

std::string cudaDeviceName(int index) {
    cudaDeviceProp device{};
    requireCuda(cudaGetDeviceProperties(&device, index), "asking for a device's name");
    return device.name;
}

int64_t cudaFreeMemory(int index) {
    size_t free = 0, all = 0;
    requireCuda(cudaSetDevice(index), "choosing a device");
    requireCuda(cudaMemGetInfo(&free, &all), "asking for free memory");
    return int64_t(free);
}

void requireCuda(cudaError_t code, const char* what) {
    if (code == cudaSuccess) return;
    cudaGetLastError();  // the next call must not find it again
    const std::string message = std::string(what) + ": " + cudaGetErrorString(code);
    if (code == cudaErrorMemoryAllocation)
        throw Error(Failure::Memory, "out of GPU memory while " + message +
                                         "; raise simulation.spacing or use --backend cpu");
    if (code == cudaErrorNoDevice || code == cudaErrorInsufficientDriver ||
        code == cudaErrorNoKernelImageForDevice)
        throw Error(Failure::NoDevice,
                    "the GPU can't be used while " + message + "; use --backend cpu");
    throw Error(Failure::DeviceLost,
                "the GPU was lost while " + message + "; start again, or use --backend cpu");
}

// --- the device ---

Cuda::Cuda(int index) : Cuda(index, Nothing{}) {
    if (const std::string problem = cudaProblem(index); !problem.empty())
        throw Error(Failure::NoDevice, "--backend cuda: " + problem + "; or use --backend cpu");
    activate();
    requireCuda(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "making a stream");
    scratch_ = allocateBytes(scratchBytes);
    requireCuda(cudaMallocHost(&glanced_, glanceBytes), "making room for copies");
    requireCuda(cudaEventCreate(&glanceMade_), "measuring time");
}

Cuda::Cuda(Cuda&& other) noexcept
    : index_(other.index_),
      stream_(std::exchange(other.stream_, nullptr)),
      scratch_(std::exchange(other.scratch_, nullptr)),
      bytes_(other.bytes_),
      glanced_(std::exchange(other.glanced_, nullptr)),
      glanceMade_(std::exchange(other.glanceMade_, nullptr)) {}

// Errors are of no use here: a device that was lost has lost its memory too.
Cuda::~Cuda() {
    if (!stream_) return;
    cudaSetDevice(index_);
    cudaStreamSynchronize(stream_);
    cudaFree(scratch_), cudaFree(sortSpace_), cudaFreeHost(glanced_);
    if (glanceMade_) cudaEventDestroy(glanceMade_);
    for (const Span& s : spans_) cudaEventDestroy(s.begin), cudaEventDestroy(s.end);
    for (cudaEvent_t event : idle_) cudaEventDestroy(event);
    cudaStreamDestroy(stream_);
}

void Cuda::activate() const { requireCuda(cudaSetDevice(index_), "choosing a device"); }

void* Cuda::allocateBytes(size_t bytes) {
    CHECK(!recording_);
    activate();
    void* memory = nullptr;
    requireCuda(cudaMalloc(&memory, std::max<size_t>(bytes, 1)), "making room for particles");
    bytes_ += int64_t(bytes);
    return memory;
}

void Cuda::release(void* p, size_t bytes) {
    if (!p) return;
    CHECK(!recording_);
    cudaSetDevice(index_);
    cudaFree(p);  // waits for the work that may still use it
    ++layout_;
    bytes_ -= int64_t(bytes);
}

// --- copies ---

PinnedMemory::~PinnedMemory() {
    for (const Block& block : blocks_) cudaFreeHost(block.memory);
}

void* PinnedMemory::take(size_t bytes) {
    constexpr size_t first = 64 << 10, aligned = 16;
    bytes = (bytes + aligned - 1) / aligned * aligned;
    if (blocks_.empty() || used_ + bytes > blocks_.back().bytes) {
        const size_t size = std::max(blocks_.empty() ? first : 2 * blocks_.back().bytes, bytes);
        void* memory = nullptr;
        requireCuda(cudaMallocHost(&memory, size), "making room for copies");
        blocks_.push_back({static_cast<char*>(memory), size});
        used_ = 0;
    }
    taken_ += bytes;
    return blocks_.back().memory + std::exchange(used_, used_ + bytes);
}

void PinnedMemory::giveBack() {
    used_ = taken_ = 0;
    if (blocks_.size() < 2) return;
    for (size_t k = 0; k + 1 < blocks_.size(); ++k) cudaFreeHost(blocks_[k].memory);
    blocks_ = {blocks_.back()};
}

// What is larger takes longer to be copied than the host loses by waiting for it, and is not to be
// held twice.
static constexpr size_t mostPinned = 4 << 20, mostUnderWay = 64 << 20;

void Cuda::send(void* to, const void* from, size_t bytes) {
    if (bytes == 0) return;
    CHECK(!recording_);
    if (pinned_.taken() > mostUnderWay) wait();
    activate();
    busy_ = true;
    const bool goesBy = bytes <= mostPinned;
    if (goesBy) from = std::memcpy(pinned_.take(bytes), from, bytes);
    requireCuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyHostToDevice, stream_), "copying");
    if (!goesBy) wait();
}

void Cuda::bring(void* to, const void* from, size_t bytes) const {
    if (bytes == 0) return;
    CHECK(!recording_);
    if (pinned_.taken() > mostUnderWay) wait();
    activate();
    busy_ = true;
    try {
        void* by = bytes <= mostPinned ? pinned_.take(bytes) : to;
        requireCuda(cudaMemcpyAsync(by, from, bytes, cudaMemcpyDeviceToHost, stream_), "copying");
        if (by != to) landings_.push_back({to, by, bytes});
    } catch (...) {  // whoever asked for the others may no longer be there
        landings_.clear();
        throw;
    }
}

void Cuda::wait() const {
    if (!busy_) return;
    activate();
    const cudaError_t done = cudaStreamSynchronize(stream_);
    const std::vector<Landing> landings = std::exchange(landings_, {});
    requireCuda(done, "stepping");
    for (const Landing& l : landings) std::memcpy(l.to, l.from, l.bytes);
    pinned_.giveBack();
    busy_ = false;
}

bool Cuda::glance(void* to, const void* from, size_t bytes) {
    activate();
    if (glanceAsked_) {
        const cudaError_t made = cudaEventQuery(glanceMade_);
        if (made == cudaErrorNotReady) return false;
        requireCuda(made, "stepping");
        std::memcpy(to, glanced_, bytes);
    }
    const bool came = std::exchange(glanceAsked_, true);
    requireCuda(cudaMemcpyAsync(glanced_, from, bytes, cudaMemcpyDeviceToHost, stream_), "copying");
    requireCuda(cudaEventRecord(glanceMade_, stream_), "copying");
    return came;
}

void Cuda::clear(void* memory, size_t bytes) {
    activate();
    busy_ = true;
    requireCuda(cudaMemsetAsync(memory, 0, bytes, stream_), "clearing memory");
}

int Cuda::sortByCell(int n, const int* key, int rows, int rowLength, int pad, int* cellStart,
                     Buffer<int, Cuda>& order) {
    CHECK(pad == 1);
    const size_t cells = size_t(rows) * size_t(rowLength), starts = cells + 2, aligned = 256;
    auto padded = [&](size_t numbers) {
        return (numbers * sizeof(int) + aligned - 1) / aligned * aligned;
    };
    size_t scanBytes = 0;
    requireCuda(
        cub::DeviceScan::ExclusiveSum(nullptr, scanBytes, key, cellStart, int(starts), stream_),
        "sorting");
    const size_t bytes = padded(starts) + padded(size_t(n)) + scanBytes;
    if (bytes > sortSpaceBytes_) {
        release(std::exchange(sortSpace_, nullptr), std::exchange(sortSpaceBytes_, 0));
        sortSpace_ = allocateBytes(bytes);
        sortSpaceBytes_ = bytes;
    }
    char* space = static_cast<char*>(sortSpace_);
    int* counts = reinterpret_cast<int*>(space);
    int* unordered = reinterpret_cast<int*>(space + padded(starts));
    void* scan = space + padded(starts) + padded(size_t(n));

    order.resize(n);
    clear(counts, starts * sizeof(int));
    forEach(n, CountCells{key, counts});
    requireCuda(
        cub::DeviceScan::ExclusiveSum(scan, scanBytes, counts, cellStart, int(starts), stream_),
        "sorting");
    forEach(n, PlaceInCell{key, cellStart, counts, unordered});
    forEach(n, OrderInCell{key, cellStart, unordered, order.data(), int(cells)});
    return n;
}

// --- recordings ---

CudaRecording::~CudaRecording() {
    if (graph_) cudaGraphExecDestroy(graph_);
}

bool Cuda::replay(Recording& recording) {
    if (!recording.current_ || recording.layout_ != layout_) return false;
    activate();
    busy_ = true;
    requireCuda(cudaGraphLaunch(recording.graph_, stream_), "starting a step");
    return true;
}

void Cuda::beginRecording() {
    activate();
    requireCuda(cudaStreamBeginCapture(stream_, cudaStreamCaptureModeThreadLocal),
                "recording a step");
    recording_ = true;
}

void Cuda::abandonRecording() {
    recording_ = false;
    cudaGraph_t graph = nullptr;
    if (cudaStreamEndCapture(stream_, &graph) == cudaSuccess && graph) cudaGraphDestroy(graph);
    cudaGetLastError();
}

void Cuda::endRecording(Recording& recording) {
    recording_ = false;
    cudaGraph_t graph = nullptr;
    requireCuda(cudaStreamEndCapture(stream_, &graph), "recording a step");
    // The same passes with other constants fit into what is there, which is quicker than making it
    // anew.
    cudaGraphExecUpdateResultInfo info{};
    if (recording.graph_ && cudaGraphExecUpdate(recording.graph_, graph, &info) != cudaSuccess) {
        cudaGetLastError();
        cudaGraphExecDestroy(recording.graph_);
        recording.graph_ = nullptr;
    }
    const cudaError_t made =
        recording.graph_ ? cudaSuccess : cudaGraphInstantiate(&recording.graph_, graph, 0);
    cudaGraphDestroy(graph);
    requireCuda(made, "recording a step");
    recording.current_ = true, recording.layout_ = layout_;
    replay(recording);
}

static __global__ void decideLoop(cudaGraphConditionalHandle condition, const int* again) {
    cudaGraphSetConditional(condition, *again != 0);
}

Cuda::Loop Cuda::beginLoop() {
    CHECK(recording_);
    Loop loop{stream_, 0};
    cudaStreamCaptureStatus status{};
    cudaGraph_t graph = nullptr;
    const cudaGraphNode_t* before = nullptr;
    size_t count = 0;
    requireCuda(
        cudaStreamGetCaptureInfo(stream_, &status, nullptr, &graph, &before, nullptr, &count),
        "recording a loop");
    requireCuda(
        cudaGraphConditionalHandleCreate(&loop.condition, graph, 1, cudaGraphCondAssignDefault),
        "recording a loop");
    cudaGraphNodeParams parameters{};
    parameters.type = cudaGraphNodeTypeConditional;
    parameters.conditional.handle = loop.condition;
    parameters.conditional.type = cudaGraphCondTypeWhile;
    parameters.conditional.size = 1;
    cudaGraphNode_t node = nullptr;
    requireCuda(cudaGraphAddNode(&node, graph, before, nullptr, count, &parameters),
                "recording a loop");
    requireCuda(cudaStreamUpdateCaptureDependencies(stream_, &node, nullptr, 1,
                                                    cudaStreamSetCaptureDependencies),
                "recording a loop");
    cudaStream_t body = nullptr;
    requireCuda(cudaStreamCreateWithFlags(&body, cudaStreamNonBlocking), "making a stream");
    stream_ = body;
    const cudaError_t begun =
        cudaStreamBeginCaptureToGraph(body, parameters.conditional.phGraph_out[0], nullptr, nullptr,
                                      0, cudaStreamCaptureModeThreadLocal);
    if (begun != cudaSuccess) leaveLoop(loop);
    requireCuda(begun, "recording a loop");
    return loop;
}

void Cuda::noteCondition(const Loop& loop, const int* again) {
    launch(decideLoop, 1, 1, loop.condition, again);
}

cudaError_t Cuda::leaveLoop(const Loop& loop) {
    cudaGraph_t body = nullptr;  // belongs to the loop's node
    const cudaError_t ended = cudaStreamEndCapture(stream_, &body);
    cudaStreamDestroy(std::exchange(stream_, loop.around));
    if (ended != cudaSuccess) cudaGetLastError();
    return ended;
}

// --- clocks ---

cudaEvent_t Cuda::mark() {
    activate();
    cudaEvent_t event = nullptr;
    if (idle_.empty()) {
        requireCuda(cudaEventCreate(&event), "measuring time");
    } else {
        event = idle_.back();
        idle_.pop_back();
    }
    requireCuda(cudaEventRecord(event, stream_), "measuring time");
    busy_ = true;
    return event;
}

void Cuda::collectTimes() {
    if (spans_.empty()) return;
    wait();
    for (const Span& s : spans_) {
        float ms = 0;
        requireCuda(cudaEventElapsedTime(&ms, s.begin, s.end), "measuring time");
        s.time->ms += ms;
        ++s.time->runs;
        idle_.push_back(s.begin);
        idle_.push_back(s.end);
    }
    spans_.clear();
}

std::vector<double> Cuda::intervals(const std::vector<cudaEvent_t>& events) {
    wait();
    std::vector<double> all;
    for (size_t k = 1; k < events.size(); ++k) {
        float ms = 0;
        requireCuda(cudaEventElapsedTime(&ms, events[k - 1], events[k]), "measuring time");
        all.push_back(ms);
    }
    idle_.insert(idle_.end(), events.begin(), events.end());
    return all;
}

}  // namespace spindrift
