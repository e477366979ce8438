#include "app/exit_code.h"
#include "app/ceilings_bench.h"

#include "app/scene_choice.h"
#include "core/error.h"
#include "sim/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace spindrift {
namespace {

int cores() { return int(std::max(1u, std::thread::hardware_concurrency())); }

// The least of several tries, s, of f(thread) on all cores at once.
double secondsOnAllCores(const std::function<void(int)>& f) {
    double least = 1e30;
    for (int attempt = 0; attempt < 7; ++attempt) {
        const auto start = std::chrono::steady_clock::now();
        std::vector<std::thread> threads;
        for (int k = 0; k < cores(); ++k) threads.emplace_back(f, k);
        for (std::thread& t : threads) t.join();
        least = std::min(
            least, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return least;
}

typedef float Wide __attribute__((vector_size(64)));
constexpr int chains = 8;  // independent of one another: more than an addition takes cycles
__attribute__((target_clones("avx512f", "arch=haswell", "default"))) float multiplyAndAdd(
    int64_t rounds) {
    Wide sums[chains] = {}, factor = {}, addend = {};
    for (int l = 0; l < 16; ++l) factor[l] = 0.999f, addend[l] = 0.001f * float(l);
    for (int64_t k = 0; k < rounds; ++k)
#pragma GCC unroll 8
        for (int c = 0; c < chains; ++c) sums[c] = sums[c] * factor + addend;
    float total = 0;
    for (const Wide& sum : sums)
        for (int l = 0; l < 16; ++l) total += sum[l];
    return total;
}

double peakGflops() {
    constexpr int64_t rounds = 20'000'000;
    std::vector<float> results(static_cast<size_t>(cores()));
    const double seconds =
        secondsOnAllCores([&](int thread) { results[size_t(thread)] = multiplyAndAdd(rounds); });
    CHECK(std::isfinite(results[0]));
    return 2.0 * 16 * chains * double(rounds) * cores() / seconds * 1e-9;
}

// Read and written, GB/s.
double copyRate() {
    constexpr size_t bytes = 128 << 20;  // a thread
    std::vector<std::vector<char>> from(static_cast<size_t>(cores()), std::vector<char>(bytes, 1)),
        to = from;
    const double seconds = secondsOnAllCores(
        [&](int k) { std::memcpy(to[size_t(k)].data(), from[size_t(k)].data(), bytes); });
    return 2.0 * double(bytes) * cores() / seconds * 1e-9;
}

// Pairs of two different particles nearer than `radius`.
double pairsWithin(const std::vector<Particle>& particles, float radius) {
    std::vector<Vec3> places;
    for (const Particle& p : particles)
        places.push_back({float(p.position.x), float(p.position.y), float(p.position.z)});
    std::sort(places.begin(), places.end(), [](Vec3 a, Vec3 b) { return a.x < b.x; });
    int64_t pairs = 0;
    for (size_t i = 0; i < places.size(); ++i)
        for (size_t j = i + 1; j < places.size() && places[j].x - places[i].x < radius; ++j) {
            const Vec3 r = places[j] - places[i];
            pairs += r.x * r.x + r.y * r.y + r.z * r.z < radius * radius;
        }
    return double(pairs);
}

// What a pass does, counted in the source: operations a pair (a fused one is two, a root or a
// quotient one) with what both of it get, or bytes read and written a particle.
struct Work {
    double flopsPerPair, bytesPerParticle;
};
const std::map<std::string, Work> works = {{"sort", {0, 114}},
                                           {"density", {19, 0}},
                                           {"forces", {43, 0}},
                                           {"extremes", {0, 28}},
                                           {"integrate", {0, 60}}};

void printPasses(int particles, double gflops, double gigabytes) {
    const double spacing = std::cbrt(0.6 * 0.48 * 0.6 / particles);
    const Scene scene =
        chooseScene("dam_break", {{"bench", "simulation.formulation", "wcsph"},
                                  {"bench", "simulation.spacing", fmt::format("{}", spacing)},
                                  {"bench", "walls.kind", "reflect"},
                                  {"bench", "fluid.viscosity", "0"},
                                  {"bench", "compute.skin", "0"},
                                  {"bench", "compute.backend", "cpu"}});
    const auto simulation = makeSimulation(scene);
    while (simulation->clock().time < 0.1) simulation->step(5);
    simulation->resetTimes();
    simulation->step(particles > 100'000 ? 20 : 100);
    const std::vector<PassTime> times = simulation->times();
    const double within = pairsWithin(simulation->particles(), supportRadius(scene));
    const PairsSeen seen = simulation->pairsSeen();
    for (const PassTime& t : times) {
        const auto work = works.find(t.name);
        if (work == works.end()) continue;
        const double ms = t.ms / double(t.runs), n = simulation->fluidCount();
        const auto [flops, bytes] = work->second;
        if (flops > 0) {
            const double pairs = std::string(t.name) == "density" ? seen.first : seen.later,
                         reached = flops * pairs / ms * 1e-6;
            fmt::print("| {:.0f}k {} | {:.2f} | {:.2f} | {:.0f} % | {:.0f} | {:.0f} % | | |\n",
                       n / 1000, t.name, ms, pairs / ms * 1e-6, 100 * within / pairs, reached,
                       100 * reached / gflops);
        } else {
            const double reached = bytes * n / ms * 1e-6;
            fmt::print("| {:.0f}k {} | {:.2f} | | | | | {:.1f} | {:.0f} % |\n", n / 1000, t.name,
                       ms, reached, 100 * reached / gigabytes);
        }
    }
}

}  // namespace

int benchCeilings() {
    const double gflops = peakGflops(), gigabytes = copyRate();
    fmt::print(
        "{} threads: {:.0f} GFLOP/s of fused multiply-adds, {:.1f} GB/s copied (read and "
        "written)\n\n",
        cores(), gflops, gigabytes);
    fmt::print(
        "| pass | ms | pairs looked at, 1e9/s | of them within R | GFLOP/s | of the peak | GB/s | "
        "of the copy |\n|---|---|---|---|---|---|---|---|\n");
    for (int particles : {50'000, 500'000}) printPasses(particles, gflops, gigabytes);
    return int(Exit::Ok);
}

}  // namespace spindrift
