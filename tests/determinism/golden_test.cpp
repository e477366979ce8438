// The numbers of a step are those of the change before: twelve scenes over all features, bit by
// bit. A change that means to alter them writes tests/determinism/golden.txt anew, by running this
// test with SPINDRIFT_WRITE_GOLDEN=1, and says why.
#include "determinism/hash.h"
#include "instruction_sets.h"
#include "scene/schema.h"

#include <gtest/gtest.h>

#include <immintrin.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>

namespace spindrift {
namespace {

struct GoldenRun {
    const char* scene;
    std::vector<std::string> knobs;
};

const std::vector<GoldenRun> Runs = {
    {"test/dam_break_small.json", {}},
    {"test/dam_break_small.json",
     {"simulation.formulation=delta_sph", "time.integrator=predictor_corrector",
      "walls.kind=particles"}},
    {"test/dam_break_small.json",
     {"simulation.formulation=delta_plus", "time.integrator=velocity_verlet"}},
    {"test/dam_break_small.json", {"simulation.formulation=delta_sph", "time.integrator=split"}},
    {"test/dam_break_small.json", {"simulation.formulation=incompressible"}},
    {"test/ball_drop_small.json", {"time.mode=local"}},
    {"test/historical_small.json", {}},
    {"test/solids_small.json", {}},
    {"test/mesh_small.json", {}},
    {"test/floating_small.json", {}},
    {"test/artery_small.json", {}},
    {"test/mixture_small.json", {}},
    {"test/surface_small.json", {}},
    {"validation/cavity.json", {}},
};

const std::string GoldenFile = SPINDRIFT_SOURCE_DIR "/tests/determinism/golden.txt";

// Double precision, and all that this build and this machine have in floats.
std::vector<std::string> waysToCompute() {
    std::vector<std::string> ways = {"compute.precision=double"};
    for (const Simd simd : instructionSets())
        ways.push_back(std::string("compute.simd=") + enumNames(simd)[size_t(simd)]);
    return ways;
}

// SSE and AVX2 begin a reciprocal with an estimate that is not the same on processors of different
// makers (RCPPS; that of AVX-512 is). So their hashes hold on processors that estimate alike.
std::string estimatesOfThisProcessor() {
    uint32_t hash = 2166136261u;
    for (int k = 0; k < 4096; ++k) {
        std::array<float, 4> estimate;
        _mm_storeu_ps(estimate.data(), _mm_rcp_ps(_mm_set1_ps(1 + float(k) / 4096)));
        uint32_t bits;
        std::memcpy(&bits, estimate.data(), sizeof bits);
        hash = (hash ^ bits) * 16777619u;
    }
    return fmt::format("rcp {:08x}", hash);
}
bool dependsOnEstimates(const std::string& way) {
    return way == "compute.simd=sse" || way == "compute.simd=avx2";
}

// The compiler that wrote the file, and its lines: a hash, a blank and the run's name.
struct Golden {
    std::string compiler;
    std::map<std::string, std::string> hashes;
};
Golden readGolden() {
    Golden golden;
    std::ifstream file(GoldenFile);
    std::getline(file, golden.compiler);
    for (std::string line; std::getline(file, line);)
        golden.hashes[line.substr(line.find(' ') + 1)] = line.substr(0, line.find(' '));
    return golden;
}

TEST(Golden, TwelveScenesKeepTheirBits) {
    const bool writes = std::getenv("SPINDRIFT_WRITE_GOLDEN");
    Golden golden = readGolden();
    if (!writes && golden.compiler != __VERSION__)
        GTEST_SKIP() << "golden.txt was written with compiler " << golden.compiler;
    golden.compiler = __VERSION__;
    int compared = 0;
    for (const std::string& way : waysToCompute())
        for (const GoldenRun& run : Runs) {
            Scene scene = loadConfig(run.scene, run.knobs);
            setKnob(scene, way);
            std::string name = way + " " + run.scene;
            for (const std::string& knob : run.knobs) name += " " + knob;
            if (dependsOnEstimates(way)) {
                name += " " + estimatesOfThisProcessor();
                if (!writes && !golden.hashes.contains(name)) continue;
            }
            const std::string hash = fmt::format("{:016x}", hashAfter(scene, 30));
            if (writes)
                golden.hashes[name] = hash;
            else
                EXPECT_EQ(golden.hashes[name], hash) << name;
            ++compared;
        }
    EXPECT_GE(compared, int(Runs.size()));
    if (!writes) return;
    std::ofstream file(GoldenFile);
    file << golden.compiler << "\n";
    for (const auto& [name, hash] : golden.hashes) file << hash << " " << name << "\n";
}

}  // namespace
}  // namespace spindrift
