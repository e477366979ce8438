// Particles at every frame in the files of other programs, and films.
#include "app/shell.h"
#include "core/hdf5_file.h"
#include "scene/particle_file.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <regex>

namespace spindrift {
namespace {

// What a test reads back, by an own reader of each format.
struct ReadPiece {
    std::vector<double> points;                         // x, y, z of each
    std::map<std::string, std::vector<double>> fields;  // components together
    size_t triangles = 0;
};

template <class T> std::vector<double> numbersAt(const char* data, size_t count) {
    std::vector<T> values(count);
    std::memcpy(values.data(), data, count * sizeof(T));
    return {values.begin(), values.end()};
}

ReadPiece readVtp(const fs::path& path) {
    const std::string text = slurp(path);
    const size_t data = text.find("encoding=\"raw\">\n_") + std::strlen("encoding=\"raw\">\n_");
    EXPECT_TRUE(text.ends_with("</VTKFile>\n")) << path;
    ReadPiece piece;
    std::smatch found;
    const std::string header = text.substr(0, data);
    if (std::regex_search(header, found, std::regex("NumberOfPolys=\"(\\d+)\"")))
        piece.triangles = std::stoul(found[1]);
    const std::regex array(
        "<DataArray type=\"(\\w+)\" Name=\"([^\"]*)\" "
        "NumberOfComponents=\"\\d\" format=\"appended\" offset=\"(\\d+)\"/>");
    for (std::sregex_iterator a(header.begin(), header.end(), array), end; a != end; ++a) {
        const char* at = text.data() + data + std::stoul((*a)[3]);
        uint64_t bytes = 0;
        std::memcpy(&bytes, at, sizeof bytes);
        at += sizeof bytes;
        const std::string type = (*a)[1], name = (*a)[2];
        const std::vector<double> values = type == "Float64"   ? numbersAt<double>(at, bytes / 8)
                                           : type == "Float32" ? numbersAt<float>(at, bytes / 4)
                                                               : numbersAt<int32_t>(at, bytes / 4);
        if (name == "points")
            piece.points = values;
        else
            piece.fields[name.substr(0, name.find(' '))] = values;
    }
    return piece;
}

ReadPiece readPly(const fs::path& path) {
    const std::string text = slurp(path);
    const size_t end = text.find("end_header\n") + std::strlen("end_header\n");
    std::istringstream header(text.substr(0, end));
    std::vector<std::pair<std::string, std::string>> properties;
    size_t vertices = 0;
    ReadPiece piece;
    for (std::string word; header >> word;) {
        std::string a, b;
        if (word == "element") {
            header >> a >> b;
            (a == "vertex" ? vertices : piece.triangles) = std::stoul(b);
        } else if (word == "property" && piece.triangles == 0) {
            header >> a >> b;
            properties.push_back({a, b});
        }
    }
    const char* at = text.data() + end;
    for (size_t i = 0; i < vertices; ++i)
        for (const auto& [type, name] : properties) {
            const double value = type == "double"  ? numbersAt<double>(at, 1)[0]
                                 : type == "float" ? numbersAt<float>(at, 1)[0]
                                                   : numbersAt<int32_t>(at, 1)[0];
            at += type == "double" ? 8 : 4;
            if (name == "x" || name == "y" || name == "z")
                piece.points.push_back(value);
            else
                piece
                    .fields[name[0] == 'v' && name.size() == 2 ? "velocity"
                            : name == "rho"                    ? "density"
                            : name == "p"                      ? "pressure"
                                                               : name]
                    .push_back(value);
        }
    EXPECT_EQ(size_t(text.data() + text.size() - at), 13 * piece.triangles) << path;
    return piece;
}

ReadPiece readHdf5(const fs::path& path) {
    const hdf5::Handle file = hdf5::openFile(path.string());
    ReadPiece piece;
    for (const std::string& name : hdf5::names(file)) {
        const hdf5::Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
        const hdf5::Handle space(H5Dget_space(set), H5Sclose, name);
        std::vector<double> values(size_t(H5Sget_simple_extent_npoints(space)));
        H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
        if (name == "points")
            piece.points = values;
        else if (name == "triangles")
            piece.triangles = values.size() / 3;
        else
            piece.fields[name] = values;
    }
    return piece;
}

ReadPiece readCsv(const fs::path& path) {
    const ParticleTable table = readParticles(path.string());
    ReadPiece piece;
    for (const Vec3d& p : table.positions) piece.points.insert(piece.points.end(), {p.x, p.y, p.z});
    for (const Vec3d& v : table.velocities)
        piece.fields["velocity"].insert(piece.fields["velocity"].end(), {v.x, v.y, v.z});
    piece.fields["density"] = table.densities, piece.fields["pressure"] = table.pressures;
    return piece;
}

struct Format {
    const char *index, *files;
    ReadPiece (*read)(const fs::path&);
};
const Format Formats[] = {{"pvd", "vtp", readVtp},
                          {"xdmf", "h5", readHdf5},
                          {"ply", "ply", readPly},
                          {"csv", "csv", readCsv}};

class Series : public Shell {
protected:
    const std::string run_ = "test/solids_small --headless --backend cpu --quiet --fps 100 ";

    size_t countFiles(const std::string& folder, const std::string& piece) const {
        size_t n = 0;
        for (const auto& entry : fs::directory_iterator(folder_ / folder))
            n += entry.path().filename().string().starts_with(piece);
        return n;
    }
    // What the index names; all of it must be there.
    std::vector<std::string> named(const std::string& index, const std::string& extension) const {
        const std::string text = slurp(folder_ / index);
        const std::regex file("[\\w]+/\\w+_\\d{5}\\." + extension);
        std::vector<std::string> files;
        for (std::sregex_iterator a(text.begin(), text.end(), file), end; a != end; ++a)
            files.push_back(a->str());
        for (const std::string& f : files)
            EXPECT_TRUE(fs::exists((folder_ / index).parent_path() / f)) << f;
        return files;
    }
};

// The last moment is what the run ends with.
TEST_F(Series, HasTheParticlesInEveryFormat) {
    for (const Format& format : Formats) {
        SCOPED_TRACE(format.index);
        const std::string name = format.index;
        fs::create_directory(folder_ / name);
        const Outcome outcome = call(run_ + "--time 0.03 --series " + name + "/run." + name +
                                     " --set output.particles=end.csv");
        ASSERT_EQ(outcome.code, 0) << outcome.text;
        EXPECT_EQ(countFiles(name + "/run", "fluid"), 4u);
        const ReadPiece read =
            format.read(folder_ / name / "run" / (std::string("fluid_00003.") + format.files));
        const ParticleTable end = readParticles((folder_ / "end.csv").string());
        ASSERT_EQ(read.points.size(), 3 * end.positions.size());
        ASSERT_EQ(read.fields.at("velocity").size(), read.points.size());
        ASSERT_EQ(read.fields.at("density").size(), end.densities.size());
        for (size_t i = 0; i < end.positions.size(); ++i) {
            for (size_t k = 0; k < 3; ++k) {
                ASSERT_EQ(read.points[3 * i + k], end.positions[i][int(k)]);
                ASSERT_FLOAT_EQ(float(read.fields.at("velocity")[3 * i + k]),
                                float(end.velocities[i][int(k)]));
            }
            ASSERT_FLOAT_EQ(float(read.fields.at("density")[i]), float(end.densities[i]));
            ASSERT_FLOAT_EQ(float(read.fields.at("pressure")[i]), float(end.pressures[i]));
            if (name != "csv") { ASSERT_EQ(read.fields.at("id")[i], double(i)); }
        }
        if (name == "csv") {
            EXPECT_EQ(countFiles(name + "/run", "solids"), 0u) << "a table has no triangles";
            continue;
        }
        const ReadPiece solids =
            format.read(folder_ / name / "run" / (std::string("solids_00003.") + format.files));
        EXPECT_GT(solids.triangles, 10u);
        EXPECT_EQ(solids.points.size(), 3 * solids.fields.at("solid").size());
        if (std::string(format.index) != "ply") {
            EXPECT_EQ(named(name + "/run." + name, format.files).size() % 8, 0u);
        }
    }
}

// Fields that were asked for, and no others; each fluid by its number.
TEST_F(Series, HasTheFieldsThatWereChosen) {
    const Outcome outcome = call(
        "test/mixture_small --headless --backend cpu --quiet --steps 3 --series run.pvd "
        "--set output.fields='mass, fluid acceleration'");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const ReadPiece read = readVtp(folder_ / "run" / "fluid_00000.vtp");
    EXPECT_EQ(read.fields.count("velocity"), 0u);
    EXPECT_EQ(read.fields.at("acceleration").size(), read.points.size());
    std::map<double, std::vector<double>> masses;
    for (size_t i = 0; i < read.fields.at("fluid").size(); ++i)
        masses[read.fields.at("fluid")[i]].push_back(read.fields.at("mass")[i]);
    ASSERT_EQ(masses.size(), 2u);
    EXPECT_EQ(masses[0].front(), masses[0].back());
    EXPECT_NE(masses[0].front(), masses[1].front());
}

// Where particles come and go: by their own numbers, which are never used again, each with the mass
// of the one fluid.
TEST_F(Series, HasTheNumbersOfParticlesThatComeAndGo) {
    const Outcome outcome = call(
        "test/tap_small --headless --backend cpu --quiet --time 0.3 --fps 10 --series run.pvd "
        "--set output.fields='mass, fluid, velocity'");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    const ReadPiece first = readVtp(folder_ / "run" / "fluid_00000.vtp"),
                    last = readVtp(folder_ / "run" / "fluid_00003.vtp");
    const std::vector<double>& ids = last.fields.at("id");
    ASSERT_EQ(ids.size(), last.points.size() / 3);
    EXPECT_GT(ids.back(), double(ids.size() - 1)) << "some have left";
    EXPECT_GE(ids.back(), double(first.fields.at("id").size())) << "some have come";
    for (size_t i = 1; i < ids.size(); ++i) ASSERT_GT(ids[i], ids[i - 1]);
    ASSERT_EQ(last.fields.at("mass").size(), ids.size());
    for (const double mass : last.fields.at("mass"))
        ASSERT_EQ(mass, first.fields.at("mass").front());
    ASSERT_EQ(last.fields.at("fluid").size(), ids.size());
    for (const double fluid : last.fields.at("fluid")) ASSERT_EQ(fluid, 0);
}

TEST_F(Series, WritesSolidsThatStayOnce) {
    ASSERT_EQ(call("bowl --headless --backend cpu --quiet --set simulation.spacing=0.05 --time "
                   "0.03 --fps 100 --series run.pvd")
                  .code,
              0);
    EXPECT_EQ(countFiles("run", "fluid"), 4u);
    EXPECT_EQ(countFiles("run", "solids"), 1u);
    EXPECT_EQ(named("run.pvd", "vtp").size(), 8u);
}

// In parts, as in one go: the same files, the same index.
TEST_F(Series, GoesOnWhereTheRunBeforeEnded) {
    for (const char* index : {"pvd", "xdmf"}) {
        const std::string series = std::string(" --series run.") + index;
        ASSERT_EQ(call(run_ + "--time 0.02 --checkpoint c.h5" + series).code, 0);
        ASSERT_EQ(call("c.h5 --headless --backend cpu --quiet --fps 100 --time 0.05" + series).code,
                  0);
        const std::string parts = slurp(folder_ / (std::string("run.") + index));
        EXPECT_EQ(countFiles("run", "fluid"), 6u);
        fs::remove_all(folder_ / "run");
        ASSERT_EQ(call(run_ + "--time 0.05" + series).code, 0);
        EXPECT_EQ(slurp(folder_ / (std::string("run.") + index)), parts);
        fs::remove_all(folder_ / "run");
    }
}

// Moments have the times that they had, whenever the series was first asked for and at whatever
// rate the run went on.
TEST_F(Series, KeepsTheTimesOfTheRunBefore) {
    const auto times = [&] {
        const std::string text = slurp(folder_ / "run.pvd");
        const std::regex time("timestep=\"([^\"]*)\" part=\"0\"");
        std::vector<double> all;
        for (std::sregex_iterator a(text.begin(), text.end(), time), end; a != end; ++a)
            all.push_back(std::stod((*a)[1]));
        return all;
    };
    ASSERT_EQ(call(run_ + "--time 0.02 --checkpoint c.h5").code, 0);
    const std::string on =
        "c.h5 --headless --backend cpu --quiet --series run.pvd --checkpoint c.h5 ";
    ASSERT_EQ(call(on + "--fps 100 --time 0.04").code, 0);
    ASSERT_EQ(call(on + "--fps 50 --time 0.08").code, 0);
    const std::vector<double> wanted = {0.02, 0.03, 0.04, 0.06, 0.08}, found = times();
    ASSERT_EQ(found.size(), wanted.size());
    for (size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], wanted[k], 1e-6);
}

// A run in trouble goes back, and its moments with it.
TEST_F(Series, GoesBackWithTheRun) {
    const Outcome outcome = call(
        "test/ball_drop_small --headless --threads 2 --quiet --steps 1500 --set "
        "time.mode=fixed --set time.step=0.02 --fps 100 --series run.pvd");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_NE(outcome.text.find("back to step 0"), std::string::npos) << outcome.text;
    const std::string text = slurp(folder_ / "run.pvd");
    const std::regex entry("timestep=\"([^\"]*)\"");
    double last = -1;
    size_t moments = 0;
    for (std::sregex_iterator a(text.begin(), text.end(), entry), end; a != end; ++a, ++moments) {
        EXPECT_GT(std::stod((*a)[1]), last);
        last = std::stod((*a)[1]);
    }
    EXPECT_GT(moments, 50u);
    EXPECT_EQ(named("run.pvd", "vtp").size(), moments);
    const ReadPiece first = readVtp(folder_ / "run" / "fluid_00000.vtp");
    for (const double speed : first.fields.at("velocity")) EXPECT_EQ(speed, 0);
}

// A shorter run leaves nothing of a longer one of the same name.
TEST_F(Series, TakesTheFilesOfAnOlderRunAway) {
    ASSERT_EQ(call(run_ + "--time 0.04 --series run.csv").code, 0);
    EXPECT_EQ(countFiles("run", "fluid"), 5u);
    write("run/notes.csv", "mine");
    ASSERT_EQ(call(run_ + "--time 0.02 --series run.csv").code, 0);
    EXPECT_EQ(countFiles("run", "fluid"), 3u);
    EXPECT_EQ(slurp(folder_ / "run" / "notes.csv"), "mine");
    const std::string scene = write("from.json", R"({"version": 2, "domain": {"max": [1, 1, 1]},
        "simulation": {"spacing": 0.0499},
        "fluid": {"bodies": [{"shape": "file", "path": "run/fluid_00002.csv"}]}})");
    const Outcome outcome = call(scene + " --headless --backend cpu --steps 1 --series run.csv");
    EXPECT_EQ(outcome.code, int(Exit::Output)) << outcome.text;
    EXPECT_NE(outcome.text.find("which the scene begins with"), std::string::npos) << outcome.text;
    EXPECT_EQ(countFiles("run", "fluid"), 3u);
}

// Killed at any moment, the index names whole files only.
TEST_F(Series, IsWholeWhenTheRunIsKilled) {
    size_t points = 0;  // of each moment
    for (const char* after : {"0.7", "1.5", "3"}) {
        SCOPED_TRACE(after);
        const std::string command = "cd '" + folder_.string() + "' && timeout -s KILL " + after +
                                    " '" SPINDRIFT_PROGRAM "' " + run_ +
                                    "--time 100 --fps 500 --series run.pvd >/dev/null 2>&1";
        ASSERT_NE(std::system(command.c_str()), 0);
        for (const std::string& file : named("run.pvd", "vtp")) {
            const ReadPiece piece = readVtp(folder_ / file);
            if (file.find("fluid") == std::string::npos) continue;
            if (points == 0) points = piece.points.size();
            EXPECT_EQ(piece.points.size(), points);
            EXPECT_EQ(piece.fields.at("pressure").size(), points / 3);
        }
    }
    EXPECT_GT(points, 0u);
}

TEST_F(Series, MistakesAreNamed) {
    expectMistake(run_ + "--series run.vtk", Exit::Output, "name it .pvd (ParaView)");
    expectMistake(run_ + "--series run", Exit::Output, "name it .pvd (ParaView)");
    expectMistake(run_ + "--series run.pvd --set output.fields=velocity,vorticity", Exit::Scene,
                  "output.fields: there is no \"vorticity\"; it may list velocity, acceleration");
    write("run", "a file where the folder should be");
    expectMistake(run_ + "--series run.pvd", Exit::Output, "run");
}

// In place of ffmpeg a script that keeps what it gets.
class Films : public Shell {
protected:
    void putFfmpeg(const std::string& does) {
        fs::create_directory(folder_ / "bin");
        std::ofstream(folder_ / "bin" / "ffmpeg")
            << "#!/bin/sh\nfor last; do :; done\nlast=${last#file:}\necho \"$@\" > arguments\n" +
                   does + "\n";
        fs::permissions(folder_ / "bin" / "ffmpeg", fs::perms::owner_all);
        environment_ = "PATH='" + (folder_ / "bin").string() + "':\"$PATH\"";
    }
    const std::string run_ =
        "test/dam_break_small --headless --backend cpu --quiet --time 0.05 --size 64x48 ";
};

TEST_F(Films, GetEveryFrame) {
    putFfmpeg("cat > \"$last\"");
    const Outcome outcome = call(run_ + "--fps 100 --video run.mp4");
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(fs::file_size(folder_ / "run.mp4"), 6u * 64 * 48 * 3);
    const std::string arguments = slurp(folder_ / "arguments");
    EXPECT_NE(arguments.find("-s 64x48 -r 60 "), std::string::npos) << arguments;
    // The last frame is the picture of the end.
    ASSERT_EQ(call(run_ + "--fps 20 --video run.mkv").code, 0);
    EXPECT_EQ(fs::file_size(folder_ / "run.mkv"), 2u * 64 * 48 * 3);
    EXPECT_NE(slurp(folder_ / "arguments").find("-r 20 "), std::string::npos);
    const std::string film = slurp(folder_ / "run.mp4");
    EXPECT_NE(film.substr(0, 64 * 48 * 3), film.substr(5 * 64 * 48 * 3)) << "nothing moves";
}

TEST_F(Films, LeaveNothingBehindWhenTheyFail) {
    putFfmpeg("cat > \"$last\"; exit 3");
    write("run.mp4", "the film of another run");
    expectMistake(run_ + "--video run.mp4 --checkpoint c.h5 --set output.particles=p.csv",
                  Exit::Output, "ffmpeg ended with exit code 3");
    EXPECT_TRUE(fs::exists(folder_ / "c.h5")) << "what else was asked for is there";
    EXPECT_TRUE(fs::exists(folder_ / "p.csv"));
    EXPECT_EQ(slurp(folder_ / "run.mp4"), "the film of another run");
    putFfmpeg("exit 1");
    expectMistake(run_ + "--size 640x480 --fps 1000 --video run.mp4", Exit::Output, "ffmpeg ended");
    for (const std::string& name : files()) EXPECT_EQ(name.find("part"), std::string::npos) << name;
}

TEST_F(Films, NeedFfmpeg) {
    fs::create_directory(folder_ / "bin");
    fs::create_symlink("/usr/bin/timeout", folder_ / "bin" / "timeout");
    environment_ = "PATH='" + (folder_ / "bin").string() + "'";
    expectMistake(run_ + "--video run.mp4", Exit::Output,
                  "there is no ffmpeg; install it (apt-get install ffmpeg)");
    for (const char* name : {"run.avi", "run", "run.MP4", "/dev/null"})
        expectMistake(run_ + "--video " + name, Exit::Output, name);
}

}  // namespace
}  // namespace spindrift
