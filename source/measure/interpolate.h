#pragma once
// Fields between the particles.
#include "sim/simulation.h"

#include <functional>
#include <vector>

namespace spindrift {

struct Fields {
    Vec3d velocity;
    double pressure = 0, density = 0;
    int neighbours = 0;
};  // m/s, Pa, kg/m³

// What lies beyond the sides of a box, axis by axis: nothing that counts, the box again, or its
// mirror image.
struct Surroundings {
    enum Beyond { Nothing, Again, Mirror };
    Vec3d low, high;  // m, world coordinates
    Beyond beyond[3] = {Nothing, Nothing, Nothing};
};

// Whether a particle is seen from a point, or from an image of one; all are where that isn't asked.
using Sees = std::function<bool(Vec3d particle, Vec3d from)>;

// Beside which points a particle lies: cells as long as a radius know the points that a particle in
// them may be nearer to than that. Made once for points that stay; looking one particle up costs a
// cell.
class PointsNear {
public:
    // World coordinates, m.
    PointsNear(const std::vector<Vec3d>& points, double radius, const Surroundings& = {});

    // Calls f(index of the point, (x - point) / radius, its length below 1) for the points near x.
    template <class F> void visit(Vec3d x, const F& f) const {
        const int cell = cellOf(x);
        if (cell < 0) return;
        for (int k = start_[size_t(cell)]; k < start_[size_t(cell) + 1]; ++k) {
            const Site& site = sites_[size_t(listed_[size_t(k)])];
            const Vec3d r = (1 / radius_) * (x - site.position);
            const double q = length(r);
            if (q < 1) f(site.point, r, q);
        }
    }
    // The same for those that see it.
    template <class F> void visit(Vec3d x, const Sees& sees, const F& f) const {
        visit(x, [&](int point, Vec3d r, double q) {
            if (!sees || sees(x, x - radius_ * r)) f(point, r, q);
        });
    }
    size_t points() const { return points_; }

private:
    struct Site {
        Vec3d position;
        int point;
    };                          // a point, or one of its images
    int cellOf(Vec3d x) const;  // -1 outside
    void makeCells();
    template <class F> void forCellsOf(const Site&, const F&) const;

    size_t points_;
    double radius_, cell_;  // m
    Vec3d low_;
    int cells_[3] = {0, 0, 0};
    std::vector<Site> sites_;
    std::vector<int> start_,
        listed_;  // sites of cell c: listed_[start_[c]] ... listed_[start_[c + 1] - 1]
};

// At each point, from the fluid particles nearer than the radius. Linear: moving least squares of
// first order, exact for linear fields; with too few neighbours for a slope as Mean. Mean: their
// weighted mean (Shepard), never beyond their values: for spray. Without neighbours zeros. Nothing
// is mirrored at walls.
std::vector<Fields> interpolate(const std::vector<Particle>&, const PointsNear&, Order,
                                const Sees& = {});
std::vector<Fields> interpolate(const std::vector<Particle>&, const std::vector<Vec3d>& points,
                                double radius, Order = Order::Linear);

// The same of one quantity alone, Order::Mean: for pictures, which want many points.
struct Sample {
    Vec3d position;  // m
    double value;
};
struct Smoothed {
    double value = 0;   // 0 where there is no particle
    double weight = 0;  // sum of weightAt
};
std::vector<Smoothed> interpolate(const std::vector<Sample>&, const PointsNear&, const Sees& = {});

// Of a particle q radii away: Wendland C2, 1 at a point itself.
double weightAt(double q);
// What a particle fills of what is around itself: its volume x W(0). Times the sum of weights: the
// share of what is around a point that is fluid.
double filledBy(const Scene&, double radius);
// Over the scene's periodic sides is the domain again, over the others `wall`. World coordinates.
Surroundings surroundings(const Scene&, Surroundings::Beyond wall);

}  // namespace spindrift
