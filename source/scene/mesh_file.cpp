// Files of triangles and polygons -> meshes.
#include "core/error.h"
#include "scene/mesh.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <mutex>
#include <string_view>

namespace spindrift {
namespace {

constexpr size_t LargestFile = 512 << 20, MostTriangles = 5'000'000;
constexpr double Farthest = 1e9;  // that a coordinate may lie from 0

[[noreturn]] void refuse(const std::string& path, const std::string& what) {
    throw Error(Failure::Scene, fmt::format("{}: {}", path, what));
}

// What a file says.
struct Polygons {
    std::vector<Vec3d> vertices;
    std::vector<std::vector<int>> faces;
    double roundOff = 0;  // how wrong coordinates may be
};

// Cuts corners off a polygon, which may be concave, until a triangle is left (ear clipping,
// Meisters 1975); those of a convex one make a fan.
class EarClipper {
public:
    EarClipper(const std::vector<Vec3d>& vertices, std::vector<int> corners)
        : vertices_(vertices), corners_(std::move(corners)) {
        for (size_t k = 0; k < corners_.size(); ++k)
            normal_ = normal_ + cross(at(k) - at(0), at(k + 1) - at(0));
    }
    void cut(std::vector<Mesh::Triangle>& out) {
        while (corners_.size() > 3) {
            const size_t ear = findEar(), n = corners_.size();
            out.push_back({corners_[(ear + n - 1) % n], corners_[ear], corners_[(ear + 1) % n]});
            corners_.erase(corners_.begin() + long(ear));
        }
        out.push_back({corners_[0], corners_[1], corners_[2]});
    }

private:
    Vec3d at(size_t k) const { return vertices_[size_t(corners_[k % corners_.size()])]; }
    double turn(Vec3d a, Vec3d b, Vec3d c) const { return dot(normal_, cross(b - a, c - a)); }
    size_t findEar() const {
        const size_t n = corners_.size();
        for (size_t i = 1; i <= n; ++i)
            if (isEar(i % n)) return i % n;
        return 1;
    }
    bool isEar(size_t ear) const {
        const size_t n = corners_.size();
        const Vec3d a = at(ear + n - 1), b = at(ear), c = at(ear + 1);
        if (turn(a, b, c) < 0) return false;
        for (size_t k = 0; k < n; ++k) {
            const Vec3d p = at(k);
            if (p == a || p == b || p == c) continue;
            if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
        }
        return true;
    }

    const std::vector<Vec3d>& vertices_;
    std::vector<int> corners_;
    Vec3d normal_;
};

// The lines of an OBJ file, one after the other: v and f; all else is passed over. In double
// precision, for coordinates of a survey are far from 0.
class ObjReader {
public:
    explicit ObjReader(const std::string& path) : path_(path) {}
    Polygons read() {
        std::ifstream stream(path_, std::ios::binary);
        for (std::string line; std::getline(stream, line);) {
            constexpr std::string_view ByteOrderMark = "\xEF\xBB\xBF";
            readLine(++line_ == 1 && line.starts_with(ByteOrderMark)
                         ? std::string_view(line).substr(ByteOrderMark.size())
                         : line);
        }
        return std::move(polygons_);
    }

private:
    [[noreturn]] void fail(const std::string& what) const {
        refuse(path_, fmt::format("line {}: {}", line_, what));
    }
    void readLine(std::string_view line) {
        const std::string_view kind = takeWord(line);
        if (kind == "v") readVertex(line);
        if (kind == "f") readFace(line);
    }
    static std::string_view takeWord(std::string_view& line) {
        constexpr const char* Blank = " \t\r";
        const size_t begin = std::min(line.find_first_not_of(Blank), line.size()),
                     end = std::min(line.find_first_of(Blank, begin), line.size());
        const std::string_view word = line.substr(begin, end - begin);
        line.remove_prefix(end);
        return word;
    }
    template <class T> static bool parse(std::string_view word, T& value) {
        if (word.starts_with('+')) word.remove_prefix(1);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc() && end == word.data() + word.size();
    }
    static std::string brief(std::string_view word) { return std::string(word.substr(0, 40)); }
    void readVertex(std::string_view line) {
        Vec3d p;
        for (int k = 0; k < 3; ++k) {
            const std::string_view word = takeWord(line);
            if (!parse(word, p[k]) || !std::isfinite(p[k]))
                fail(fmt::format("{} = \"{}\" is no number; a vertex is v x y z", "xyz"[k],
                                 brief(word)));
            if (std::abs(p[k]) > Farthest)
                fail(fmt::format("{} = {:g} is farther than {:g} from 0; move or scale it",
                                 "xyz"[k], p[k], Farthest));
        }
        polygons_.vertices.push_back(p);
    }
    // v, v/vt, v//vn or v/vt/vn; from 1 on, or from the last one backward.
    int readCorner(std::string_view word) const {
        int64_t index = 0;
        const auto count = int64_t(polygons_.vertices.size());
        if (!parse(word.substr(0, word.find('/')), index) || index == 0)
            fail(fmt::format("\"{}\" is no corner of a face; give vertex numbers from 1 on",
                             brief(word)));
        if (index > count || index < -count)
            fail(fmt::format("vertex {} of {} that are there so far; mend the face", index, count));
        return int(index > 0 ? index - 1 : count + index);
    }
    void readFace(std::string_view line) {
        std::vector<int> corners;
        for (std::string_view word = takeWord(line); !word.empty(); word = takeWord(line))
            corners.push_back(readCorner(word));
        if (corners.size() < 3)
            fail(fmt::format("a face of {} corners; it needs three", corners.size()));
        polygons_.faces.push_back(std::move(corners));
    }

    const std::string& path_;
    int line_ = 0;
    Polygons polygons_;
};

// The faces of a node and those below it, each placed as its node says.
void addNode(const std::string& path, const aiScene& scene, const aiNode& node, aiMatrix4x4 above,
             Polygons& out) {
    const aiMatrix4x4 place = above * node.mTransformation;
    for (unsigned m = 0; m < node.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
        const int first = int(out.vertices.size());
        for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
            const aiVector3D p = place * mesh.mVertices[v];
            if (!std::isfinite(p.x + p.y + p.z))
                refuse(path,
                       fmt::format("vertex {} has a coordinate that is no number; mend it", v));
            out.vertices.push_back({p.x, p.y, p.z});
        }
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            std::vector<int> corners;
            for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k)
                corners.push_back(first + int(mesh.mFaces[f].mIndices[k]));
            if (corners.size() > 2) out.faces.push_back(std::move(corners));
        }
    }
    for (unsigned c = 0; c < node.mNumChildren; ++c)
        addNode(path, scene, *node.mChildren[c], place, out);
}

// In single precision, which leaves too little of what is small and far from 0.
Polygons readByAssimp(const std::string& path) {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path, 0);
    if (!scene) refuse(path, fmt::format("can't be read: {}", importer.GetErrorString()));
    Polygons out;
    if (scene->mRootNode) addNode(path, *scene, *scene->mRootNode, aiMatrix4x4(), out);
    if (out.vertices.empty()) return out;
    Vec3d low = out.vertices[0], high = low;
    for (const Vec3d& p : out.vertices) low = lower(low, p), high = upper(high, p);
    const double far = std::max(length(low), length(high)), size = length(high - low);
    constexpr double MostSizes = 1000;
    out.roundOff = far * double(std::numeric_limits<float>::epsilon());
    if (far > MostSizes * size)
        refuse(path, fmt::format("is {:.3g} large and lies {:.3g} from 0, too far for the single "
                                 "precision in which its kind of file is read; move it to 0, or "
                                 "save it as OBJ",
                                 size, far));
    return out;
}

Polygons readPolygons(const std::string& path) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(path, none) || !std::ifstream(path))
        refuse(path, "can't be read; check the path");
    if (std::filesystem::file_size(path, none) > LargestFile)
        refuse(path, "is larger than 512 MiB; simplify the surface");
    std::string kind = std::filesystem::path(path).extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (kind == ".obj") return ObjReader(path).read();
    const char* known[] = {".stl", ".ply", ".gltf", ".glb"};
    if (std::none_of(std::begin(known), std::end(known), [&](const char* k) { return kind == k; }))
        refuse(path, "is of no kind that is known; name an .obj, .stl, .ply, .gltf or .glb file");
    return readByAssimp(path);
}

Mesh meshOf(const std::string& path) {
    const Polygons polygons = readPolygons(path);
    std::vector<Mesh::Triangle> triangles;
    for (const std::vector<int>& face : polygons.faces) {
        if (triangles.size() + face.size() > MostTriangles)
            refuse(path,
                   fmt::format("more than {} triangles; simplify the surface", MostTriangles));
        EarClipper(polygons.vertices, face).cut(triangles);
    }
    return Mesh(path, polygons.vertices, triangles, polygons.roundOff);
}

}  // namespace

std::shared_ptr<const Mesh> readMesh(const std::string& path) {
    struct Known {
        std::filesystem::file_time_type time;
        uintmax_t size;
        std::shared_ptr<const Mesh> mesh;
    };
    static std::mutex mutex;
    static std::map<std::string, Known> known;
    if (path.empty()) refuse("\"\"", "no file is named; give its path");
    const std::lock_guard lock(mutex);
    std::error_code none, gone;
    const auto time = std::filesystem::last_write_time(path, none);
    const uintmax_t size = std::filesystem::file_size(path, gone);
    Known& k = known[path];
    // A run goes on when the file is gone.
    if (k.mesh && (none || gone || (k.time == time && k.size == size))) return k.mesh;
    k = {time, size, std::make_shared<const Mesh>(meshOf(path))};
    return k.mesh;
}

}  // namespace spindrift
