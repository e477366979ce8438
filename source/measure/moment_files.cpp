#include "measure/moment_files.h"

#include "core/error.h"
#include "core/hdf5_file.h"
#include "core/output_file.h"

#include <fmt/format.h>

#include <bit>
#include <cstdlib>
#include <cstring>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace spindrift {
namespace {

static_assert(std::endian::native == std::endian::little, "files say so");

using Triangle = std::array<int32_t, 3>;

bool isInteger(const PointField& f) {
    return std::holds_alternative<std::vector<int32_t>>(f.values);
}
// The bytes of a field.
std::pair<const void*, size_t> bytesOf(const PointField& f) {
    return std::visit(
        [](const auto& v) {
            return std::pair<const void*, size_t>(v.data(), v.size() * sizeof(v[0]));
        },
        f.values);
}
std::string nameOf(const PointField& f) {
    return f.unit.empty() ? f.name : fmt::format("{} [{}]", f.name, f.unit);
}

// --- VTK's XML, all numbers behind it as they are in memory ---

class VtkArrays {
public:
    void add(std::string& xml, const std::string& name, const char* type, int components,
             const void* data, size_t bytes) {
        xml += fmt::format(
            "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" "
            "offset=\"{}\"/>\n",
            type, name, components, size_);
        arrays_.push_back({data, bytes});
        size_ += bytes + sizeof(uint64_t);
    }
    void write(std::ofstream& out) const {
        for (const auto& [data, bytes] : arrays_) {
            const uint64_t size = bytes;
            out.write(reinterpret_cast<const char*>(&size), sizeof(size));
            out.write(static_cast<const char*>(data), std::streamsize(bytes));
        }
    }

private:
    std::vector<std::pair<const void*, size_t>> arrays_;
    uint64_t size_ = 0;
};

// Points are cells of their own, or nothing would be drawn.
bool writeVtp(const std::string& path, const Piece& piece) {
    const size_t n = piece.points.size(), t = piece.triangles.size(), cells = t > 0 ? t : n;
    std::vector<int32_t> ends(cells), own(t > 0 ? 0 : n);
    for (size_t k = 0; k < cells; ++k) ends[k] = int32_t((t > 0 ? 3 : 1) * (k + 1));
    for (size_t k = 0; k < own.size(); ++k) own[k] = int32_t(k);
    VtkArrays arrays;
    std::string xml = fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
        "header_type=\"UInt64\">\n<PolyData>\n"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfPolys=\"{}\">\n<PointData>\n",
        n, own.size(), t);
    for (const PointField& f : piece.fields) {
        const auto [data, bytes] = bytesOf(f);
        arrays.add(xml, nameOf(f), isInteger(f) ? "Int32" : "Float32", f.components, data, bytes);
    }
    xml += "</PointData>\n<Points>\n";
    arrays.add(xml, "points", "Float64", 3, piece.points.data(), n * sizeof(Vec3d));
    xml += fmt::format("</Points>\n<{}>\n", t > 0 ? "Polys" : "Verts");
    arrays.add(xml, "connectivity", "Int32", 1,
               t > 0 ? static_cast<const void*>(piece.triangles.data()) : own.data(),
               t > 0 ? t * sizeof(Triangle) : own.size() * sizeof(int32_t));
    arrays.add(xml, "offsets", "Int32", 1, ends.data(), cells * sizeof(int32_t));
    xml += fmt::format("</{}>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
                       t > 0 ? "Polys" : "Verts");
    std::ofstream out(path, std::ios::binary);
    out << xml;
    arrays.write(out);
    out << "\n</AppendedData>\n</VTKFile>\n";
    return bool(out.flush());
}

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text)
        safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    return safe;
}

std::string pvdEntry(double time, const std::vector<PieceFile>& pieces) {
    std::string xml;
    for (size_t k = 0; k < pieces.size(); ++k)
        xml += fmt::format("<DataSet timestep=\"{}\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n", time,
                           k, pieces[k].name, escaped(pieces[k].file));
    return xml;
}

// --- HDF5, and the XDMF that says what is in it ---

bool writeHdf5(const std::string& path, const Piece& piece) {
    return hdf5::writeFile(path, [&](hid_t file) {
        hdf5::writeArray(file, "points", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, piece.points.data(),
                         {piece.points.size(), 3});
        hdf5::writeUnit(file, "points", "m");
        if (!piece.triangles.empty())
            hdf5::writeArray(file, "triangles", H5T_STD_I32LE, H5T_NATIVE_INT32,
                             piece.triangles.data(), {piece.triangles.size(), 3});
        for (const PointField& f : piece.fields) {
            std::vector<hsize_t> size{piece.points.size()};
            if (f.components > 1) size.push_back(hsize_t(f.components));
            hdf5::writeArray(file, f.name, isInteger(f) ? H5T_STD_I32LE : H5T_IEEE_F32LE,
                             isInteger(f) ? H5T_NATIVE_INT32 : H5T_NATIVE_FLOAT, bytesOf(f).first,
                             size);
            hdf5::writeUnit(file, f.name, f.unit);
        }
    });
}

std::string xdmfArray(const PieceFile& m, const std::string& name, size_t count, int components,
                      bool integer, int precision) {
    return fmt::format(
        "<DataItem Format=\"HDF\" NumberType=\"{}\" Precision=\"{}\" Dimensions=\"{}{}\">"
        "{}:/{}</DataItem>\n",
        integer ? "Int" : "Float", precision, count,
        components > 1 ? fmt::format(" {}", components) : "", escaped(m.file), name);
}

std::string xdmfGrid(const PieceFile& m) {
    std::string xml = fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n", m.name);
    if (m.triangles > 0)
        xml += fmt::format(
            "<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">\n{}</Topology>\n",
            m.triangles, xdmfArray(m, "triangles", m.triangles, 3, true, 4));
    else
        xml += fmt::format(
            "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" "
            "NodesPerElement=\"1\"/>\n",
            m.points);
    xml += "<Geometry GeometryType=\"XYZ\">\n" + xdmfArray(m, "points", m.points, 3, false, 8) +
           "</Geometry>\n";
    for (const auto& [name, components] : m.fields) {
        const int count = std::abs(components);
        xml += fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n{}", name,
                           count > 1 ? "Vector" : "Scalar",
                           xdmfArray(m, name, m.points, count, components < 0, 4)) +
               "</Attribute>\n";
    }
    return xml + "</Grid>\n";
}

std::string xdmfEntry(double time, const std::vector<PieceFile>& pieces) {
    std::string xml = fmt::format(
        "<Grid Name=\"moment\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
        "<Time Value=\"{}\"/>\n",
        time);
    for (const PieceFile& piece : pieces) xml += xdmfGrid(piece);
    return xml + "</Grid>\n";
}

// --- tables of points ---

// A field's columns: those of bodies of shape file, and others by their own names.
std::vector<std::string> columnsOf(const PointField& f) {
    const std::string known = f.name == "velocity"       ? "v"
                              : f.name == "acceleration" ? "a"
                              : f.name == "density"      ? "rho"
                              : f.name == "pressure"     ? "p"
                                                         : f.name;
    if (f.components == 1) return {known};
    return {known + "x", known + "y", known + "z"};
}

bool writePly(const std::string& path, const Piece& piece) {
    const size_t n = piece.points.size();
    std::string header = fmt::format(
        "ply\nformat binary_little_endian 1.0\ncomment written by Spindrift, SI units\n"
        "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n",
        n);
    for (const PointField& f : piece.fields)
        for (const std::string& column : columnsOf(f))
            header += fmt::format("property {} {}\n", isInteger(f) ? "int" : "float", column);
    if (!piece.triangles.empty())
        header += fmt::format("element face {}\nproperty list uchar int vertex_indices\n",
                              piece.triangles.size());
    std::string body;
    const auto append = [&](const void* data, size_t bytes) {
        body.append(static_cast<const char*>(data), bytes);
    };
    for (size_t i = 0; i < n; ++i) {
        append(&piece.points[i], sizeof(Vec3d));
        for (const PointField& f : piece.fields) {
            const size_t bytes = 4 * size_t(f.components);  // of floats and integers alike
            append(static_cast<const char*>(bytesOf(f).first) + i * bytes, bytes);
        }
    }
    for (const Triangle& t : piece.triangles) body += '\3', append(&t, sizeof(t));
    std::ofstream out(path, std::ios::binary);
    out << header << "end_header\n" << body;
    return bool(out.flush());
}

bool writeCsv(const std::string& path, const Piece& piece) {
    std::string text = "x [m],y [m],z [m]";
    std::vector<const PointField*> fields;
    for (const PointField& f : piece.fields) {
        if (f.name == "id") continue;  // is the number of the row
        fields.push_back(&f);
        for (const std::string& column : columnsOf(f))
            text += "," + column + (f.unit.empty() ? "" : fmt::format(" [{}]", f.unit));
    }
    text += '\n';
    const auto out = std::back_inserter(text);
    for (size_t i = 0; i < piece.points.size(); ++i) {
        const Vec3d p = piece.points[i];
        fmt::format_to(out, "{},{},{}", p.x, p.y, p.z);
        for (const PointField* f : fields)
            std::visit(
                [&](const auto& v) {
                    const size_t n = size_t(f->components);
                    for (size_t c = 0; c < n; ++c) fmt::format_to(out, ",{}", v[n * i + c]);
                },
                f->values);
        text += '\n';
    }
    std::ofstream file(path, std::ios::binary);
    file << text;
    return bool(file.flush());
}

// Of an index: what stands before its moments and after them, where a moment begins, and what its
// time stands behind.
struct Index {
    const char *head, *tail, *begin, *time;
    std::string (*entry)(double time, const std::vector<PieceFile>&);
};
constexpr Index Pvd = {
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
    "</Collection>\n</VTKFile>\n", "<DataSet ", "timestep=\"", pvdEntry};
constexpr Index Xdmf = {
    "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n"
    "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
    "</Grid>\n</Domain>\n</Xdmf>\n", "<Grid Name=\"moment\"", "<Time Value=\"", xdmfEntry};

struct Kind {
    const char *index, *extension;
    bool (*write)(const std::string&, const Piece&);
    const Index* in = nullptr;
};
constexpr Kind Kinds[] = {{".pvd", ".vtp", writeVtp, &Pvd},
                          {".xdmf", ".h5", writeHdf5, &Xdmf},
                          {".ply", ".ply", writePly},
                          {".csv", ".csv", writeCsv}};

const Kind& kindOf(const std::string& extension) {
    for (const Kind& k : Kinds)
        if (extension == k.extension) return k;
    CHECK(false);
    return Kinds[0];
}

}  // namespace

MomentFormat::MomentFormat(const std::string& path) {
    const std::string given = std::filesystem::path(path).extension().string();
    for (const Kind& k : Kinds)
        if (given == k.index) extension_ = k.extension;
    if (extension_.empty())
        throw Error(Failure::Output,
                    fmt::format("{}: a series is no \"{}\"; name it .pvd (ParaView), .xdmf (HDF5), "
                                ".ply or .csv",
                                path, given));
    // XDMF says file:dataset.
    if (extension_ == ".h5" && path.find(':') != std::string::npos)
        throw Error(Failure::Output, path + ": an .xdmf can't have a : in its name");
}

void MomentFormat::write(const std::string& file, const Piece& piece) const {
    const Kind& kind = kindOf(extension_);
    replaceFile(file, [&](const std::string& temporary) { return kind.write(temporary, piece); });
}

IndexEntry MomentFormat::entry(double time, const std::vector<PieceFile>& pieces) const {
    const Index* in = kindOf(extension_).in;
    return {time, in ? in->entry(time, pieces) : ""};
}

std::string MomentFormat::index(const std::vector<IndexEntry>& entries) const {
    const Index& in = *kindOf(extension_).in;
    std::string text = in.head;
    for (const IndexEntry& e : entries) text += e.text;
    return text + in.tail;
}

std::vector<IndexEntry> MomentFormat::readIndex(const std::string& path) const {
    const Index* in = kindOf(extension_).in;
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    if (!in || !text.starts_with(in->head) || !text.ends_with(in->tail)) return {};
    std::vector<IndexEntry> entries;
    const size_t end = text.size() - std::strlen(in->tail);
    for (size_t at = std::strlen(in->head); at < end;) {
        const size_t next = std::min(text.find(in->begin, at + 1), end),
                     time = text.find(in->time, at);
        if (time >= next) return {};
        const double seconds = std::strtod(text.c_str() + time + std::strlen(in->time), nullptr);
        // Pieces of a moment may each begin anew.
        if (entries.empty() || entries.back().time != seconds) entries.push_back({seconds, ""});
        entries.back().text += text.substr(at, next - at);
        at = next;
    }
    return entries;
}

}  // namespace spindrift
