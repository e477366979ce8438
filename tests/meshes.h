#pragma once
// Surfaces for tests, as the text of files.
#include "core/vec.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace spindrift {

struct Surface {
    std::vector<Vec3d> vertices;
    std::vector<std::vector<int>> faces;  // from 0 on, against the clock seen from outside
    std::string text() const {
        std::ostringstream out;
        out.precision(9);
        for (const Vec3d& p : vertices) out << "v " << p.x << " " << p.y << " " << p.z << "\n";
        for (const auto& face : faces) {
            out << "f";
            for (int v : face) out << " " << v + 1;
            out << "\n";
        }
        return out.str();
    }
    std::string textAsPly() const {
        std::ostringstream out;
        out.precision(9);
        out << "ply\nformat ascii 1.0\nelement vertex " << vertices.size()
            << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
            << faces.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
        for (const Vec3d& p : vertices) out << p.x << " " << p.y << " " << p.z << "\n";
        for (const auto& face : faces) {
            out << face.size();
            for (int v : face) out << " " << v;
            out << "\n";
        }
        return out.str();
    }
    // Of triangles only.
    std::string textAsStl() const {
        std::ostringstream out;
        out.precision(9);
        out << "solid surface\n";
        for (const auto& face : faces) {
            out << "facet normal 0 0 0\nouter loop\n";
            for (int v : face)
                out << "vertex " << vertices[size_t(v)].x << " " << vertices[size_t(v)].y << " "
                    << vertices[size_t(v)].z << "\n";
            out << "endloop\nendfacet\n";
        }
        out << "endsolid surface\n";
        return out.str();
    }
    std::string textAsBinaryStl() const {
        std::string out(80, ' ');
        const auto add = [&](const auto& value) {
            out.append(reinterpret_cast<const char*>(&value), sizeof(value));
        };
        add(uint32_t(faces.size()));
        for (const auto& face : faces) {
            add(Vec3{});
            for (int v : face) add(toFloat(vertices[size_t(v)]));
            add(uint16_t(0));
        }
        return out;
    }
    // glTF 2.0 of triangles, whose bytes are in the text itself, and its binary kind; a node that
    // moves and scales what it holds.
    std::string textAsGltf(Vec3d translation = {0, 0, 0}, double scale = 1) const {
        return gltf("data:application/octet-stream;base64," + inBase64(gltfBytes()), translation,
                    scale);
    }
    std::string textAsGlb() const {
        std::string json = gltf("", {0, 0, 0}, 1), bytes = gltfBytes(), out = "glTF";
        json.resize((json.size() + 3) / 4 * 4, ' '), bytes.resize((bytes.size() + 3) / 4 * 4);
        const auto add = [&](uint32_t value) {
            out.append(reinterpret_cast<const char*>(&value), sizeof(value));
        };
        add(2), add(uint32_t(12 + 8 + json.size() + 8 + bytes.size()));
        add(uint32_t(json.size())), out += "JSON" + json;
        add(uint32_t(bytes.size())), out += std::string("BIN\0", 4) + bytes;
        return out;
    }
    // The path of a file with it.
    std::string write(const std::string& path) const {
        std::ofstream(path) << text();
        return path;
    }
    // Another one beside this one, with corners of its own.
    void add(const Surface& other) {
        const int first = int(vertices.size());
        vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
        for (std::vector<int> face : other.faces) {
            for (int& v : face) v += first;
            faces.push_back(std::move(face));
        }
    }
    // Convex faces as triangles: from a corner, or from a point in the middle.
    Surface inTriangles(bool fromMiddle) const {
        Surface s{vertices, {}};
        for (const auto& face : faces) {
            Vec3d middle;
            for (int v : face) middle = middle + (1.0 / double(face.size())) * vertices[size_t(v)];
            const int at = fromMiddle ? int(s.vertices.size()) : face[0];
            if (fromMiddle) s.vertices.push_back(middle);
            for (size_t k = 0; k < face.size(); ++k)
                if (const int from = face[k], to = face[(k + 1) % face.size()];
                    from != at && to != at)
                    s.faces.push_back({at, from, to});
        }
        return s;
    }
    Surface inverted() const {
        Surface s = *this;
        for (auto& face : s.faces) std::reverse(face.begin(), face.end());
        return s;
    }

private:
    std::string gltfBytes() const {
        std::string out;
        const auto add = [&](const auto& value) {
            out.append(reinterpret_cast<const char*>(&value), sizeof(value));
        };
        for (const Vec3d& p : vertices) add(toFloat(p));
        for (const auto& face : faces)
            for (int v : face) add(uint32_t(v));
        return out;
    }
    std::string gltf(const std::string& uri, Vec3d translation, double scale) const {
        Vec3d low = vertices[0], high = low;
        for (const Vec3d& p : vertices)
            for (int k = 0; k < 3; ++k)
                low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
        std::ostringstream out;
        out.precision(9);
        const auto vector = [&](const char* name, Vec3d v) {
            out << "\"" << name << "\":[" << v.x << "," << v.y << "," << v.z << "]";
        };
        const size_t places = 12 * vertices.size(), indices = 3 * faces.size();
        out << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
               R"("nodes":[{"mesh":0,)";
        vector("translation", translation), out << ",", vector("scale", {scale, scale, scale});
        out << R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
               R"("accessors":[)"
            << R"({"bufferView":0,"componentType":5126,"type":"VEC3","count":)" << vertices.size()
            << ",";
        vector("min", low), out << ",", vector("max", high);
        out << R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" << indices
            << R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":)" << places
            << R"(},{"buffer":0,"byteOffset":)" << places << R"(,"byteLength":)" << 4 * indices
            << R"(}],"buffers":[{"byteLength":)" << places + 4 * indices;
        if (!uri.empty()) out << R"(,"uri":")" << uri << "\"";
        out << "}]}";
        return out.str();
    }
    static std::string inBase64(const std::string& bytes) {
        constexpr const char* Letters =
            "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out;
        for (size_t i = 0; i < bytes.size(); i += 3) {
            uint32_t three = 0;
            for (size_t k = 0; k < 3; ++k)
                three = three << 8 | (i + k < bytes.size() ? uint8_t(bytes[i + k]) : 0u);
            for (size_t k = 0; k < 4; ++k)
                out += i + k > bytes.size() ? '=' : Letters[three >> (18 - 6 * k) & 63];
        }
        return out;
    }
};

inline Surface boxSurface(Vec3d low, Vec3d high) {
    Surface s;
    for (int k = 0; k < 8; ++k)
        s.vertices.push_back(
            {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
    s.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    return s;
}

// One that no block stands for: a corner is pulled in by a ten thousandth of its sides.
inline Surface dentedBoxSurface(Vec3d low, Vec3d high) {
    Surface s = boxSurface(low, high);
    s.vertices[0] = low + 1e-4 * (high - low);
    return s.inTriangles(false);
}

// An icosahedron whose triangles are quartered `times` times and pushed out to a sphere.
inline Surface sphereSurface(Vec3d center, double radius, int times) {
    const double g = std::numbers::phi;
    Surface s;
    s.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                  {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    s.faces = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
               {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
               {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (; times > 0; --times) {
        std::map<std::pair<int, int>, int> middles;
        auto middle = [&](int a, int b) {
            const auto [at, isNew] =
                middles.try_emplace({std::min(a, b), std::max(a, b)}, int(s.vertices.size()));
            if (isNew) s.vertices.push_back(0.5 * (s.vertices[size_t(a)] + s.vertices[size_t(b)]));
            return at->second;
        };
        std::vector<std::vector<int>> quarters;
        for (const auto& f : s.faces) {
            const int ab = middle(f[0], f[1]), bc = middle(f[1], f[2]), ca = middle(f[2], f[0]);
            for (const std::vector<int>& q :
                 {std::vector<int>{f[0], ab, ca}, {ab, f[1], bc}, {ca, bc, f[2]}, {ab, bc, ca}})
                quarters.push_back(q);
        }
        s.faces = quarters;
        for (Vec3d& p : s.vertices) p = normalized(p);
    }
    for (Vec3d& p : s.vertices) p = center + radius * normalized(p);
    return s;
}

// A file for a test to read.
inline std::string meshFile(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + "/" + name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
}
// Of an outline in x and y.
inline Surface prismSurface(const std::vector<Vec3d>& outline, double low, double high) {
    Surface s;
    const int n = int(outline.size());
    std::vector<int> bottom, top;
    for (int k = 0; k < n; ++k) {
        s.vertices.push_back({outline[size_t(k)].x, outline[size_t(k)].y, low}),
            s.vertices.push_back({outline[size_t(k)].x, outline[size_t(k)].y, high});
        const int next = (k + 1) % n;
        s.faces.push_back({2 * k, 2 * next, 2 * next + 1, 2 * k + 1});
        bottom.insert(bottom.begin(), 2 * k), top.push_back(2 * k + 1);
    }
    s.faces.push_back(bottom), s.faces.push_back(top);
    return s;
}
inline Surface several(const std::vector<Surface>& parts) {
    Surface s;
    for (const Surface& part : parts) s.add(part);
    return s;
}
// Solids that are concave, hollow, or touch.
inline std::vector<std::pair<const char*, Surface>> solids() {
    const Surface box = boxSurface({0.2, 0.2, 0.2}, {0.6, 0.5, 0.6});
    const std::vector<Vec3d> L{{0.2, 0.2, 0}, {0.6, 0.2, 0}, {0.6, 0.3, 0},
                               {0.3, 0.3, 0}, {0.3, 0.6, 0}, {0.2, 0.6, 0}};
    return {{"box", box},
            {"L", prismSurface(L, 0.2, 0.6)},
            {"overlapping", several({box, boxSurface({0.413, 0.337, 0.411}, {0.8, 0.437, 0.511})})},
            {"touching", several({box, boxSurface({0.6, 0.2, 0.2}, {0.8, 0.5, 0.6})})},
            {"by an edge", several({box, boxSurface({0.6, 0.5, 0.2}, {0.8, 0.7, 0.6})})},
            {"hollow", several({box, boxSurface({0.3, 0.3, 0.3}, {0.5, 0.4, 0.5})})}};
}

}  // namespace spindrift
