#pragma once
// Moments of a run as files that other programs read: points with their values, and triangles.
#include "core/vec.h"

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace spindrift {

// A value of each point; of vectors the components of a point stand together.
struct PointField {
    std::string name, unit;
    int components = 1;
    std::variant<std::vector<float>, std::vector<int32_t>> values;
};

// What is drawn and coloured together: particles, or a surface when there are triangles.
struct Piece {
    std::string name;           // of its files: fluid, solids, objects
    std::vector<Vec3d> points;  // m, world coordinates
    std::vector<PointField> fields;
    std::vector<std::array<int32_t, 3>> triangles;
};

// Where one piece of one moment is.
struct MomentFile {
    double time = 0;         // s
    std::string name, file;  // of the piece; relative to the index
    size_t points = 0, triangles = 0;
    std::vector<std::pair<std::string, int>> fields;  // name, components; negative: integers
};

// How a series is written: an index, if there is one, and a file for each piece of each moment.
//     .pvd    index of .vtp files: VTK's XML, ParaView
//     .xdmf   index of .h5 files: HDF5, ParaView and VisIt
//     .ply    no index; binary
//     .csv    no index; particles alone, with the names that bodies of shape file know
class MomentFormat {
public:
    // Throws Error (Output) for any other extension.
    explicit MomentFormat(const std::string& path);

    // Of the files of the moments.
    const std::string& extension() const { return extension_; }
    bool takesTriangles() const { return extension_ != ".csv"; }
    // Throws Error (Output).
    void write(const std::string& file, const Piece&) const;
    // The whole index; "" where there is none. Entries of a moment follow each other.
    std::string index(const std::vector<MomentFile>&) const;

private:
    std::string extension_;
};

}  // namespace spindrift
