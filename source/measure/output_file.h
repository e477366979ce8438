#pragma once
// Files that are there whole or not at all.
#include "sim/simulation.h"

#include <functional>
#include <string>

namespace spindrift {

// Refuses a path that a file can't be written to: its folder is missing or read-only, or it is a
// folder itself. Leaves nothing behind. Throws Error(Exit::Output).
void requireWritable(const std::string& path);

// Makes the folder when it is missing and refuses one that can't be written to. Throws
// Error(Exit::Output).
void requireFolder(const std::string& path);

// Lets `write` make a file beside its target, flushes that to the disk and renames it; write(temporary) returns whether all
// of it was written. Throws Error(Exit::Output), and leaves what was there before.
void replaceFile(const std::string& path, const std::function<bool(const std::string& temporary)>& write);

// Writes text beside its target and renames it; "-" is standard output. Throws Error(Exit::Output).
void writeText(const std::string& path, const std::string& text);

// Particles as a table that a body of shape file can be: HDF5 when the path ends in .h5, else CSV; world coordinates, all digits. Throws
// Error(Exit::Output).
void saveParticles(const std::string& path, const std::vector<Particle>&);

}  // namespace spindrift
