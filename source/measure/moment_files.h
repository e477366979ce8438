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

// Where one piece of a moment is, and what is in it.
struct PieceFile {
    std::string name, file;  // of the piece; relative to the index
    size_t points = 0, triangles = 0;
    std::vector<std::pair<std::string, int>> fields;  // name, components; negative: integers
};
// What an index says of a moment.
struct IndexEntry {
    double time = 0;  // s
    std::string text;
};

// How a series is written: an index, if there is one, and a file for each piece of each moment.
//     .pvd    index of .vtp files: VTK's XML, ParaView
//     .xdmf   index of .h5 files: HDF5, ParaView and VisIt
//     .ply    no index; binary
//     .csv    no index; particles alone, with the names that bodies of shape file know
class MomentFormat {
public:
    // Throws Error (Output) for any other extension, and for a name that its readers can't take.
    explicit MomentFormat(const std::string& path);

    // Of the files of the moments.
    const std::string& extension() const { return extension_; }
    bool takesTriangles() const { return extension_ != ".csv"; }
    // Throws Error (Output).
    void write(const std::string& file, const Piece&) const;
    bool hasIndex() const { return extension_ == ".vtp" || extension_ == ".h5"; }
    IndexEntry entry(double time, const std::vector<PieceFile>&) const;
    // The whole index.
    std::string index(const std::vector<IndexEntry>&) const;
    // What is in an index that was written before; nothing where there is none, or another
    // program's.
    std::vector<IndexEntry> readIndex(const std::string& path) const;

private:
    std::string extension_;
};

}  // namespace spindrift
