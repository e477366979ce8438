#pragma once
#include "render/gl.h"

#include <string>

namespace spindrift {

// Compiles shaders/NAME.vert and NAME.frag; frame.glsl, the values that all shaders share, comes
// first in both. The folder is $SPINDRIFT_SHADERS, or the one known when the program was built.
// Throws Error (NoDisplay) with the file's name and the compiler's words.
// `defines`: lines that stand before everything.
GlProgram loadProgram(const std::string& name, const std::string& defines = "");
// The same with whole.vert: NAME.frag for every pixel of what is drawn into, by three vertices.
GlProgram loadFilter(const std::string& name, const std::string& defines = "");

}  // namespace spindrift
