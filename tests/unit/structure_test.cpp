// The tree keeps its shape: which folder may include which, every source file in one list, tests
// for each folder.
#include <fnmatch.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace spindrift {
namespace {

namespace fs = std::filesystem;
const fs::path Root = SPINDRIFT_SOURCE_DIR, Source = Root / "source";

// docs/DESIGN.md, "The tree".
const std::map<std::string, std::set<std::string>> MayInclude = {
    {"core", {"core"}},
    {"scene", {"core", "scene"}},
    {"device", {"core", "device"}},
    {"sim", {"core", "scene", "device", "sim"}},
    {"measure", {"core", "scene", "sim", "measure"}},
    {"render", {"core", "render"}},
    {"app", {"core", "scene", "sim", "measure", "render", "app"}},
};

// Headers of libraries that only some files may see; a file is given by its path below source/.
struct LibraryRule {
    const char* name;
    std::vector<const char*> headers, allowed;
};
const std::vector<LibraryRule> LibraryRules = {
    {"SDL", {"SDL*"}, {"app/window/*"}},
    {"Dear ImGui", {"imgui*", "backends/imgui*"}, {"app/window/*"}},
    {"OpenGL and EGL", {"GL/*", "EGL/*", "KHR/*"}, {"render/*", "app/window/*"}},
    {"POSIX",
     {"unistd.h", "fcntl.h", "sys/*", "signal.h", "csignal", "dlfcn.h", "spawn.h"},
     {"core/system*.cpp"}},
    {"CUDA",
     {"cuda*", "cub/*", "thrust/*", "cooperative_groups*"},
     {"device/*", "*.cu", "render/*interop*"}},
};

bool matchesAny(const std::string& text, const std::vector<const char*>& patterns) {
    return std::any_of(patterns.begin(), patterns.end(),
                       [&](const char* pattern) { return fnmatch(pattern, text.c_str(), 0) == 0; });
}

// `"sim/particles/view.h"` or `<cmath>`, with its first quote; "" for a line that includes nothing.
std::string included(const std::string& line) {
    std::istringstream words(line);
    std::string word;
    char hash = 0;
    if (!(words >> hash >> word) || hash != '#' || !word.starts_with("include")) return "";
    const size_t begin = line.find_first_of("\"<"), end = line.find_first_of("\">", begin + 1);
    return begin == std::string::npos || end == std::string::npos ? ""
                                                                  : line.substr(begin, end - begin);
}

// Why `line` may not stand in `file`; "" when it may.
std::string violation(const std::string& file, const std::string& line) {
    const std::string quoted = included(line);
    if (quoted.empty()) return "";
    const std::string header = quoted.substr(1);
    for (const LibraryRule& rule : LibraryRules)
        if (matchesAny(header, rule.headers) && !matchesAny(file, rule.allowed))
            return std::string(rule.name) + " headers are not for this folder";
    if (quoted[0] == '<') return "";
    const std::string from = file == "main.cpp" ? "app" : file.substr(0, file.find('/'));
    const std::string to = header.substr(0, header.find('/'));
    if (!MayInclude.contains(to)) return "name the file from source/ on: \"folder/file.h\"";
    if (!MayInclude.contains(from)) return "source/" + from + " is a folder without a rule";
    return MayInclude.at(from).contains(to) ? "" : from + " may not include " + to;
}

std::vector<std::string> linesOf(const fs::path& path) {
    std::vector<std::string> lines;
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::vector<fs::path> filesBelow(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
}

TEST(Structure, CheckerFindsViolations) {
    for (const auto& [file, line] : std::vector<std::pair<std::string, std::string>>{
             {"core/vec.h", "#include \"scene/scene.h\""},
             {"scene/json.cpp", "#include \"sim/simulation.h\""},
             {"sim/physics/passes.h", "  #  include \"render/renderer.h\"  // why not"},
             {"render/renderer.cpp", "#include \"sim/simulation.h\""},
             {"measure/health.cpp", "#include \"app/frame.h\""},
             {"device/omp.h", "#include \"scene/scene.h\""},
             {"sim/physics/passes.h", "#include \"view.h\""},
             {"sim/physics/passes.h", "#include\"app/frame.h\""},
             {"extra/new.h", "#include \"core/vec.h\""},
             {"app/frame.cpp", "#include <SDL.h>"},
             {"app/headless.cpp", "#include <EGL/egl.h>"},
             {"sim/particles/view.h", "#include <GL/glew.h>"},
             {"render/font.cpp", "#include <imgui.h>"},
             {"app/panel.cpp", "#include <backends/imgui_impl_sdl.h>"},
             {"sim/particles/view.h", "#include <cuda_runtime.h>"},
             {"render/renderer.cpp", "#include <cuda_gl_interop.h>"}})
        EXPECT_NE(violation(file, line), "") << file << ": " << line;
}

TEST(Structure, CheckerLetsTheRestPass) {
    for (const auto& [file, line] : std::vector<std::pair<std::string, std::string>>{
             {"sim/physics/passes.h", "#include \"core/vec.h\""},
             {"sim/physics/passes.h", "// #include \"render/renderer.h\""},
             {"main.cpp", "#include \"app/command_line.h\""},
             {"app/window/window.cpp", "#include <SDL.h>"},
             {"render/gl.h", "#include <GL/glew.h>"},
             {"device/cuda.h", "#include <cuda_runtime.h>"},
             {"sim/simulation_cuda.cu", "#include <cub/cub.cuh>"},
             {"render/cuda_interop.cpp", "#include <cuda_gl_interop.h>"},
             {"core/vec.h", "#include <cmath>"}})
        EXPECT_EQ(violation(file, line), "") << file << ": " << line;
}

TEST(Structure, IncludesKeepTheRules) {
    int includes = 0;
    for (const fs::path& path : filesBelow(Source)) {
        const std::string file = fs::relative(path, Source).string();
        for (const std::string& line : linesOf(path)) {
            includes += line.starts_with("#include");
            EXPECT_EQ(violation(file, line), "") << "source/" << file << ": " << line;
        }
    }
    EXPECT_GT(includes, 100) << "found too few includes to believe it";
}

TEST(Structure, EverySourceFileIsInOneList) {
    std::map<fs::path, int> listed;
    for (const fs::path& top : {Source, Root / "tests"})
        for (const fs::path& list : filesBelow(top))
            if (list.filename().string().ends_with("sources.txt"))
                for (const std::string& name : linesOf(list))
                    ++listed[(list.parent_path() / name).lexically_normal()];
    for (const auto& [path, times] : listed) {
        EXPECT_TRUE(fs::exists(path)) << path;
        EXPECT_EQ(times, 1) << path;
    }
    for (const fs::path& path : filesBelow(Source)) {
        const bool compiled = path.extension() == ".cpp" || path.extension() == ".cu";
        EXPECT_TRUE(!compiled || path == Source / "main.cpp" || listed.contains(path))
            << path << " is in no sources.txt";
    }
    for (const fs::path& path : filesBelow(Root / "tests")) {
        const bool test = path.filename().string().ends_with("_test.cpp");
        EXPECT_TRUE(!test || listed.contains(path))
            << path << " is in no sources.txt: it never runs";
    }
}

// In characters, of which UTF-8 has several bytes.
size_t widthOf(const std::string& line) {
    return size_t(
        std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

// Calls f(path, lines) for each file of C++ or CUDA below a folder.
template <class F> void forCode(const fs::path& top, const F& f) {
    for (const fs::path& path : filesBelow(top)) {
        const std::string kind = path.extension().string();
        if (kind == ".cpp" || kind == ".h" || kind == ".cu") f(path, linesOf(path));
    }
}

TEST(Structure, LinesFitIntoAHundredColumns) {
    EXPECT_EQ(widthOf("m/s²"), 4u);
    for (const fs::path& top : {Source, Root / "tests", Root / "examples"})
        forCode(top, [](const fs::path& path, const std::vector<std::string>& lines) {
            for (size_t k = 0; k < lines.size(); ++k)
                EXPECT_LE(widthOf(lines[k]), 100u) << path << ":" << k + 1;
        });
}

// Those of the simulation above all.
TEST(Structure, FilesAreShort) {
    int files = 0;
    for (const fs::path& top : {Source, Root / "tests"})
        forCode(top, [&](const fs::path& path, const std::vector<std::string>& lines) {
            const std::string name = path.lexically_relative(Root).string();
            const bool isOfSimulation = name.starts_with("source/sim/");
            files += isOfSimulation;
            EXPECT_LE(lines.size(), isOfSimulation ? 350u : 500u) << name << ": split it";
        });
    EXPECT_GT(files, 40);
}

// Lines of the function that begins with line `k`, as clang-format breaks them; 0: none does.
size_t functionLength(const std::vector<std::string>& lines, size_t k) {
    const std::string& line = lines[k];
    const size_t indent = line.find_first_not_of(' ');
    if (indent == std::string::npos || !line.ends_with("{") || line.find(')') == std::string::npos)
        return 0;
    static const std::regex other(
        R"(^\s*(if|for|while|switch|else|do|try|return|case|\}|namespace|struct|class|enum)"
        R"(|union).*)"
        R"(|.*\[[^\]]*\]\(.*|.*LANE_CALL.*)");
    if (std::regex_match(line, other)) return 0;
    for (size_t end = k + 1; end < lines.size(); ++end) {
        if (lines[end].starts_with(std::string(indent, ' ') + "}")) return end - k + 1;
        if (lines[end].find_first_not_of(' ') < indent) return 0;
    }
    return 0;
}

// But for tables: of knobs, of validation cases, of tortures.
TEST(Structure, FunctionsAreShort) {
    EXPECT_EQ(functionLength({"int f(int a) {", "    return a;", "}"}, 0), 3u);
    EXPECT_EQ(functionLength({"    if (a) {", "    }"}, 0), 0u);
    const std::set<std::string> tables = {"scene/schema.h", "scene/list_knobs.h",
                                          "measure/validation.cpp"};
    int functions = 0;
    forCode(Source, [&](const fs::path& path, const std::vector<std::string>& lines) {
        const std::string name = path.lexically_relative(Source).string();
        for (size_t k = 0; k < lines.size() && !tables.contains(name); ++k) {
            const size_t length = functionLength(lines, k);
            functions += length > 0;
            const bool table = lines[k].starts_with("std::vector<StressCase> tortures(");
            EXPECT_LE(length, table ? 80u : 60u) << name << ":" << k + 1 << ": split it";
        }
    });
    EXPECT_GT(functions, 1000) << "found too few functions to believe it";
}

// All that the expression's first group matches in a text.
std::vector<std::string> matchesOf(const std::string& text, const char* expression) {
    const std::regex pattern(expression);
    std::vector<std::string> found;
    for (std::sregex_iterator m(text.begin(), text.end(), pattern), end; m != end; ++m)
        found.push_back((*m)[1]);
    return found;
}

// Links go from the page's folder, names of files from the root or from source/.
TEST(Structure, PagesNameFilesThatExist) {
    std::vector<fs::path> pages = {Root / "README.md"};
    for (const fs::path& path : filesBelow(Root / "docs"))
        if (path.extension() == ".md") pages.push_back(path);
    size_t links = 0, names = 0;
    for (const fs::path& page : pages) {
        std::string text;
        for (const std::string& line : linesOf(page)) text += line + "\n";
        for (const std::string& link : matchesOf(text, R"(\]\(([^)#:]+)[)#])")) {
            ++links;
            EXPECT_TRUE(fs::exists(page.parent_path() / link)) << page << " links to " << link;
        }
        for (const std::string& name : matchesOf(text, R"(`((?:\w+/)+\w+\.\w+)`)")) {
            ++names;
            EXPECT_TRUE(fs::exists(Root / name) || fs::exists(Source / name))
                << page << " names " << name;
        }
    }
    EXPECT_GT(links, 100u) << "found too few links to believe it";
    EXPECT_GT(names, 100u) << "found too few names to believe it";
}

// tests/unit/FOLDER tests what source/FOLDER has: each file names what it is about.
TEST(Structure, UnitTestsMirrorTheSources) {
    for (const auto& [folder, unused] : MayInclude) {
        if (folder == "app") continue;  // tests/app runs the whole program
        EXPECT_TRUE(fs::is_directory(Root / "tests/unit" / folder))
            << folder << " has no unit test";
        for (const fs::path& path : filesBelow(Root / "tests/unit" / folder)) {
            const auto lines = linesOf(path);
            EXPECT_TRUE(std::any_of(lines.begin(), lines.end(),
                                    [&](const std::string& line) {
                                        return included(line).starts_with("\"" + folder + "/");
                                    }))
                << path << " includes nothing of source/" << folder;
        }
    }
    for (const auto& entry : fs::directory_iterator(Root / "tests/unit"))
        EXPECT_TRUE(!entry.is_directory() || MayInclude.contains(entry.path().filename().string()))
            << entry.path() << " mirrors no folder";
}

}  // namespace
}  // namespace spindrift
