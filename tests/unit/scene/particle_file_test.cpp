// Particles from files: what was written comes back, and what is wrong is named by its line.
#include "scene/particle_file.h"

#include "core/error.h"
#include "core/hdf5_file.h"
#include "scene/check.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

namespace spindrift {
namespace {

namespace fs = std::filesystem;

class ParticleFiles : public testing::Test {
protected:
    ParticleFiles() : folder(fs::temp_directory_path() / ("spindrift-particles-" + std::to_string(getpid()))) {
        fs::create_directories(folder);
    }
    ~ParticleFiles() override { fs::remove_all(folder); }
    std::string write(const std::string& text, const std::string& name = "a.csv") const {
        std::ofstream(folder / name, std::ios::binary) << text;
        return (folder / name).string();
    }
    static std::string complaint(const std::string& path) {
        try {
            readParticles(path);
        } catch (const Error& error) {
            EXPECT_EQ(error.exit, Exit::Scene);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << "which file? " << error.what();
            return error.what();
        }
        return "";
    }
    void expectComplaint(const std::string& text, const std::string& words) const {
        const std::string said = complaint(write(text));
        EXPECT_NE(said.find(words), std::string::npos) << words << "\nin: " << said;
    }
    // A scene that begins with the particles of a file.
    static Scene sceneOf(const std::string& path, Formulation formulation) {
        Scene scene;
        scene.compute.backend = Backend::Cpu;
        scene.compute.threads = 1;
        scene.simulation.formulation = formulation;
        scene.domain = {{-1, 2, 3}, {0, 3, 4}};
        scene.simulation.spacing = 0.1f;
        scene.fluid.bodies.assign(1, Body{});
        scene.fluid.bodies[0].shape = Shape::File;
        scene.fluid.bodies[0].path = path;
        return scene;
    }

    fs::path folder;
};

TEST_F(ParticleFiles, ColumnsInAnyOrderWithUnitsCommentsAndGaps) {
    const std::string path = write("# by hand\r\n vz [m/s],x , y,z,vx,vy,rho [kg/m^3]\r\n\r\n3,-0.5,2.5,3.5,1,2,998.5\r\n# more\r\n-3,1e-1,.5,-7,0,0,1001");
    const ParticleTable t = readParticles(path);
    ASSERT_EQ(t.positions.size(), 2u);
    EXPECT_EQ(t.positions[0], (Vec3d{-0.5, 2.5, 3.5}));
    EXPECT_EQ(t.velocities[0], (Vec3d{1, 2, 3}));
    EXPECT_EQ(t.positions[1], (Vec3d{0.1, 0.5, -7}));
    EXPECT_EQ(t.densities, (std::vector<double>{998.5, 1001}));
    EXPECT_TRUE(t.pressures.empty());
    EXPECT_EQ(t.nameOf(1), "line 6");
    EXPECT_EQ(countParticlesIn(path), 2);
    EXPECT_EQ(readParticles(write("x,y,z\n1,2,3\n")).velocities[0], (Vec3d{0, 0, 0}));
}

TEST_F(ParticleFiles, WhatIsWrittenIsReadBitByBit) {
    ParticleTable t;
    for (int i = 0; i < 5000; ++i) {
        const double s = std::sin(i + 0.1);
        t.positions.push_back({s, 1e-20 * s, 1e10 / (i + 1)}), t.velocities.push_back({-s, s / 3, double(float(s))});
        t.densities.push_back(1000 + s), t.pressures.push_back(-1e5 * s);
    }
    for (const char* name : {"t.csv", "t.h5"}) {
        const std::string path = (folder / name).string();
        ASSERT_TRUE(writeParticles(path, path.ends_with(".h5"), t));
        const ParticleTable again = readParticles(path);
        EXPECT_EQ(again.positions, t.positions) << name;
        EXPECT_EQ(again.velocities, t.velocities) << name;
        EXPECT_EQ(again.densities, t.densities) << name;
        EXPECT_EQ(again.pressures, t.pressures) << name;
        EXPECT_EQ(countParticlesIn(path), 5000) << name;
    }
    EXPECT_FALSE(writeParticles("/nowhere/t.csv", false, t));
    EXPECT_FALSE(writeParticles("/nowhere/t.h5", true, t));
}

TEST_F(ParticleFiles, MistakesAreNamedByLine) {
    expectComplaint("x,y,z\n1,2,3\n1,b,3\n", "line 3: y is no number");
    expectComplaint("x,y,z\n1,,3\n", "line 2: y is no number");
    expectComplaint("x,y,z\n1,2 3,3\n", "line 2: y is no number");
    expectComplaint("x,y,z\n1,2,nan\n", "line 2: z is no number");
    expectComplaint("x,y,z,rho\n1,2,3,-4\n", "line 2: rho = -4 kg/m^3 is not above 0");
    expectComplaint("x,y,z\n1,2\n1,2,3,4\n1,2,3\n\n1\n1\n", "line 2: 2 values for 3 columns; line 3: 4 values for 3 columns; "
                                                            "line 6: 1 values for 3 columns; and 1 more");
    expectComplaint("x,y,z,vx\n1,2,3,4\n", "has some of the columns vx, vy, vz");
    expectComplaint("x,y,z,w\n1,2,3,4\n", "unknown column \"w\"; known: x, y, z, vx");
    expectComplaint("x,y,x\n1,2,3\n", "names a column twice");
    expectComplaint("x,y\n1,2\n", "has no column z");
    expectComplaint("1,2,3\n1,2,3\n", "has no column x");
    expectComplaint("x,y,z\n", "has no rows");
    expectComplaint("", "is empty");
    EXPECT_NE(complaint((folder / "none.csv").string()).find("no such file"), std::string::npos);
    EXPECT_NE(complaint(folder.string()).find("it is a folder"), std::string::npos);
}

TEST_F(ParticleFiles, MistakesInHdf5) {
    const std::string path = (folder / "a.h5").string();
    auto make = [&](std::vector<double> x, std::vector<double> y, const char* third) {
        ASSERT_TRUE(hdf5::writeFile(path, [&](hid_t file) {
            hdf5::writeNumbers(file, "x", "m", x);
            hdf5::writeNumbers(file, "y", "m", y);
            hdf5::writeNumbers(file, third, "m", x);
        }));
    };
    make({1, 2}, {3, 4}, "z");
    EXPECT_EQ(complaint(path), "");
    make({1, 2}, {3, NAN}, "z");
    EXPECT_NE(complaint(path).find("particle 1: y is no number"), std::string::npos) << complaint(path);
    make({1, 2}, {3}, "z");
    EXPECT_NE(complaint(path).find("1 values of y, but 2 of x"), std::string::npos) << complaint(path);
    make({1, 2}, {3, 4}, "w");
    EXPECT_NE(complaint(path).find("no column z"), std::string::npos) << complaint(path);
    make({}, {}, "z");
    EXPECT_NE(complaint(path).find("has no particles"), std::string::npos) << complaint(path);
    std::ofstream(path, std::ios::binary) << "\x89HDF and nothing else";
    EXPECT_NE(complaint(path).find("damaged"), std::string::npos) << complaint(path);
    EXPECT_THROW(countParticlesIn(path), Error);
}

TEST_F(ParticleFiles, ABodyHasTheFilesParticles) {
    const std::string path = write("x,y,z,vx,vy,vz,rho,p\n-0.5,2.5,3.5,1,2,3,1010,77\n-0.25,2.5,3.5,0,0,0,990,0\n");
    const Scene scene = sceneOf(path, Formulation::DeltaSph);
    EXPECT_NO_THROW(checkScene(scene));
    EXPECT_EQ(countParticles(scene).fluid, 2);
    const auto simulation = makeSimulation(scene);
    const std::vector<Particle> p = simulation->particles();
    ASSERT_EQ(p.size(), 2u);
    EXPECT_EQ(p[0].position, (Vec3d{-0.5, 2.5, 3.5}));
    EXPECT_EQ(p[0].velocity, (Vec3d{1, 2, 3}));
    EXPECT_EQ(p[0].density, 1010);
    EXPECT_EQ(p[1].density, 990);
    // Beside another body: its density is the rest density, and it stays where it is.
    Scene both = scene;
    both.fluid.bodies.insert(both.fluid.bodies.begin(), Body{{.min{-1, 2, 3}, .max{-0.7f, 2.3f, 3.3f}}});
    const std::vector<Particle> more = makeSimulation(both)->particles();
    ASSERT_EQ(more.size(), 29u);
    EXPECT_EQ(more[0].density, 1000);
    EXPECT_EQ(more[27].density, 1010);
}

TEST_F(ParticleFiles, APressureGivesTheDensity) {
    const Scene scene = sceneOf(write("x,y,z,p\n-0.5,2.5,3.5,5000\n"), Formulation::DeltaSph);
    EXPECT_NEAR(makeSimulation(scene)->particles()[0].pressure, 5000, 5);
}

TEST_F(ParticleFiles, OutsideTheDomainIsNamedByLine) {
    const Scene scene = sceneOf(write("x,y,z\n-0.5,2.5,3.5\n\n-0.5,5,3.5\n"), Formulation::Wcsph);
    try {
        checkScene(scene, "s.json");
        ADD_FAILURE() << "was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("s.json: fluid.bodies[0].path: "), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("line 4: y = 5 m is outside the domain's 2 to 3 m"), std::string::npos) << error.what();
    }
}

TEST_F(ParticleFiles, ARelativePathStartsAtTheSceneFile) {
    write("x,y,z\n0.5,0.5,0.5\n", "drops.csv");
    const std::string file = write(R"({"version": 2, "fluid": {"bodies": [{"shape": "file", "path": "drops.csv"}]}})", "s.json");
    const Scene scene = loadScene(file);
    EXPECT_EQ(scene.fluid.bodies[0].path, (folder / "drops.csv").string());
    EXPECT_NO_THROW(checkScene(scene));
    EXPECT_EQ(loadScene(write(writeScene(scene), "again.json")).fluid.bodies[0].path, scene.fluid.bodies[0].path);
}

// The memory that it would take is looked at first.
TEST_F(ParticleFiles, FilesAreCountedForTheMemory) {
    const std::string path = (folder / "many.h5").string();
    ASSERT_TRUE(hdf5::writeFile(path, [](hid_t file) {
        const hsize_t size = 999'999'999;   // nothing of it is stored
        const hdf5::Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "space");
        for (const char* name : {"x", "y", "z"})
            hdf5::Handle(H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose, name);
    }));
    if (double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) > 300e9) GTEST_SKIP() << "this machine could hold it";
    try {
        checkScene(sceneOf(path, Formulation::Wcsph));
        ADD_FAILURE() << "was taken";
    } catch (const Error& error) { EXPECT_EQ(int(error.exit), int(Exit::Memory)) << error.what(); }
}

}  // namespace
}  // namespace spindrift
