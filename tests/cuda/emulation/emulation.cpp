#include "emulation.h"

#include <boost/context/fiber.hpp>
#include <sys/mman.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <vector>

using Work = std::function<void()>;
struct EmulatedCondition {
    unsigned atLaunch, value;
};
struct EmulatedGraph {
    std::vector<Work> work;
    std::vector<std::shared_ptr<EmulatedCondition>> conditions;  // of its loops
    EmulatedGraph* lastBody = nullptr;
};
struct EmulatedGraphExec {
    std::vector<Work> work;
};
struct EmulatedStream {
    std::vector<Work> queue;
    EmulatedGraph* recording = nullptr;
};
struct EmulatedEvent {
    std::chrono::steady_clock::time_point time;
    EmulatedStream* stream = nullptr;
    int64_t pending = 0;  // times that it is still to be reached
};

dim3 threadIdx, blockIdx, blockDim, gridDim;

namespace emulation {
namespace {

[[noreturn]] void die(const char* why) {
    std::fprintf(stderr, "emulated GPU: %s\n", why);
    std::abort();
}

// --- memory: pages that are closed to the host, with a closed page behind ---

constexpr size_t page = 4096;
struct Region {
    char* pages;
    size_t bytes;
};
std::map<void*, Region> regions;
size_t used = 0;
std::map<const char*, size_t> pinned;  // bytes

bool isPinned(const void* p) {
    const auto* byte = static_cast<const char*>(p);
    const auto after = pinned.upper_bound(byte);
    if (after == pinned.begin()) return false;
    const auto& [begin, bytes] = *std::prev(after);
    return byte < begin + bytes;
}

void protect(int how) {
    for (const auto& [p, r] : regions) mprotect(r.pages, r.bytes, how);
}

// --- threads of a block: fibres that switch at barriers ---

const Work* body = nullptr;

struct Fibre {
    boost::context::fiber own, scheduler;
    bool done = true, waits = false;

    Fibre()
        : own(std::allocator_arg, boost::context::fixedsize_stack(256 << 10),
              [this](boost::context::fiber&& caller) {
                  for (scheduler = std::move(caller);; leave()) {
                      (*body)();
                      done = true;
                  }
                  return std::move(scheduler);
              }) {}
    void enter() {
        waits = false;
        own = std::move(own).resume();
    }
    void leave() { scheduler = std::move(scheduler).resume(); }
};
std::vector<std::unique_ptr<Fibre>> fibres;
Fibre* running = nullptr;

void resume(unsigned thread) {
    threadIdx.x = thread;
    running = fibres[thread].get();
    running->enter();
    running = nullptr;
}
void start(unsigned thread) {
    fibres[thread]->done = false;
    resume(thread);
}

unsigned inOrder(unsigned k, unsigned n) { return machine.reversed ? n - 1 - k : k; }

void runBlock(unsigned threads) {
    while (fibres.size() < threads) fibres.push_back(std::make_unique<Fibre>());
    start(inOrder(0, threads));
    if (fibres[inOrder(0, threads)]
            ->done) {  // no barriers in this kernel: fibres would only cost time
        for (unsigned k = 1; k < threads; ++k) {
            threadIdx.x = inOrder(k, threads);
            (*body)();
        }
        return;
    }
    for (unsigned k = 1; k < threads; ++k) start(inOrder(k, threads));
    for (bool again = true; again;) {
        unsigned waiting = 0;
        for (unsigned t = 0; t < threads; ++t) waiting += fibres[t]->waits && !fibres[t]->done;
        if (waiting != 0 && waiting != threads)
            die("a barrier that not all threads of the block reach");
        again = waiting > 0;
        for (unsigned k = 0; again && k < threads; ++k) resume(inOrder(k, threads));
    }
}

cudaError_t alive() { return machine.lost ? cudaErrorIllegalAddress : cudaSuccess; }

void drain(EmulatedStream* s) {
    protect(PROT_READ | PROT_WRITE);
    for (const Work& w : std::exchange(s->queue, {})) w();
    protect(PROT_NONE);
}
std::vector<EmulatedStream*> streams;

}  // namespace

cudaError_t codeForDevice() {
    return machine.codeFits ? cudaSuccess : cudaErrorNoKernelImageForDevice;
}

void noteLaunch(cudaStream_t s) { counts.launches += !s->recording; }

cudaError_t enqueue(cudaStream_t s, Work work) {
    if (machine.lost) return alive();
    (s->recording ? s->recording->work : s->queue).push_back(std::move(work));
    return cudaSuccess;
}

void finish(cudaStream_t s) {
    if (!machine.lost) drain(s);
}

void runGrid(dim3 grid, dim3 block, const Work& thread) {
    ++counts.kernels;
    body = &thread;
    gridDim = grid;
    blockDim = block;
    for (unsigned b = 0; b < grid.x; ++b) {
        blockIdx.x = inOrder(b, grid.x);
        runBlock(block.x);
    }
}

}  // namespace emulation

using namespace emulation;

void __syncthreads() {
    if (!running) die("a barrier that the first thread did not reach");
    running->waits = true;
    running->leave();
}

cudaError_t cudaGetDeviceCount(int* n) {
    if (machine.driver < 13000) return cudaErrorInsufficientDriver;
    *n = machine.devices;
    return machine.devices > 0 ? cudaSuccess : cudaErrorNoDevice;
}
cudaError_t cudaDriverGetVersion(int* v) { return *v = machine.driver, cudaSuccess; }
cudaError_t cudaRuntimeGetVersion(int* v) { return *v = 13000, cudaSuccess; }
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* p, int) {
    *p = {"emulated GPU", 9, 0};
    return alive();
}
cudaError_t cudaSetDevice(int d) {
    return d < machine.devices ? cudaSuccess : cudaErrorInvalidDevice;
}
cudaError_t cudaMemGetInfo(size_t* free, size_t* all) {
    *all = machine.memory;
    *free = machine.memory - std::min(used, machine.memory);
    return alive();
}
cudaError_t cudaGetLastError() { return alive(); }
const char* cudaGetErrorString(cudaError_t e) {
    switch (e) {
        case cudaErrorMemoryAllocation:
            return "out of memory";
        case cudaErrorInsufficientDriver:
            return "CUDA driver version is insufficient for CUDA runtime version";
        case cudaErrorNoDevice:
            return "no CUDA-capable device is detected";
        case cudaErrorNoKernelImageForDevice:
            return "no kernel image is available for execution on the device";
        case cudaErrorIllegalAddress:
            return "an illegal memory access was encountered";
        default:
            return "another error";
    }
}

cudaError_t cudaMalloc(void** p, size_t bytes) {
    if (machine.lost) return alive();
    for (EmulatedStream* s : streams)
        if (s->recording) return cudaErrorStreamCaptureUnsupported;
    if (used + bytes > machine.memory) return cudaErrorMemoryAllocation;
    const size_t pages = (bytes + page - 1) / page * page + page;
    char* memory = static_cast<char*>(
        mmap(nullptr, pages, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
    if (memory == MAP_FAILED) return cudaErrorMemoryAllocation;
    mprotect(memory + pages - page, page, PROT_NONE);
    std::memset(memory, 0xff, pages - page);  // NaN as a number
    *p = memory + (pages - page - bytes) / 16 * 16;
    mprotect(memory, pages - page, PROT_NONE);
    regions[*p] = {memory, pages - page};
    used += bytes;
    ++counts.allocations;
    return cudaSuccess;
}
cudaError_t cudaFree(void* p) {
    if (!p) return cudaSuccess;
    ++counts.waits;
    for (EmulatedStream* s : streams) drain(s);
    const auto found = regions.find(p);
    if (found == regions.end()) die("memory is freed that was not allocated");
    munmap(found->second.pages, found->second.bytes + page);
    used -= std::min(used, found->second.bytes);
    regions.erase(found);
    return alive();
}
cudaError_t cudaMallocHost(void** p, size_t bytes) {
    if (machine.lost) return alive();
    *p = std::malloc(bytes);
    pinned[static_cast<char*>(*p)] = bytes;
    return *p ? cudaSuccess : cudaErrorMemoryAllocation;
}
cudaError_t cudaFreeHost(void* p) {
    pinned.erase(static_cast<char*>(p));
    std::free(p);
    return cudaSuccess;
}
cudaError_t cudaMemcpyAsync(void* to, const void* from, size_t bytes, cudaMemcpyKind kind,
                            cudaStream_t s) {
    ++counts.copies, counts.copiedBytes += int64_t(bytes);
    const cudaError_t asked = enqueue(s, [=] { std::memcpy(to, from, bytes); });
    const bool goesBy = isPinned(kind == cudaMemcpyHostToDevice ? from : to);
    return asked != cudaSuccess || goesBy ? asked : cudaStreamSynchronize(s);
}
cudaError_t cudaMemsetAsync(void* p, int value, size_t bytes, cudaStream_t s) {
    return enqueue(s, [=] { std::memset(p, value, bytes); });
}

cudaError_t cudaStreamCreateWithFlags(cudaStream_t* s, unsigned) {
    streams.push_back(*s = new EmulatedStream);
    return alive();
}
cudaError_t cudaStreamDestroy(cudaStream_t s) {
    std::erase(streams, s);
    delete s;
    return cudaSuccess;
}
cudaError_t cudaStreamSynchronize(cudaStream_t s) {
    if (s && s->recording) return cudaErrorStreamCaptureUnsupported;
    ++counts.waits;
    if (s && !machine.lost) drain(s);
    return alive();
}
cudaError_t cudaStreamBeginCapture(cudaStream_t s, cudaStreamCaptureMode) {
    s->recording = new EmulatedGraph;
    ++counts.recordings;
    return alive();
}
cudaError_t cudaStreamEndCapture(cudaStream_t s, cudaGraph_t* g) {
    *g = std::exchange(s->recording, nullptr);
    return alive();
}
cudaError_t cudaStreamBeginCaptureToGraph(cudaStream_t s, cudaGraph_t g, const cudaGraphNode_t*,
                                          const cudaGraphEdgeData*, size_t, cudaStreamCaptureMode) {
    s->recording = g;
    return alive();
}
cudaError_t cudaStreamGetCaptureInfo(cudaStream_t s, cudaStreamCaptureStatus* status,
                                     unsigned long long*, cudaGraph_t* g,
                                     const cudaGraphNode_t** before, const cudaGraphEdgeData**,
                                     size_t* count) {
    *status = s->recording ? cudaStreamCaptureStatusActive : cudaStreamCaptureStatusNone;
    *g = s->recording;
    *before = nullptr, *count = 0;  // work is done in the order in which it was recorded
    return alive();
}
cudaError_t cudaStreamUpdateCaptureDependencies(cudaStream_t, cudaGraphNode_t*,
                                                const cudaGraphEdgeData*, size_t, unsigned) {
    return alive();
}
cudaError_t cudaGraphConditionalHandleCreate(cudaGraphConditionalHandle* h, cudaGraph_t g,
                                             unsigned atLaunch, unsigned) {
    g->conditions.push_back(std::make_shared<EmulatedCondition>(atLaunch, atLaunch));
    *h = g->conditions.back().get();
    return alive();
}
cudaError_t cudaGraphAddNode(cudaGraphNode_t* node, cudaGraph_t g, const cudaGraphNode_t*,
                             const cudaGraphEdgeData*, size_t, cudaGraphNodeParams* p) {
    const auto body = std::make_shared<EmulatedGraph>();
    const auto condition =
        std::find_if(g->conditions.begin(), g->conditions.end(),
                     [&](const auto& c) { return c.get() == p->conditional.handle; });
    if (condition == g->conditions.end()) return cudaErrorInvalidValue;
    g->lastBody = body.get();
    p->conditional.phGraph_out = &g->lastBody;
    *node = nullptr;
    g->work.push_back([loop = *condition, body] {
        for (loop->value = loop->atLaunch; loop->value != 0; ++counts.repeats)
            for (const Work& w : body->work) w();
    });
    return alive();
}
void cudaGraphSetConditional(cudaGraphConditionalHandle h, unsigned value) { h->value = value; }
cudaError_t cudaGraphDestroy(cudaGraph_t g) { return delete g, cudaSuccess; }
cudaError_t cudaGraphInstantiate(cudaGraphExec_t* e, cudaGraph_t g, unsigned long long) {
    ++counts.instantiations;
    *e = new EmulatedGraphExec{g->work};
    return cudaSuccess;
}
// As the real one: nodes may change, their number may not.
cudaError_t cudaGraphExecUpdate(cudaGraphExec_t e, cudaGraph_t g, cudaGraphExecUpdateResultInfo*) {
    if (e->work.size() != g->work.size()) return cudaErrorGraphExecUpdateFailure;
    e->work = g->work;
    return cudaSuccess;
}
cudaError_t cudaGraphExecDestroy(cudaGraphExec_t e) { return delete e, cudaSuccess; }
cudaError_t cudaGraphLaunch(cudaGraphExec_t e, cudaStream_t s) {
    ++counts.replays, ++counts.launches;
    if (machine.lost) return alive();
    s->queue.insert(s->queue.end(), e->work.begin(), e->work.end());
    return cudaSuccess;
}

cudaError_t cudaEventCreate(cudaEvent_t* e) { return *e = new EmulatedEvent, cudaSuccess; }
cudaError_t cudaEventRecord(cudaEvent_t e, cudaStream_t s) {
    e->stream = s, ++e->pending;
    return enqueue(s, [e] { e->time = std::chrono::steady_clock::now(), --e->pending; });
}
cudaError_t cudaEventQuery(cudaEvent_t e) {
    if (machine.keepsUp && e->pending > 0 && !machine.lost) drain(e->stream);
    return machine.lost ? alive() : e->pending > 0 ? cudaErrorNotReady : cudaSuccess;
}
cudaError_t cudaEventElapsedTime(float* ms, cudaEvent_t a, cudaEvent_t b) {
    *ms = std::chrono::duration<float, std::milli>(b->time - a->time).count();
    return alive();
}
cudaError_t cudaEventDestroy(cudaEvent_t e) { return delete e, cudaSuccess; }
