#include "render/shader.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace spindrift {

namespace {

std::string pathOf(const std::string& file) {
    const char* folder = std::getenv("SPINDRIFT_SHADERS");
    return std::string(folder && *folder ? folder : SPINDRIFT_SHADERS) + "/" + file;
}

std::string read(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        throw Error(Failure::NoDisplay, path +
                                            ": shader not found: set SPINDRIFT_SHADERS to the "
                                            "folder with the shaders");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

// The compiler's first lines; they must fit on one line of ours.
std::string firstWords(std::string log) {
    log = log.substr(0, 300);
    std::replace(log.begin(), log.end(), '\n', ' ');
    return log;
}

// Owns a shader until the program is linked.
struct DeleteShader {
    void operator()(GLuint n) const { glDeleteShader(n); }
};
using GlShader = GlName<DeleteShader>;

GlShader compile(GLenum stage, const std::string& path, const std::string& defines) {
    const std::string shared = read(pathOf("frame.glsl")), own = read(path);
    const char* parts[] = {"#version 450 core\n", defines.c_str(), shared.c_str(), "\n#line 1\n",
                           own.c_str()};
    GlShader shader(glCreateShader(stage));
    glShaderSource(shader, GLsizei(std::size(parts)), parts, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return shader;
    std::array<char, 1024> log{};
    glGetShaderInfoLog(shader, GLsizei(log.size()), nullptr, log.data());
    throw Error(Failure::NoDisplay, path + ": shader doesn't compile: " + firstWords(log.data()));
}

GlProgram link(const std::string& vertices, const std::string& name, const std::string& defines) {
    GlProgram program(glCreateProgram());
    const GlShader vertex = compile(GL_VERTEX_SHADER, pathOf(vertices + ".vert"), defines);
    const GlShader fragment = compile(GL_FRAGMENT_SHADER, pathOf(name + ".frag"), defines);
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good) return program;
    std::array<char, 1024> log{};
    glGetProgramInfoLog(program, GLsizei(log.size()), nullptr, log.data());
    throw Error(Failure::NoDisplay,
                pathOf(name) + ": shaders don't link: " + firstWords(log.data()));
}

}  // namespace

GlProgram loadProgram(const std::string& name, const std::string& defines) {
    return link(name, name, defines);
}
GlProgram loadFilter(const std::string& name, const std::string& defines) {
    return link("whole", name, defines);
}

}  // namespace spindrift
