#include "scene/lattice.h"

#include "scene/body_parts.h"
#include "scene/particle_file.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift {
namespace {

// What is left of a body along an axis between solid blocks that stand in it or bound it.
struct Piece {
    Interval at;
    bool isFirm;  // something is at its far end that layers have to meet
};

void addPieces(const Scene& scene, const Body& body, int axis, std::vector<Piece>& pieces) {
    const double near = 0.5 * double(scene.simulation.spacing), size = scene.domain.size()[axis];
    Interval whole = extentAlong(scene, body, axis);
    whole = {std::max(whole.low, 0.0), std::min(whole.high, size)};
    std::vector<Interval> parts;
    bool isParted = false;
    for (const Solid& solid : scene.solids) {
        if (!isFace(solid) || !isBox(body) || !meet(scene, solid, body, axis)) continue;
        const Interval s = extentAlong(scene, solid, axis);
        if (s.low > whole.high + near || s.high < whole.low - near) continue;
        const Interval below{whole.low, s.low}, above{s.high, whole.high};
        const bool all = coversAcross(scene, solid, body, axis);
        for (const Interval& part : {below, above})
            if (part.length() > near) parts.push_back(part);
        if (!all) continue;
        // It bounds the body at one end, or parts it.
        isParted = isParted || (below.length() > near && above.length() > near);
        if (below.length() <= near) whole.low = std::max(whole.low, s.high);
        if (above.length() <= near) whole.high = std::min(whole.high, s.low);
    }
    for (const Interval& part : parts)
        if (std::abs(part.length() - whole.length()) > near) pieces.push_back({part, true});
    if (!isParted) pieces.push_back({whole, !parts.empty() || whole.high > size - near});
}

// Of all bodies; those that lie in a row up to a wall are one more piece.
std::vector<Piece> piecesAlong(const Scene& scene, int axis) {
    const double near = 0.5 * double(scene.simulation.spacing), size = scene.domain.size()[axis];
    std::vector<Piece> pieces;
    for (const Body& body : scene.fluid.bodies)
        if (hasFlatEnds(body, axis)) addPieces(scene, body, axis, pieces);
    std::vector<Interval> rows;
    for (const Piece& piece : pieces) rows.push_back(piece.at);
    std::sort(rows.begin(), rows.end(), [](auto& a, auto& b) { return a.low < b.low; });
    for (size_t i = 0; i < rows.size(); ++i) {
        Interval row = rows[i];
        while (i + 1 < rows.size() && rows[i + 1].low < row.high + near)
            row.high = std::max(row.high, rows[++i].high);
        if (row.high > size - near) pieces.push_back({row, true});
    }
    return pieces;
}

// How badly layers of this step fit: where they have to meet something any part of a layer that is
// missing counts, elsewhere it is but a little mass.
double misfit(const std::vector<Piece>& pieces, double step) {
    double sum = 0;
    for (const Piece& piece : pieces) {
        const double layers = piece.at.length() / step;
        const double over = layers - std::max(1.0, std::round(layers));
        sum += piece.isFirm ? std::pow(overFull(layers), 2) : 0.01 * over * over;
    }
    return sum;
}

bool areWhole(const Scene& scene, const std::vector<Piece>& pieces) {
    const double dx = scene.simulation.spacing;
    return std::all_of(pieces.begin(), pieces.end(),
                       [&](const Piece& p) { return isWhole(p.at.length() / dx); });
}

double stepAlong(const Scene& scene, int axis) {
    const double dx = scene.simulation.spacing;
    const std::vector<Piece> pieces = piecesAlong(scene, axis);
    if (areWhole(scene, pieces)) return dx;
    double longest = 0;
    for (const Piece& piece : pieces) longest = std::max(longest, piece.at.length());
    double best = dx, least = 1e300;
    auto consider = [&](double step) {
        const double stretch = longest / step - longest / dx;  // layers more than asked for
        const double cost = misfit(pieces, step) + 1e-3 * std::pow(stretch * dx / longest, 2);
        if (cost < least) least = cost, best = step;
    };
    consider(dx);
    for (const Piece& piece : pieces) {
        const double n = std::round(piece.at.length() / dx);
        if (n == 0) continue;  // too thin for a particle
        consider(piece.at.length() / n);
        for (double m : {n - 2, n - 1, n + 1, n + 2})
            if (m >= 8) consider(piece.at.length() / m);
    }
    return best;
}

// Of the particles of files, 0 where there are none that say. A checkpoint's scene says it itself,
// in single precision: the file may be gone.
double volumeInFiles(const Scene& scene) {
    for (const Body& body : scene.fluid.bodies) {
        if (body.shape != Shape::File) continue;
        const float mass = body.mass > 0 ? body.mass : float(massInFile(body.path));
        if (mass > 0) return double(mass) / double(restDensity(scene, body));
    }
    return 0;
}

// Of the square or cube that is a packed particle's, m, so that a whole number of them fills a
// block up to walls that are near. In few particles half of one more or less is a density that
// bursts.
double packedSide(const Scene& scene) {
    const double dx = scene.simulation.spacing;
    const std::vector<Body>& bodies = scene.fluid.bodies;
    if (bodies.size() != 1 || bodies[0].shape != Shape::Block) return dx;
    if (!scene.solids.empty() || !scene.objects.empty()) return dx;
    double count = 1;
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        Interval at = extentAlong(scene, bodies[0], k);
        const double size = scene.domain.size()[k];
        if (at.low < 0.5 * dx) at.low = 0;
        if (at.high > size - 0.5 * dx) at.high = size;
        count *= at.length() / dx;
    }
    const double whole = std::max(1.0, std::round(count));
    if (std::abs(count / whole - 1) < 1e-5) return dx;
    return dx * std::pow(count / whole, 1.0 / scene.simulation.dimensions);
}

// What blocks that stand on a wall take of it along an axis.
struct Foot {
    Interval at;
    bool spans;  // all of the wall, across the axis
};
std::vector<Foot> feetAlong(const Scene& scene, int axis) {
    const double near = 0.25 * double(scene.simulation.spacing);
    const Vec3d size = scene.domain.size();
    std::vector<Foot> feet;
    for (const Solid& solid : scene.solids) {
        if (!isFace(solid)) continue;
        int stands = 0, open = 0;
        for (int k = 0; k < scene.simulation.dimensions; ++k) {
            const Interval s = extentAlong(scene, solid, k);
            const int ends = (s.low < near) + (s.high > size[k] - near);
            if (k != axis) stands += ends > 0 && !scene.domain.periodic(k), open += ends < 2;
        }
        if (stands > 0) feet.push_back({extentAlong(scene, solid, axis), open <= 1});
    }
    return feet;
}

}  // namespace

Vec3d latticeStep(const Scene& scene) {
    const double dx = scene.simulation.spacing;
    Vec3d step{dx, dx, dx};
    if (!isFitted(scene)) return step;
    const int d = scene.simulation.dimensions;
    if (const double volume = volumeInFiles(scene); volume > 0) {
        const double side = std::pow(volume, 1.0 / d);
        if (std::abs(side / dx - 1) < 1e-6) return step;  // a column of digits
        for (int k = 0; k < d; ++k) step[k] = side;
        return step;
    }
    if (scene.simulation.placement == StartPlaces::Relaxed) {
        const double side = packedSide(scene);
        for (int k = 0; k < d; ++k) step[k] = side;
        return step;
    }
    for (int k = 0; k < d; ++k) step[k] = stepAlong(scene, k);
    return step;
}

std::vector<WallCells> wallCells(const Scene& scene, int axis) {
    const double size = scene.domain.size()[axis], step = latticeStep(scene)[axis],
                 near = 0.25 * double(scene.simulation.spacing);
    auto divide = [](double low, double high, double count) -> WallCells {
        return {low, int64_t(std::min(count, MaxPlanes)), (high - low) / std::max(count, 1.0)};
    };
    const WallCells all = divide(0, size, std::max(1.0, std::round(size / step)));
    const std::vector<Foot> feet = feetAlong(scene, axis);
    std::vector<double> faces = {0, size};
    for (const Foot& foot : feet)
        for (const double face : {foot.at.low, foot.at.high})
            if (face > near && face < size - near) faces.push_back(face);
    std::sort(faces.begin(), faces.end());
    // What is packed has no layers that would meet a face.
    if (scene.simulation.placement == StartPlaces::Relaxed ||
        std::all_of(faces.begin(), faces.end(), [&](double f) { return isWhole(f / all.step); }))
        return {all};
    constexpr double Most = 0.03;  // that cells may be off: all have one mass
    std::vector<WallCells> cells;
    for (size_t i = 0; i + 1 < faces.size(); ++i) {
        const double low = faces[i], high = faces[i + 1], n = (high - low) / step;
        const bool isUnder = std::any_of(feet.begin(), feet.end(), [&](const Foot& foot) {
            return foot.spans && foot.at.low < low + near && foot.at.high > high - near;
        });
        // A cell in part under a thin block would be seen as far as its middle is from the face.
        const double count = isUnder && n < 4 ? std::floor(n + 0.02) : std::round(n);
        if (!isUnder && count > 0 && std::abs(n / count - 1) > Most) return {all};
        if (count > 0) cells.push_back(divide(low, high, count));
    }
    return cells.empty() ? std::vector<WallCells>{all} : cells;
}

Vec3d wallStep(const Scene& scene) {
    Vec3d step = latticeStep(scene);
    for (int k = 0; k < scene.simulation.dimensions; ++k) {
        double length = 0, count = 0;
        for (const WallCells& cells : wallCells(scene, k))
            length += double(cells.count) * cells.step, count += double(cells.count);
        step[k] = length / count;
    }
    return step;
}

double particleVolume(const Scene& scene) {
    const int d = scene.simulation.dimensions;
    if (!hasOwnVolume(scene)) return std::pow(double(scene.simulation.spacing), d);
    const Vec3d step = latticeStep(scene);
    return step.x * step.y * (d == 2 ? 1 : step.z);
}

bool areSidesWhole(const Scene& scene) {
    for (int k = 0; k < scene.simulation.dimensions; ++k)
        if (!areWhole(scene, piecesAlong(scene, k))) return false;
    return true;
}

bool hasOwnVolume(const Scene& scene) {
    const double dx = scene.simulation.spacing;
    return latticeStep(scene) != Vec3d{dx, dx, dx};
}

}  // namespace spindrift
