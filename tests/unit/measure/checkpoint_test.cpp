// A checkpoint is what was written, or an error of one line; never something else, never half a
// file.
#include "measure/checkpoint.h"

#include "core/error.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

class Checkpoints : public testing::Test {
protected:
    Checkpoints() {
        folder = fs::temp_directory_path() / ("spindrift-checkpoint-" + std::to_string(getpid()));
        fs::create_directories(folder);
        file = (folder / "a.h5").string();
        std::mt19937 random(2);
        std::uniform_real_distribution<float> unit(0, 1);
        Placement p;
        for (int i = 0; i < 3000; ++i) {
            p.positions.push_back({unit(random), unit(random), unit(random)});
            p.velocities.push_back({unit(random) - 0.5f, 1e-30f * unit(random), -unit(random)});
            if (i % 3 == 0) p.walls.push_back({unit(random), 0, 0});
        }
        state = RunState(std::move(p));
        state.clock = {0.1 + 0.2, 1e-4 / 3, 12345678901};
        scene.fluid.viscosity = 0.1f;
        scene.name = "naïve \"name\"";
    }
    ~Checkpoints() override { fs::remove_all(folder); }

    static std::string bytesOf(const std::string& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static bool same(const Checkpoint& a, const Scene& scene, const RunState& b) {
        return writeScene(a.scene) == writeScene(scene) &&
               a.state.particles.positions == b.particles.positions &&
               a.state.particles.velocities == b.particles.velocities &&
               a.state.particles.walls == b.particles.walls &&
               a.state.particles.bodies == b.particles.bodies && a.state.densities == b.densities &&
               a.state.clock.time == b.clock.time && a.state.clock.dt == b.clock.dt &&
               a.state.clock.steps == b.clock.steps && a.state.start.low == b.start.low &&
               a.state.start.high == b.start.high && a.state.start.speed == b.start.speed;
    }
    // "" when it reads as what was written, "another" when as something else, else what the error
    // says.
    std::string outcome(const std::string& path) const {
        try {
            return same(readCheckpoint(path), scene, state) ? "" : "another";
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::Scene);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            return error.what();
        }
    }

    fs::path folder;
    std::string file;
    Scene scene;
    RunState state;
};

TEST_F(Checkpoints, ReadsWhatWasWrittenBitByBit) {
    writeCheckpoint(file, scene, state);
    EXPECT_TRUE(isCheckpoint(file));
    EXPECT_EQ(outcome(file), "");
    const std::string first = bytesOf(file);
    sleep(1);
    writeCheckpoint(file, scene, state);
    EXPECT_EQ(bytesOf(file), first) << "the same state gives another file";
    state.particles.walls.clear();
    scene.simulation.formulation = Formulation::DeltaSph;
    state.densities.assign(state.particles.positions.size(), 998.5f);
    writeCheckpoint(file, scene, state);
    EXPECT_EQ(outcome(file), "");
    state.densities[7] = -1;
    writeCheckpoint(file, scene, state);
    EXPECT_NE(outcome(file).find("densities"), std::string::npos) << outcome(file);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
        << "leaves something beside it";
}

// In two dimensions what has a depth was of a slab one spacing thick until version 4, and is of a
// metre since then.
TEST_F(Checkpoints, OlderOnesInTwoDimensionsAreSpreadOverAMetre) {
    scene.solids.resize(1);
    scene.solids[0].density = 500;
    scene.fluid.particleMass = 0.5f, scene.contact.stiffness = 8;
    state.solids.resize(1);
    state.solids[0].angularMomentum = {0, 0, 3};
    for (const int dimensions : {2, 3})
        for (const double version : {4.0, 5.0}) {
            scene.simulation.dimensions = dimensions;
            state.particles.solidSizes = {10};
            writeCheckpoint(file, scene, state, {{0, 4, 2, 0}});
            const hid_t old = H5Fopen(file.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
            const hid_t attribute = H5Aopen(old, "version", H5P_DEFAULT);
            H5Awrite(attribute, H5T_NATIVE_DOUBLE, &version);
            H5Aclose(attribute), H5Fclose(old);
            const Checkpoint read = readCheckpoint(file);
            const double per = dimensions == 2 && version < 5 ? 1 / scene.simulation.spacing : 1;
            EXPECT_NEAR(read.state.solids[0].angularMomentum.z, 3 * per, 1e-4);
            EXPECT_NEAR(double(read.scene.fluid.particleMass), 0.5 * per, 1e-4);
            EXPECT_NEAR(double(read.scene.contact.stiffness), 8 * per, 1e-3);
            EXPECT_NEAR(double(read.curves.at(0).kineticEnergy), 4 * per, 1e-3);
            EXPECT_NEAR(double(read.curves.at(0).potentialEnergy), 2 * per, 1e-3);
        }
}

TEST_F(Checkpoints, TruncatedFilesAreRefused) {
    writeCheckpoint(file, scene, state);
    const std::string whole = bytesOf(file), part = (folder / "part.h5").string();
    for (double share : {0.0, 0.001, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999}) {
        std::ofstream(part, std::ios::binary)
            << whole.substr(0, size_t(share * double(whole.size())));
        EXPECT_NE(outcome(part), "") << share;
        EXPECT_NE(outcome(part), "another") << share;
    }
}

TEST_F(Checkpoints, DamagedBytesAreNeverBelieved) {
    writeCheckpoint(file, scene, state);
    const std::string whole = bytesOf(file), damaged = (folder / "damaged.h5").string();
    const char* seed = std::getenv("SPINDRIFT_SEED");  // to try others
    std::mt19937 random(seed ? unsigned(std::atoi(seed)) : 9u);
    int refused = 0;
    for (int k = 0; k < 300; ++k) {
        std::string bytes = whole;
        // Every other time among the first bytes, where the structure is.
        const size_t at = random() % (k % 2 ? bytes.size() : 4096);
        bytes[at] = char(bytes[at] ^ char(1 + random() % 255));
        std::ofstream(damaged, std::ios::binary) << bytes;
        const std::string what = outcome(damaged);
        EXPECT_NE(what, "another") << "byte " << at;
        refused += !what.empty();
    }
    EXPECT_GT(refused, 150);
}

TEST_F(Checkpoints, FilesOfOthersAreRefused) {
    const hid_t other = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(other);
    EXPECT_NE(outcome(file).find("no checkpoint of Spindrift"), std::string::npos);
    std::ofstream(file) << "{\"version\": 2}";
    EXPECT_FALSE(isCheckpoint(file));
    EXPECT_NE(outcome(file).find("damaged"), std::string::npos);
    EXPECT_NE(outcome((folder / "missing.h5").string()), "");
}

// A limit on the size of files fails as a full disk does.
TEST_F(Checkpoints, FullDiskKeepsTheLastOne) {
    writeCheckpoint(file, scene, state);
    const std::string before = bytesOf(file);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit limit{};
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit small{20000, limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    RunState later = state;
    later.clock.steps += 5;
    try {
        writeCheckpoint(file, scene, later);
        ADD_FAILURE() << "was written";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::Output);
        EXPECT_NE(std::string(error.what()).find("is the disk full?"), std::string::npos)
            << error.what();
    }
    setrlimit(RLIMIT_FSIZE, &limit);
    EXPECT_EQ(bytesOf(file), before);
    EXPECT_EQ(outcome(file), "");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
        << "leaves something beside it";
}

// What floats and what bends is there again, and the run has the bits of the one that went on.
TEST_F(Checkpoints, HoldSolidsThatFloatAndObjects) {
    Scene s = loadScene(SPINDRIFT_SOURCE_DIR "/configs/test/floating_small.json");
    s.compute.backend = Backend::Cpu;
    setKnob(s, R"(objects=[{"shape":"sheet","min":[0.05,0.55,0.1],"max":[0.25,0.55,0.7],)"
               R"("breaking_strain":0.01}])");
    setKnob(s, R"(grips=[{"min":[0,0.5,0],"max":[0.06,0.6,1]}])");
    auto first = makeSimulation(s);
    first->step(120);
    const RunState left = first->state();
    writeCheckpoint(file, s, left);
    const Checkpoint c = readCheckpoint(file);
    ASSERT_EQ(c.state.solids.size(), 3u);
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(c.state.solids[k].centre, left.solids[k].centre);
        EXPECT_EQ(c.state.solids[k].dragged, left.solids[k].dragged);
        EXPECT_EQ(c.state.solids[k].velocity, left.solids[k].velocity);
        EXPECT_EQ(c.state.solids[k].left, left.solids[k].left);
        EXPECT_EQ(c.state.solids[k].angularMomentum, left.solids[k].angularMomentum);
        EXPECT_TRUE(c.state.solids[k].turn == left.solids[k].turn);
    }
    EXPECT_EQ(c.state.objects.positions, left.objects.positions);
    EXPECT_EQ(c.state.objects.broken, left.objects.broken);
    EXPECT_GT(std::count(left.objects.broken.begin(), left.objects.broken.end(), 1), 0);
    first->restart(left);
    auto second = makeSimulation(c.scene, c.state);
    for (Simulation* run : {first.get(), second.get()}) run->step(50);
    EXPECT_EQ(first->state().particles.positions, second->state().particles.positions);
    EXPECT_EQ(first->state().objects.positions, second->state().objects.positions);
    EXPECT_EQ(first->measure().solids[0].position, second->measure().solids[0].position);
}

}  // namespace
}  // namespace spindrift
