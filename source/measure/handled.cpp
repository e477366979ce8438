#include "measure/handled.h"

#include "measure/health.h"
#include "measure/stress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace spindrift {
namespace {

constexpr double PicturesPerSecond = 60;
constexpr float QuickestWay = 1.0f / 7;  // s, from one end of the box to the other

double diagonalOf(const Scene& scene) {
    return length(toDouble(scene.domain.max - scene.domain.min));
}

}  // namespace

RandomHand::RandomHand(const Scene& scene, uint64_t seed) : scene_(scene), random_(seed) {}

float RandomHand::between(float a, float b) {
    return a + (b - a) * float(double(random_() >> 11) / 9007199254740992.0);
}

Vec3 RandomHand::somewhere() {
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = between(scene_.domain.min[k], scene_.domain.max[k]);
    return p;
}

// Half of what it does it does to solids, if there are any.
void RandomHand::takeSomething() {
    const uint64_t choice = random_() % 8;
    const bool solids = !scene_.solids.empty() && scene_.time.mode != TimeMode::Local;
    solid_ = solids && choice < 4 ? int(random_() % scene_.solids.size()) : -1;
    stirs_ = solid_ < 0 && choice < 7;
    const uint64_t mode = random_() % 4;
    pull_ = mode == 0 ? 10.0f : mode == 1 ? -10.0f : 0.0f;
    const Vec3 size = scene_.domain.max - scene_.domain.min;
    const float side = scene_.simulation.dimensions == 2 ? std::min(size.x, size.y)
                                                         : std::min({size.x, size.y, size.z});
    radius_ = std::max(side * between(1.0f / 16, 0.25f), 2 * scene_.simulation.spacing);
    from_ = somewhere(), to_ = somewhere(), phase_ = 0;
    const double way = length(toDouble(to_ - from_)), slow = between(0, 1);
    // To and fro, at most as fast as a hand is.
    pace_ = slow * diagonalOf(scene_) /
            (double(QuickestWay) * std::max(way, 1e-3 * diagonalOf(scene_)));
    pace_ = std::min(pace_, 8.0);
    left_ = 5 + int(random_() % 85);
    before_ = place();
}

Vec3 RandomHand::place() {
    const float share = float(0.5 - 0.5 * std::cos(std::numbers::pi * phase_));
    return from_ + share * (to_ - from_);
}

void RandomHand::move(Simulation& simulation) {
    if (left_-- <= 0) takeSomething();
    phase_ += pace_ / PicturesPerSecond;
    const Vec3 at = place();
    simulation.hold(solid_ < 0 ? Hold{} : Hold{solid_, at});
    Stir stir;
    if (stirs_) {
        stir.center = at, stir.radius = radius_, stir.pull = pull_;
        stir.velocity = float(PicturesPerSecond / double(scene_.view.speed)) * (at - before_);
        if (scene_.simulation.dimensions == 2) stir.velocity.z = 0;
        fastest_ = std::max(fastest_, stir.speed());
    }
    simulation.stir(stir);
    before_ = at;
}

HandlingJudge::HandlingJudge(const Scene& scene, Simulation& simulation)
    : scene_(scene), count_(simulation.fluidCount()) {
    for (const Solid& solid : scene.solids)
        shapes_.push_back(convexOf(solid, scene.simulation.dimensions));
    const ObjectSample sample = sampleObjects(scene);
    const std::vector<Vec3> places = simulation.state().objects.positions;
    const std::vector<Particle> fluid = simulation.particles();
    for (size_t o = 0, first = 0, end; o < scene.objects.size(); ++o, first = end) {
        for (end = first; end < sample.size() && sample.objects[end] == int(o);) ++end;
        if (scene.objects[o].shape != ObjectShape::Tube || end == first) continue;
        const int axis = int(scene.objects[o].axis);
        Tube tube{axis, first, 0, end, {}};
        while (first + tube.ring < end &&
               sample.positions[first + tube.ring][axis] == sample.positions[first][axis])
            ++tube.ring;
        for (const Particle& p : fluid) tube.filled.push_back(isIn(tube, places, p.position));
        tubes_.push_back(std::move(tube));
    }
}

// Of a ring, along the tube.
double HandlingJudge::middleOf(const Tube& tube, const std::vector<Vec3>& places, size_t ring) {
    double sum = 0;
    for (size_t k = 0; k < tube.ring; ++k) sum += places[ring + k][tube.axis] / double(tube.ring);
    return sum;
}

// In the polygon between the rings of particles on its two sides, seen along the tube.
bool HandlingJudge::isIn(const Tube& tube, const std::vector<Vec3>& places, Vec3d p) const {
    const int axis = tube.axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto middle = [&](size_t at) { return middleOf(tube, places, at); };
    size_t ring = tube.first;
    while (ring + 2 * tube.ring < tube.end && middle(ring + tube.ring) < p[axis]) ring += tube.ring;
    const double from = middle(ring), share = (p[axis] - from) / (middle(ring + tube.ring) - from);
    const auto corner = [&](size_t k) {
        const Vec3d a = toDouble(places[ring + k % tube.ring]),
                    b = toDouble(places[ring + tube.ring + k % tube.ring]);
        return a + share * (b - a);
    };
    bool in = false;
    for (size_t k = 0; k < tube.ring; ++k) {
        const Vec3d a = corner(k), b = corner(k + 1);
        const bool crosses = (a[v] > p[v]) != (b[v] > p[v]);
        if (crosses && p[u] < a[u] + (b[u] - a[u]) * (p[v] - a[v]) / (b[v] - a[v])) in = !in;
    }
    return in;
}

// What has been at an open end may be anywhere later.
std::string HandlingJudge::leak(Simulation& simulation, const std::vector<Particle>& fluid) {
    const double time = simulation.clock().time, near = 2 * double(scene_.simulation.spacing);
    for (const Cut& cut : scene_.cuts)
        if (time >= double(cut.time)) return "";
    const std::vector<Vec3> places = simulation.state().objects.positions;
    for (Tube& tube : tubes_) {
        const double low = middleOf(tube, places, tube.first) + near,
                     high = middleOf(tube, places, tube.end - tube.ring) - near;
        int out = 0, first = -1;
        for (const Particle& p : fluid) {
            char& filled = tube.filled[size_t(p.id)];
            filled = filled && p.position[tube.axis] > low && p.position[tube.axis] < high;
            if (!filled || isIn(tube, places, p.position)) continue;
            ++out, first = first < 0 ? p.id : first;
        }
        if (out > 0)
            return fmt::format("{} particles went through the wall of a tube, {} first", out,
                               first);
    }
    return "";
}

std::string HandlingJudge::look(Simulation& simulation, double hand) {
    const Measurement m = simulation.measure();
    if (!m.finite) return "values that are no numbers";
    const int expected =
        count_ + int(std::lround((m.massIn - m.massOut) / double(particleMass(scene_))));
    if (simulation.fluidCount() != expected)
        return fmt::format("{} particles of {} are left", simulation.fluidCount(), expected);
    const double size = diagonalOf(scene_), dragged = 0.1 * m.soundSpeed;
    double start = 0;
    for (const Body& body : scene_.fluid.bodies)
        start = std::max<double>(start, length(body.velocity));
    const double reason = std::sqrt(start * start + hand * hand + dragged * dragged +
                                    2 * length(toDouble(scene_.simulation.gravity)) * size);
    if (m.maxSpeed > 4 * reason)
        return fmt::format("a particle at {:.3g} m/s, with reason for {:.3g}", m.maxSpeed, reason);
    const std::vector<Particle> fluid = simulation.particles();
    const std::vector<SolidPose> poses = simulation.solidPoses();
    const double dx = scene_.simulation.spacing;
    for (const Particle& p : fluid) {
        const Vec3d x = p.position - toDouble(scene_.domain.min), box = scene_.domain.size();
        for (int k = 0; k < scene_.simulation.dimensions; ++k)
            if (x[k] < -1e-4 * box[k] || x[k] > (1 + 1e-4) * box[k])
                return fmt::format("particle {} left the box", p.id);
        for (size_t s = 0; s < shapes_.size(); ++s) {
            const Vec3d arm = x - poses[s].middle;
            const Vec3d own{dot(arm, poses[s].axis[0]), dot(arm, poses[s].axis[1]),
                            dot(arm, poses[s].axis[2])};
            const double depth = -shapes_[s].nearest(own).distance;
            // Of a mesh fluid sees what is between the nodes of a lattice.
            if (depth > (shapes_[s].mesh ? 0.25 : 0.05) * dx)
                return fmt::format("particle {} is {:.3g} spacings in solid {}", p.id, depth / dx,
                                   s);
        }
    }
    return leak(simulation, fluid);
}

StressResult handle(const Scene& scene, uint64_t seed, double seconds) {
    constexpr int StepsOfAPicture = 10, PicturesOfALook = 10;
    const auto simulation = makeSimulation(scene);
    HealthGuard guard(*simulation, scene);
    RandomHand hand(scene, seed);
    HandlingJudge judge(scene, *simulation);
    StressResult r;
    r.particles = simulation->fluidCount();
    const int pictures = int(seconds * PicturesPerSecond);
    for (int k = 1; k <= pictures && r.what.empty(); ++k) {
        hand.move(*simulation);
        const double end = simulation->clock().time + double(scene.view.speed) / PicturesPerSecond;
        simulation->stopAt(end);
        for (int n = 0; n < StepsOfAPicture && simulation->clock().time < end; ++n)
            simulation->step();
        Measurement m = simulation->measure();
        const HealthGuard::Finding found = guard.look(m);
        r.steps = m.steps, r.retries = guard.retries(), r.time = m.time;
        r.density = std::max(r.density, m.maxDensityError);
        r.speed = std::max(r.speed, m.maxSpeed);
        if (found == HealthGuard::Finding::GaveUp) {
            r.verdict = Verdict::Stopped, r.what = guard.said();
            return r;
        }
        if (k % PicturesOfALook == 0 || k == pictures)
            r.what = judge.look(*simulation, hand.fastest());
    }
    r.verdict = r.what.empty() ? Verdict::Sound : Verdict::Broken;
    return r;
}

}  // namespace spindrift
