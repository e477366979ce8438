// Particles from files: what was written comes back, and what is wrong is named by its line.
#include "scene/particle_file.h"

#include "core/error.h"
#include "core/hdf5_file.h"
#include "measure/save_particles.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "sim/simulation.h"
#include "unit/scene/scene_of_file.h"

#include <fmt/format.h>
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
    ParticleFiles()
        : folder(fs::temp_directory_path() / ("spindrift-particles-" + std::to_string(getpid()))) {
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
            EXPECT_EQ(error.failure, Failure::Scene);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
            EXPECT_NE(std::string(error.what()).find(path), std::string::npos)
                << "which file? " << error.what();
            return error.what();
        }
        return "";
    }
    void expectComplaint(const std::string& text, const std::string& words) const {
        const std::string said = complaint(write(text));
        EXPECT_NE(said.find(words), std::string::npos) << words << "\nin: " << said;
    }

    fs::path folder;
};

TEST_F(ParticleFiles, ColumnsInAnyOrderWithUnitsCommentsAndGaps) {
    const std::string path = write(
        "# by hand\r\n vz [m/s],x , y,z,vx,vy,rho [kg/m^3]\r\n\r\n3,-0.5,2.5,3.5,1,2,998.5\r\n# "
        "more\r\n-3,1e-1,.5,-7,0,0,1001");
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
        t.positions.push_back({s, 1e-20 * s, 1e10 / (i + 1)}),
            t.velocities.push_back({-s, s / 3, double(float(s))});
        t.densities.push_back(1000 + s), t.pressures.push_back(-1e5 * s);
        t.masses.push_back(0.008 + s / 1000);
    }
    std::vector<double> fluids;
    for (int i = 0; i < 5000; ++i) fluids.push_back(i % 7);
    for (const char* name : {"t.csv", "t.h5"}) {
        const std::string path = (folder / name).string();
        ASSERT_TRUE(writeParticles(path, path.ends_with(".h5"), t));
        const ParticleTable again = readParticles(path);
        EXPECT_EQ(again.positions, t.positions) << name;
        EXPECT_EQ(again.velocities, t.velocities) << name;
        EXPECT_EQ(again.densities, t.densities) << name;
        EXPECT_EQ(again.pressures, t.pressures) << name;
        EXPECT_EQ(again.masses, t.masses) << name;
        EXPECT_EQ(countParticlesIn(path), 5000) << name;
        ParticleTable named = t;
        named.masses.clear(), named.fluids = fluids;
        ASSERT_TRUE(writeParticles(path, path.ends_with(".h5"), named));
        EXPECT_EQ(readParticles(path).fluids, fluids) << name;
    }
    EXPECT_FALSE(writeParticles("/nowhere/t.csv", false, t));
    EXPECT_FALSE(writeParticles("/nowhere/t.h5", true, t));
}

// A file's particles are of their own body's fluid, or of the entry that they name: also a run's
// that goes on from its own file.
TEST_F(ParticleFiles, ParticlesNameTheirFluid) {
    std::string text = "x,y,z,fluid\n";
    for (int i = 0; i < 1000; ++i)
        text += fmt::format("{},{},{},{}\n", -1 + (i % 10 + 0.5) * 0.1,
                            2 + (i / 10 % 10 + 0.5) * 0.1, 3 + (i / 100 + 0.5) * 0.1, i % 3);
    Scene scene = sceneOfFile(write(text, "f.csv"), Formulation::DeltaSph);
    for (float rho : {800.0f, 500.0f}) {
        Body block;
        block.min = scene.domain.min, block.max = block.min + Vec3{0.1f, 0.1f, 0.1f};
        block.restDensity = rho;
        scene.fluid.bodies.push_back(block);
    }
    const Placement p = placeParticles(scene);
    std::vector<int> count(3);
    for (size_t i = p.positions.size() - 1000; i < p.positions.size(); ++i) {
        EXPECT_EQ(p.bodies[i], (i - (p.positions.size() - 1000)) % 3);
        ++count[p.bodies[i]];
    }
    EXPECT_EQ(count, (std::vector<int>{334, 333, 333}));
    auto refused = [&](const std::string& line, const std::string& words) {
        try {
            scene.fluid.bodies[0].path = write(line, "g.csv");
            checkScene(scene);
            ADD_FAILURE() << words;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
    };
    refused("x,y,z,fluid\n0,2,3,3\n", "has the entries 0 to 2");
    refused("x,y,z,fluid\n0,2,3,0.5\n", "no number of an entry");
    refused("x,y,z,fluid\n0,2,3,-1\n", "no number of an entry");
    refused("x,y,z,fluid,mass\n0,2,3,0,1\n", "both mass and fluid");
}

TEST_F(ParticleFiles, AMassIsThatOfAllParticlesOfTheScene) {
    // 0.9 kg of 1000 kg/m^3 are 0.0009 m^3, the cube of 0.0965 m.
    auto lattice = [](double side, const char* name, double mass, double otherMass) {
        std::string text = std::string("x,y,z,") + name + "\n";
        for (int i = 0; i < 1000; ++i)
            text += fmt::format("{},{},{},{}\n", -1 + (i % 10 + 0.5) * side,
                                2 + (i / 10 % 10 + 0.5) * side, 3 + (i / 100 + 0.5) * side,
                                i < 999 ? mass : otherMass);
        return text;
    };
    const double side = std::cbrt(0.0009);
    Scene scene = sceneOfFile(write(lattice(side, "Mass [kg]", 0.9, 0.9)), Formulation::Wcsph);
    EXPECT_NO_THROW(checkScene(scene));
    EXPECT_NEAR(particleMass(scene), 0.9, 1e-6);
    EXPECT_EQ(massInFile(write(lattice(side, "rho", 1000, 1000), "b.csv")), 0);
    auto refused = [&](const std::string& path, const std::string& words) {
        try {
            checkScene(sceneOfFile(path, Formulation::Wcsph));
            ADD_FAILURE() << words;
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
    };
    refused(write(lattice(side, "mass", 0.9, 0.8), "c.csv"), "give each fluid a file of its own");
    refused(write(lattice(side, "mass", 0.5, 0.5), "d.csv"), "m apart in the mean, by their mass");
    scene.fluid.bodies.push_back(scene.fluid.bodies[0]);
    scene.fluid.bodies[1].path = write(lattice(0.0001, "mass", 1, 1), "e.csv");
    EXPECT_THROW(checkScene(scene), Error);
}

TEST_F(ParticleFiles, UnitsOfTheHeaderAreHonouredOrRefused) {
    const ParticleTable t =
        readParticles(write("\xef\xbb\xbf\"X [mm]\";y [cm];z;VX [km/h];vy;vz [mm/s];Rho [g/cm³];p "
                            "[bar]\r\n1500;2,5;3;36;2;3;1;2\r\n"));
    EXPECT_EQ(t.positions[0], (Vec3d{1.5, 0.025, 3}));
    EXPECT_NEAR(t.velocities[0].x, 10, 1e-12);
    EXPECT_EQ(t.velocities[0].z, 0.003);
    EXPECT_NEAR(t.densities[0], 1000, 1e-9);
    EXPECT_EQ(t.pressures[0], 2e5);
    expectComplaint("x,y,z,rho [lumps]\n1,2,3,1\n",
                    "column rho: \"lumps\" is no unit of it that is known; use kg/m³, g/cm³");
    expectComplaint("x,y,z,p [mm]\n1,2,3,1\n",
                    "column p: \"mm\" is no unit of it that is known; use Pa, hPa");
    const std::string path = (folder / "u.h5").string();
    for (const char* unit : {"mm", "lumps"}) {
        ASSERT_TRUE(hdf5::writeFile(path, [&](hid_t file) {
            for (const char* name : {"x", "y", "z"})
                hdf5::writeNumbers(file, name, name[0] == 'y' ? unit : "", {1500});
        }));
        if (unit == std::string("lumps")) continue;
        EXPECT_EQ(readParticles(path).positions[0], (Vec3d{1500, 1.5, 1500}));
    }
    EXPECT_NE(complaint(path).find("dataset y: \"lumps\" is no unit"), std::string::npos)
        << complaint(path);
}

TEST_F(ParticleFiles, MistakesAreNamedByLine) {
    expectComplaint("x,y,z\n1,2,3\n1,b,3\n", "line 3: y is no number");
    expectComplaint("x,y,z\n1,,3\n", "line 2: y is no number");
    expectComplaint("x,y,z\n1,2 3,3\n", "line 2: y is no number");
    expectComplaint("x,y,z\n1,2,nan\n", "line 2: z is no number");
    expectComplaint("x,y,z,rho\n1,2,3,-4\n", "line 2: rho = -4 kg/m³ is below 0");
    expectComplaint("x,y,z,mass\n1,2,3,0\n", "line 2: mass = 0 kg is not above 0");
    expectComplaint("x,y,z\n1,2\n1,2,3,4\n1,2,3\n\n1\n1\n",
                    "line 2: 2 values for 3 columns; line 3: 4 values for 3 columns; "
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
    EXPECT_NE(complaint(path).find("particle 1: y is no number"), std::string::npos)
        << complaint(path);
    make({1, 2}, {3}, "z");
    EXPECT_NE(complaint(path).find("1 values of y, but 2 of x"), std::string::npos)
        << complaint(path);
    make({1, 2}, {3, 4}, "w");
    EXPECT_NE(complaint(path).find("no column z"), std::string::npos) << complaint(path);
    make({}, {}, "z");
    EXPECT_NE(complaint(path).find("has no particles"), std::string::npos) << complaint(path);
    std::ofstream(path, std::ios::binary) << "\x89HDF and nothing else";
    EXPECT_NE(complaint(path).find("damaged"), std::string::npos) << complaint(path);
    EXPECT_THROW(countParticlesIn(path), Error);
}

TEST_F(ParticleFiles, ABodyHasTheFilesParticles) {
    const std::string path =
        write("x,y,z,vx,vy,vz,rho,p\n-0.5,2.5,3.5,1,2,3,1010,77\n-0.25,2.5,3.5,0,0,0,990,0\n");
    const Scene scene = sceneOfFile(path, Formulation::DeltaSph);
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
    both.fluid.bodies.insert(both.fluid.bodies.begin(),
                             Body{{.min{-1, 2, 3}, .max{-0.7f, 2.3f, 3.3f}}});
    const std::vector<Particle> more = makeSimulation(both)->particles();
    ASSERT_EQ(more.size(), 29u);
    EXPECT_EQ(more[0].density, 1000);
    EXPECT_EQ(more[27].density, 1010);
}

TEST_F(ParticleFiles, APressureGivesTheDensity) {
    const Scene scene = sceneOfFile(write("x,y,z,p\n-0.5,2.5,3.5,5000\n"), Formulation::DeltaSph);
    EXPECT_NEAR(makeSimulation(scene)->particles()[0].pressure, 5000, 5);
}

TEST_F(ParticleFiles, OutsideTheDomainIsNamedByLine) {
    const Scene scene =
        sceneOfFile(write("x,y,z\n-0.5,2.5,3.5\n\n-0.5,5,3.5\n"), Formulation::Wcsph);
    try {
        checkScene(scene, "s.json");
        ADD_FAILURE() << "was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("s.json: fluid.bodies[0].path: "),
                  std::string::npos)
            << error.what();
        EXPECT_NE(
            std::string(error.what()).find("line 4: y = 5 m is outside the domain's 2 to 3 m"),
            std::string::npos)
            << error.what();
    }
}

// A block of places on a lattice, or shaken, as a file; `more` are rows behind it.
static std::string rowsOf(int dimensions, double spacing, double shaken,
                          const std::string& more = "") {
    std::string text = "x,y,z\n";
    unsigned random = 1;
    auto place = [&](int i) {
        random = random * 1664525u + 1013904223u;
        return (i + 0.5 + shaken * (double(random) / 4294967296.0 - 0.5)) * spacing;
    };
    const int n = int(0.9 / spacing);
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < (dimensions == 2 ? 1 : n); ++z)
                text += std::to_string(place(x) - 1) + "," + std::to_string(place(y) + 2) + "," +
                        std::to_string(place(z) + 3) + "\n";
    return text + more;
}

static std::string refusalOf(const Scene& scene) {
    try {
        checkScene(scene, "s.json");
    } catch (const Error& error) {
        EXPECT_EQ(int(error.failure), int(Failure::Scene));
        return error.what();
    }
    return "";
}

TEST_F(ParticleFiles, AnotherSpacingIsRefused) {
    for (const int dimensions : {2, 3})
        for (const double shaken : {0.0, 0.3})
            for (const double ratio : {0.5, 0.8, 0.93, 0.97, 1.0, 1.03, 1.07, 1.3, 2.0}) {
                Scene scene = sceneOfFile(write(rowsOf(dimensions, 0.06 * ratio, shaken)),
                                          Formulation::Wcsph);
                scene.simulation.dimensions = dimensions;
                scene.simulation.spacing = 0.06f;
                const std::string said = refusalOf(scene);
                const bool near = std::abs(ratio - 1) < 0.05;
                EXPECT_EQ(said.empty(), near) << dimensions << " dimensions, shaken by " << shaken
                                              << ", " << ratio << ": " << said;
                const bool named =
                    said.find("fluid.bodies[0].path: ") != std::string::npos &&
                    said.find("m apart in the mean, and simulation.spacing is 0.06 m") !=
                        std::string::npos;
                EXPECT_EQ(named, !near) << said;
            }
}

TEST_F(ParticleFiles, DoubledParticlesAreCountedAndPlaced) {
    const std::string again = "-0.95,2.05,3.05\n-0.85,2.0501,3.05\n";
    const std::string said =
        refusalOf(sceneOfFile(write(rowsOf(3, 0.1, 0, again)), Formulation::Wcsph));
    EXPECT_NE(
        said.find(
            "2 of 731 particles are where another one is, the first at (-0.95, 2.05, 3.05) m"),
        std::string::npos)
        << said;
    EXPECT_NE(said.find("line 2 and "), std::string::npos) << said;
    EXPECT_NE(said.find("line 731; remove"), std::string::npos) << said;
    // One file twice, and the first and the last layer of a period.
    Scene twice = sceneOfFile(write(rowsOf(3, 0.1, 0)), Formulation::Wcsph);
    EXPECT_EQ(refusalOf(twice), "");
    twice.fluid.bodies.push_back(twice.fluid.bodies[0]);
    EXPECT_NE(refusalOf(twice).find("729 of 1458 particles"), std::string::npos)
        << refusalOf(twice);
    Scene around = sceneOfFile(write("x,y,z\n-1,2.5,3.5\n0,2.5,3.5\n"), Formulation::Wcsph);
    around.domain.max.x = 0.2f;
    EXPECT_EQ(refusalOf(around), "");
    around.domain.max.x = 0, around.domain.periodicX = true, around.simulation.spacing = 0.08f;
    EXPECT_NE(refusalOf(around).find("1 of 2 particles"), std::string::npos) << refusalOf(around);
}

TEST_F(ParticleFiles, DensitiesInAnotherUnitAreRefused) {
    const std::string row = "\n-0.5,2.5,3.5,1\n";
    const std::string said =
        refusalOf(sceneOfFile(write("x,y,z,rho" + row), Formulation::DeltaSph));
    EXPECT_NE(said.find("rho is 1 to 1 kg/m³, and 1000 at rest; name its unit in the header"),
              std::string::npos)
        << said;
    EXPECT_EQ(refusalOf(sceneOfFile(write("x,y,z,rho [g/cm^3]" + row), Formulation::DeltaSph)), "");
}

// In the classic formulation a particle does not count itself: a drop alone has no density.
TEST_F(ParticleFiles, LoneParticlesOfTheClassicFormulationAreTaken) {
    Scene scene;
    scene.compute.backend = Backend::Cpu;
    scene.simulation.formulation = Formulation::Classic;
    scene.simulation.spacing = 0.1f;
    scene.domain = {{-1, 2, 3}, {0, 3, 4}};
    scene.fluid.bodies = {Body{{.min{-0.6f, 2.4f, 3.4f}, .max{-0.5f, 2.5f, 3.5f}}}};
    auto simulation = makeSimulation(scene);
    simulation->step(1);
    ASSERT_EQ(simulation->fluidCount(), 1);
    ASSERT_EQ(simulation->particles()[0].density, 0);
    for (const char* name : {"lone.csv", "lone.h5"}) {
        const std::string path = (folder / name).string();
        saveParticles(path, simulation->particles());
        for (const Formulation next :
             {Formulation::Classic, Formulation::Wcsph, Formulation::DeltaSph}) {
            Scene again = sceneOfFile(path, next);
            again.simulation.kernel =
                Kernel::CubicSpline;  // the only one of the classic formulation
            EXPECT_EQ(refusalOf(again), "") << name;
            const auto run = makeSimulation(again);
            EXPECT_EQ(run->fluidCount(), 1);
            if (next == Formulation::DeltaSph) {
                EXPECT_EQ(run->particles()[0].density, 1000)
                    << "at rest, when nobody says otherwise";
            }
        }
    }
}

// What a run has written begins another one, however violent it was.
TEST_F(ParticleFiles, StatesOfViolentRunsAreTaken) {
    for (const int dimensions : {2, 3})
        for (const Formulation formulation :
             {Formulation::Wcsph, Formulation::DeltaSph, Formulation::DeltaPlus}) {
            Scene scene;
            scene.compute.backend = Backend::Cpu;
            scene.simulation.formulation = formulation;
            scene.simulation.dimensions = dimensions;
            scene.simulation.spacing = dimensions == 2 ? 0.02f : 0.05f;
            scene.domain = {{0, 0, 0}, {0.8f, 1, 0.4f}};
            scene.fluid.bodies.assign(2, Body{});
            scene.fluid.bodies[0].min = {0, 0, 0}, scene.fluid.bodies[0].max = {0.8f, 0.3f, 0.4f};
            scene.fluid.bodies[1].min = {0.24f, 0.4f, 0},
            scene.fluid.bodies[1].max = {0.56f, 0.72f, 0.4f};
            scene.fluid.bodies[1].velocity = {0, -8, 0};
            const auto simulation = makeSimulation(scene);
            for (const double time : {0.03, 0.08}) {
                while (simulation->measure().time < time) simulation->step();
                ParticleTable table;
                for (const Particle& p : simulation->particles()) {
                    table.positions.push_back(p.position), table.velocities.push_back(p.velocity);
                    table.densities.push_back(p.density), table.pressures.push_back(p.pressure);
                }
                Scene next = scene;
                next.fluid.bodies.assign(1, Body{});
                next.fluid.bodies[0].shape = Shape::File;
                next.fluid.bodies[0].path = (folder / "state.csv").string();
                ASSERT_TRUE(writeParticles(next.fluid.bodies[0].path, false, table));
                EXPECT_EQ(refusalOf(next), "") << dimensions << " dimensions, formulation "
                                               << int(formulation) << ", " << time << " s";
            }
        }
}

TEST_F(ParticleFiles, ARelativePathStartsAtTheSceneFile) {
    write("x,y,z\n0.5,0.5,0.5\n", "drops.csv");
    const std::string file =
        write(R"({"version": 2, "fluid": {"bodies": [{"shape": "file", "path": "drops.csv"}]}})",
              "s.json");
    const Scene scene = loadScene(file);
    EXPECT_EQ(scene.fluid.bodies[0].path, (folder / "drops.csv").string());
    EXPECT_NO_THROW(checkScene(scene));
    EXPECT_EQ(loadScene(write(writeScene(scene), "again.json")).fluid.bodies[0].path,
              scene.fluid.bodies[0].path);
}

// The memory that it would take is looked at first.
TEST_F(ParticleFiles, FilesAreCountedForTheMemory) {
    const std::string path = (folder / "many.h5").string();
    ASSERT_TRUE(hdf5::writeFile(path, [](hid_t file) {
        const hsize_t size = 999'999'999;  // nothing of it is stored
        const hdf5::Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "space");
        for (const char* name : {"x", "y", "z"})
            hdf5::Handle(H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT,
                                    H5P_DEFAULT),
                         H5Dclose, name);
    }));
    if (double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGESIZE)) > 300e9)
        GTEST_SKIP() << "this machine could hold it";
    try {
        checkScene(sceneOfFile(path, Formulation::Wcsph));
        ADD_FAILURE() << "was taken";
    } catch (const Error& error) {
        EXPECT_EQ(int(error.failure), int(Failure::Memory)) << error.what();
    }
}

}  // namespace
}  // namespace spindrift
