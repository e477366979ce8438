#include "scene/thin_solid.h"

#include "scene/convex.h"

#include <algorithm>
#include <cmath>

namespace spindrift {
namespace {

// m, below which fluid that stands half a spacing off each face would feel each other,
double sightOf(const Scene& scene) {
    return (double(supportRadius(scene)) - double(scene.simulation.spacing)) * (1 - 1e-6);
}
// and the particles of the other face's deepest layer.
double thickEnough(const Scene& scene) {
    return (double(supportRadius(scene)) + double(scene.simulation.spacing)) * (1 - 1e-6);
}

// The axis along which a shape is the thinnest.
int thinAxis(const Scene& scene, Vec3d half) {
    int axis = 0;
    for (int k = 1; k < scene.simulation.dimensions; ++k)
        if (half[k] < half[axis]) axis = k;
    return axis;
}

// Particles of a thin solid, relative to its middle; volumes in units of spacing^dimensions.
class Sides {
public:
    Sides(const Scene& scene, const Solid& solid)
        : scene_(scene),
          solid_(solid),
          shape_(convexOf(solid, scene.simulation.dimensions)),
          dx_(scene.simulation.spacing),
          thickness_(thinness(scene, solid)),
          layers_(boundaryLayers(scene)) {}

    SolidSample sample() {
        if (faceOfPlate(scene_, solid_) >= 0)
            addFaces();
        else
            needsScreen(scene_, solid_) ? addCells() : addTwice();
        SolidSample all;  // those in the solid first
        for (const bool beyond : {false, true})
            for (size_t i = 0; i < out_.positions.size(); ++i) {
                if (bool(out_.beyond[i]) != beyond) continue;
                all.positions.push_back(out_.positions[i]);
                all.volumes.push_back(out_.volumes[i]);
                all.faces.push_back(out_.faces[i]), all.beyond.push_back(out_.beyond[i]);
            }
        return all;
    }

private:
    void add(Vec3d at, double volume, Vec3d face, bool beyond) {
        const Vec3d origin = toDouble(scene_.domain.min), size = scene_.domain.size();
        Vec3d p = shape_.middle - origin + at;
        if (scene_.simulation.dimensions == 2) p.z = 0.5 * size.z;
        for (int k = 0; k < scene_.simulation.dimensions && solid_.isAsDrawn(); ++k)
            if (std::max(-p[k], p[k] - size[k]) > double(supportRadius(scene_))) return;
        out_.positions.push_back(toFloat(p)), out_.volumes.push_back(float(volume));
        out_.faces.push_back(toFloat(face)), out_.beyond.push_back(beyond);
    }

    // Cells of the block's own lattice along an axis, and as many more beside it as are layers.
    struct Cells {
        int count, more;
        double step;
        bool has(int i) const { return i >= 0 && i < count; }
        double at(int i) const { return (i + 0.5 - 0.5 * count) * step; }
    };
    Cells cellsAlong(int axis, Vec3d half) const {
        if (axis == 2 && scene_.simulation.dimensions == 2) return {1, 0, dx_};
        const int count = std::max(1, int(std::round(2 * half[axis] / dx_)));
        // One that spans a periodic axis goes on as itself.
        const bool spans = scene_.domain.periodic(axis) && solid_.turn == 0 &&
                           2 * half[axis] > scene_.domain.size()[axis] - 0.25 * dx_;
        return {count, spans ? 0 : layers_, 2 * half[axis] / count};
    }
    // Layers like the fluid's, once for each side: what of them is in the plate, and what is
    // beyond.
    void addFaces() {
        const int axis = thinAxis(scene_, halfExtent(solid_));
        const double cells = thickness_ / dx_;
        for (int i = 0; i < std::max(double(layers_), cells - 0.01); ++i) {
            const double share = std::clamp(cells - i, 0.0, 1.0);
            if (share > 0.01) addLayer(axis, (i + 0.5) * dx_, share * dx_, true);
            if (share < 0.99 && i < layers_)
                addLayer(axis, (i + 0.5) * dx_, (1 - share) * dx_, false);
        }
    }
    void addLayer(int axis, double depth, double width, bool inPlate) {
        const Vec3d half = halfExtent(solid_);
        const int b = (axis + 1) % 3, c = (axis + 2) % 3;
        const Cells alongB = cellsAlong(b, half), alongC = cellsAlong(c, half);
        const double volume = alongB.step * alongC.step * width / (dx_ * dx_ * dx_);
        for (const int side : {-1, 1})
            for (int i = -alongB.more; i < alongB.count + alongB.more; ++i)
                for (int j = -alongC.more; j < alongC.count + alongC.more; ++j) {
                    Vec3d at, face{0, 0, 0};
                    at[axis] = side * (half[axis] - depth), face[axis] = -side * depth;
                    at[b] = alongB.at(i), at[c] = alongC.at(j);
                    add(at, volume, face, !(inPlate && alongB.has(i) && alongC.has(j)));
                }
    }

    // What is thick enough to hide by itself has its own particles, once for each side.
    void addTwice() {
        const SolidSample once = sampleSolid(scene_, solid_);
        const Vec3d low = toDouble(scene_.domain.min) - shape_.middle;
        for (size_t i = 0; i < once.positions.size(); ++i) {
            Vec3d at = low + toDouble(once.positions[i]);
            if (scene_.simulation.dimensions == 2) at.z = 0;
            const Convex::Nearest near = shape_.nearest(at);
            const double depth = std::max(-near.distance, 0.05 * dx_);
            add(at, once.volumes[i], -depth * near.normal, false);
            add(at, once.volumes[i], std::max(thickness_ - depth, 0.05 * dx_) * near.normal, false);
        }
    }

    // Of any other shape cells of a lattice that fits its box. For fluid on one side all of a
    // cell that is not on that side is wall.
    void addCells() {
        const int d = scene_.simulation.dimensions;
        Vec3d half = halfExtent(solid_);
        if (!shape_.mesh && d == 2) half.z = 0.5 * dx_;
        int first[3], end[3];
        for (int k = 0; k < 3; ++k) {
            const int count = std::max(1, int(std::round(2 * half[k] / dx_)));
            const int more = k < d ? layers_ + 1 : 0;
            cell_[k] = k < d ? std::max(2 * half[k] / count, 0.75 * dx_) : dx_;
            low_[k] = -0.5 * count * cell_[k];
            first[k] = -more, end[k] = (k < d ? count : 1) + more;
            if (k >= d) low_[k] = -0.5 * dx_;
        }
        divide(first, end);
    }
    // The shape goes on as it ends where it stands on the domain's wall.
    Convex::Nearest nearest(Vec3d p) {
        const double near = 0.25 * dx_;
        const Vec3d low = toDouble(scene_.domain.min) - shape_.middle,
                    high = toDouble(scene_.domain.max) - shape_.middle;
        for (int k = 0; k < shape_.planes && solid_.turn == 0; ++k)
            for (int axis = 0; axis < scene_.simulation.dimensions; ++axis) {
                const double along = shape_.normal[k][axis], end = along * shape_.offset[k];
                if (std::abs(along) < 0.99 || scene_.domain.periodic(axis)) continue;
                if (along > 0 && end > high[axis] - near)
                    p[axis] = std::min(p[axis], end - thickness_);
                if (along < 0 && end < low[axis] + near)
                    p[axis] = std::max(p[axis], end + thickness_);
            }
        return shape_.mesh ? shape_.nearestOfMesh(p, triangle_) : shape_.nearest(p);
    }
    void divide(const int (&first)[3], const int (&end)[3]) {
        Vec3d half, middle;
        int longest = 0;
        for (int k = 0; k < 3; ++k) {
            half[k] = 0.5 * (end[k] - first[k]) * cell_[k];
            middle[k] = low_[k] + first[k] * cell_[k] + half[k];
            if (end[k] - first[k] > end[longest] - first[longest]) longest = k;
        }
        const double reach = length(half), far = layers_ * dx_ + reach;
        const Convex::Nearest near = nearest(middle);
        if (near.distance > far || near.distance < -far) return;
        if (end[longest] - first[longest] == 1) return addCell(middle, near);
        for (const int side : {0, 1}) {
            int from[3] = {first[0], first[1], first[2]}, to[3] = {end[0], end[1], end[2]};
            (side ? from : to)[longest] = (first[longest] + end[longest]) / 2;
            divide(from, to);
        }
    }
    void addCell(Vec3d middle, const Convex::Nearest& near) {
        constexpr int N = 4;  // parts a side
        const int d = scene_.simulation.dimensions, parts = d == 2 ? N * N : N * N * N;
        double share[2] = {0, 0};  // that is wall for fluid in front, along the normal, and behind
        Vec3d sum[2] = {};
        for (int i = 0; i < parts; ++i) {
            const double z = d == 2 ? 0 : ((i / (N * N) + 0.5) / N - 0.5) * cell_.z;
            const Vec3d p = middle + Vec3d{((i % N + 0.5) / N - 0.5) * cell_.x,
                                           ((i / N % N + 0.5) / N - 0.5) * cell_.y, z};
            const Convex::Nearest there = nearest(p);
            const double in = std::clamp(0.5 - there.distance * N / cell_.x, 0.0, 1.0);
            const int side = dot(there.normal, near.normal) > 0 ? 0 : 1;
            for (const int view : {0, 1}) {
                const double part = (view == side ? in : 1) / parts;
                share[view] += part, sum[view] = sum[view] + part * p;
            }
        }
        const double volume = cell_.x * cell_.y * (d == 2 ? 1 : cell_.z) / std::pow(dx_, d);
        for (const int view : {0, 1})
            if (share[view] > 0.02)
                addView((1 / share[view]) * sum[view], volume * share[view],
                        view == 0 ? near.normal : -1.0 * near.normal);
    }
    void addView(Vec3d at, double volume, Vec3d towards) {
        const Convex::Nearest there = nearest(at);
        const bool inFront = dot(there.normal, towards) > 0;
        const double depth = inFront ? -there.distance : there.distance + thickness_;
        if (depth > (layers_ + 0.5) * dx_) return;
        add(at, volume, -std::max(depth, 0.05 * dx_) * towards,
            !(there.distance < -thickness_ / 4));
    }

    const Scene& scene_;
    const Solid& solid_;
    const Convex shape_;
    double dx_, thickness_;
    int layers_, triangle_ = -1;
    Vec3d low_, cell_;
    SolidSample out_;
};

}  // namespace

// Below `enough`, and along one axis only.
static double thinnessBelow(double enough, const Scene& scene, const Solid& solid) {
    const Vec3d half = halfExtent(solid);
    int narrow = 0;
    for (int k = 0; k < scene.simulation.dimensions; ++k) narrow += 2 * half[k] < enough;
    if (narrow > 1) return 0;
    const Convex shape = convexOf(solid, scene.simulation.dimensions);
    const double thickness =
        shape.mesh ? shape.scale * shape.mesh->thinnest(enough / shape.scale).thickness
                   : 2 * half[thinAxis(scene, half)];
    return thickness < enough ? thickness : 0;
}

double thinness(const Scene& scene, const Solid& solid) {
    if (solid.shape == Shape::Plane) return 0;
    const double thickness = thinnessBelow(sightOf(scene), scene, solid);
    if (thickness > 0 || solid.floats()) return thickness;
    return thinnessBelow(thickEnough(scene), scene, solid);
}

bool needsScreen(const Scene& scene, const Solid& solid) {
    const double thickness = thinness(scene, solid);
    return thickness > 0 && thickness < sightOf(scene);
}

int faceOfPlate(const Scene& scene, const Solid& solid) {
    const bool isPlate = isBlock(solid) && thinness(scene, solid) > 0;
    return isPlate ? 2 * thinAxis(scene, halfExtent(solid)) : -1;
}

SolidSample sampleSides(const Scene& scene, const Solid& solid) {
    return Sides(scene, solid).sample();
}

SolidSample boundaryOf(const Scene& scene, const Solid& solid) {
    return thinness(scene, solid) > 0 ? sampleSides(scene, solid) : sampleSolid(scene, solid);
}

}  // namespace spindrift
