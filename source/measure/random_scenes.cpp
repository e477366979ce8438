// Valid small scenes, by dice.
#include "measure/stress.h"

#include "core/error.h"
#include "scene/check.h"
#include "scene/formulation.h"
#include "scene/particles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace spindrift {
namespace {

struct Dice {
    std::mt19937_64 random;
    double unit() { return double(random() >> 11) / 9007199254740992.0; }
    float between(double a, double b) { return float(a + (b - a) * unit()); }
    float logarithmic(double a, double b) { return float(a * std::pow(b / a, unit())); }
    bool oneIn(int n) { return random() % uint64_t(n) == 0; }
};

// One scene in six is full to the walls and has the formulation for that; knobs that seldom matter.
// By dice of their own, so that the other scenes are those that these seeds have always had.
void turnRareKnobs(Scene& s, uint64_t seed) {
    Dice dice{std::mt19937_64(seed + 0x9e3779b97f4a7c15u)};
    if (dice.oneIn(4)) s.fluid.gamma = 1 + int(dice.random() % 7);
    if (dice.oneIn(4)) s.fluid.densityDiffusion = dice.between(0.02, 0.2);
    if (dice.oneIn(4)) s.time.cfl = dice.between(0.1, 0.4);
    if (dice.oneIn(6))
        s.simulation.centralRate =
            dice.between(0.1, 1) * std::sqrt(9.81f / length(s.domain.max - s.domain.min));
    if (dice.oneIn(10)) s.compute.precision = Precision::Double;
    if (!dice.oneIn(6)) return;
    s.simulation.formulation = Formulation::TransportVelocity;
    s.simulation.centralRate = 0;
    s.simulation.support = dice.between(2.4, 3.2);
    s.walls.kind = WallKind::Particles;
    s.fluid.equationOfState = EquationOfState::Linear;
    s.fluid.shifting = dice.between(0.5, 2);
    Vec3 size = s.domain.max - s.domain.min;
    for (int k = 0; k < s.simulation.dimensions; ++k)
        size[k] = std::round(size[k] / s.simulation.spacing) * s.simulation.spacing;
    s.domain.max = s.domain.min + size;
    Body all = s.fluid.bodies[0];
    all.shape = Shape::Block, all.min = s.domain.min, all.max = s.domain.max;
    if (dice.oneIn(2)) all.field = Field::TaylorGreen;
    if (dice.oneIn(2))
        s.walls.movingFace = Face::YMax, s.walls.velocity = {all.velocity.x, 0, 0},
        all.velocity = {0, 0, 0};
    s.fluid.bodies = {all};
}

// One in three that can has local steps and rest.
void turnLocal(Scene& s, uint64_t seed) {
    Dice dice{std::mt19937_64(seed + 0xc2b2ae3d27d4eb4fu)};
    const float restSpeed = dice.oneIn(2) ? dice.logarithmic(1e-5, 1e-2) : s.time.restSpeed;
    if (!dice.oneIn(3) || shiftsParticles(s) || s.time.mode != TimeMode::Cfl ||
        s.time.integrator != Integrator::SymplecticEuler)
        return;
    s.time.mode = TimeMode::Local, s.time.restSpeed = restSpeed;
}

// One in three is of several fluids, and one in three has forces that are rare. Whether energy is
// kept with them.
bool turnFluids(Scene& s, uint64_t seed) {
    Dice dice{std::mt19937_64(seed + 0x165667b19e3779f9u)};
    Fluid& f = s.fluid;
    const bool summed = s.simulation.formulation == Formulation::Wcsph,
               carried = s.simulation.formulation == Formulation::DeltaSph;
    if (dice.oneIn(3) && (summed || carried))
        for (Body& body : f.bodies) {
            body.restDensity = f.restDensity * dice.logarithmic(0.2, 5);
            if (dice.oneIn(2))
                body.viscosity =
                    dice.oneIn(4) ? 0 : body.restDensity * dice.logarithmic(1e-6, 1e-1);
        }
    // Which Mueller's kernels don't bear.
    const bool mayMeet = carried && s.walls.kind == WallKind::Reflect;
    if (dice.oneIn(8) && !mayMeet) s.simulation.kernel = Kernel::Mueller;
    if (!dice.oneIn(3) || s.simulation.formulation > Formulation::DeltaPlus) return true;
    const float size = length(s.domain.max - s.domain.min), rate = std::sqrt(9.81f / size);  // 1/s
    if (dice.oneIn(2)) f.velocityTransfer = rate * dice.logarithmic(0.1, 100);
    if (dice.oneIn(2)) f.dissipation = std::min(rate * dice.logarithmic(0.01, 10), 100.0f);
    if (dice.oneIn(3)) f.buoyancy = dice.between(0, 3);
    if (dice.oneIn(2) && summed)
        f.airDensity = std::min(f.restDensity * dice.logarithmic(1e-4, 1e-2), 100.0f),
        f.wind = {dice.between(-3, 3), 0, 0};
    if (dice.oneIn(2) && !summed && !carried)
        f.surfaceTension = f.restDensity * 9.81f * s.simulation.spacing * s.simulation.spacing *
                           dice.logarithmic(0.1, 100);
    if (dice.oneIn(4) && summed && !isMultiFluid(s)) s.simulation.pressureForm = PressureForm::Mean;
    return f.buoyancy == 0 && f.airDensity == 0 && f.surfaceTension == 0 &&
           s.simulation.pressureForm == PressureForm::Squares;
}

// One in four has solids that float, one in four elastic objects, where that makes sense. Whether
// there are any: they have energy that is not counted.
bool turnThings(Scene& s, uint64_t seed) {
    Dice dice{std::mt19937_64(seed + 0x2545f4914f6cdd1du)};
    const Scene without = s;
    const Vec3 size = s.domain.max - s.domain.min;
    const float dx = s.simulation.spacing, fall = std::sqrt(9.81f * length(size));  // m/s
    const bool flat = s.simulation.dimensions == 2;
    auto place = [&](Vec3& low, Vec3& high) {
        for (int k = 0; k < 3; ++k) {
            const float extent = std::min(dx * dice.between(2, 10), 0.6f * size[k]);
            low[k] = s.domain.min[k] + dice.between(0, 1) * (size[k] - extent),
            high[k] = low[k] + extent;
        }
    };
    auto speed = [&] {
        return Vec3{dice.between(-1, 1) * fall, dice.between(-1, 1) * fall,
                    flat ? 0 : dice.between(-1, 1) * fall};
    };
    for (int n = dice.oneIn(4) ? 1 + int(dice.random() % 3) : 0; n > 0; --n) {
        Solid solid;
        solid.shape = Shape(dice.random() % 4);
        place(solid.min, solid.max);
        solid.center = 0.5f * (solid.min + solid.max),
        solid.radius = 0.5f * (solid.max.x - solid.min.x), solid.height = solid.max.y - solid.min.y;
        solid.axis = flat ? Axis::Z : Axis(dice.random() % 3);
        solid.density = s.fluid.restDensity * dice.logarithmic(0.1, 10),
        solid.friction = dice.between(0, 1);
        if (dice.oneIn(2))
            solid.velocity = speed(), solid.spin = dice.between(-360, 360) * fall / length(size);
        s.solids.push_back(solid);
    }
    for (int n = dice.oneIn(4) ? 1 + int(dice.random() % 2) : 0; n > 0; --n) {
        Object object;
        object.shape = ObjectShape(dice.random() % 3);
        place(object.min, object.max);
        if (object.shape == ObjectShape::Sheet) object.max.y = object.min.y;
        object.center = 0.5f * (object.min + object.max),
        object.radius = 0.5f * (object.max.x - object.min.x),
        object.height = object.max.z - object.min.z;
        object.axis = flat ? Axis::Z : Axis(dice.random() % 3);
        object.spacing = dx * dice.between(0.5, 2),
        object.thickness = dx * dice.logarithmic(0.1, 2);
        object.density = s.fluid.restDensity * dice.logarithmic(0.2, 5);
        object.youngsModulus = object.density * fall * fall * dice.logarithmic(1, 1000);
        object.damping = dice.between(0, 0.5),
        object.breakingStrain = dice.oneIn(2) ? dice.logarithmic(0.01, 1) : 0;
        if (dice.oneIn(2)) object.velocity = speed();
        if (dice.oneIn(3))
            s.grips.push_back(
                {object.min, object.center, dice.oneIn(2) ? 0.2f * speed() : Vec3{}, {}});
        s.objects.push_back(object);
    }
    if (s.solids.empty() && s.objects.empty()) return false;
    try {
        checkScene(s, s.name);
        return true;
    } catch (const Error&) { s = without; }
    return false;
}

// One in five of those that may be is incompressible.
void turnIncompressible(Scene& s, uint64_t seed) {
    Dice dice{std::mt19937_64(seed + 0x94d049bb133111ebu)};
    if (!dice.oneIn(5)) return;
    const Formulation before = s.simulation.formulation;
    s.simulation.formulation = Formulation::Incompressible;
    try {
        checkScene(s, s.name);
    } catch (const Error&) { s.simulation.formulation = before; }
}

// `size`: of the domain, in units of `scale`, m.
Body randomBody(const Scene& s, Dice& dice, float scale, const Vec3& size) {
    auto between = [&](double a, double b) { return dice.between(a, b); };
    Body body;
    body.shape = Shape(dice.random() % 3);
    const Vec3 low{between(0, 0.6) * size.x, between(0, 0.6) * size.y, between(0, 0.6) * size.z};
    const Vec3 extent{between(0.1, 0.4) * size.x, between(0.1, 0.4) * size.y,
                      between(0.1, 0.4) * size.z};
    body.min = s.domain.min + scale * low, body.max = body.min + scale * extent;
    body.center = 0.5f * (body.min + body.max);
    body.radius = 0.4f * scale * std::min({extent.x, extent.y, extent.z});
    body.height = scale * extent.y;
    const float speed = std::sqrt(scale) * dice.logarithmic(0.1, 20);
    body.velocity = {between(-1, 1) * speed, between(-1, 1) * speed,
                     s.simulation.dimensions == 3 ? between(-1, 1) * speed : 0};
    return body;
}

}  // namespace

StressCase randomCase(uint64_t seed) {
    Dice dice{std::mt19937_64(seed)};
    auto& random = dice.random;
    auto between = [&](double a, double b) { return dice.between(a, b); };
    auto logarithmic = [&](double a, double b) { return dice.logarithmic(a, b); };
    auto oneIn = [&](int n) { return dice.oneIn(n); };
    for (;;) {
        Scene s;
        s.name = fmt::format("random {}", seed);
        s.compute.backend = Backend::Cpu;
        s.simulation.dimensions = oneIn(3) ? 2 : 3;
        s.simulation.formulation = Formulation(random() % 3);  // those with free surfaces
        s.simulation.kernel = oneIn(4) ? Kernel::CubicSpline : Kernel::WendlandC2;
        const double scale = logarithmic(0.01, 10);  // m
        const Vec3 size{between(0.6, 1.6), between(0.6, 1.6), between(0.6, 1.6)};
        s.domain.min = oneIn(4) ? Vec3{between(-100, 100), between(-100, 100), between(-100, 100)}
                                : Vec3{0, 0, 0};
        s.domain.max = s.domain.min + float(scale) * size;
        s.simulation.spacing = float(scale) * (s.simulation.dimensions == 2 ? between(0.015, 0.05)
                                                                            : between(0.05, 0.1));
        s.simulation.support = between(2, 3.2);
        const float g = oneIn(5) ? 0 : between(1, 30);
        s.simulation.gravity = {oneIn(3) ? between(-10, 10) : 0, -g,
                                oneIn(3) && s.simulation.dimensions == 3 ? between(-10, 10) : 0};
        s.simulation.jitter = oneIn(3) ? between(0, 0.2) : 0;
        s.simulation.seed = int(seed % 1000);
        s.domain.periodicX = oneIn(4),
        s.domain.periodicZ = oneIn(6) && s.simulation.dimensions == 3;
        s.walls.kind = oneIn(3) ? WallKind::Reflect : WallKind::Particles;
        s.walls.restitution = oneIn(2) ? between(0, 1) : 0,
        s.walls.friction = oneIn(2) ? between(0, 1) : 0;
        s.fluid.restDensity = logarithmic(1, 2000);
        s.fluid.viscosity = oneIn(4) ? 0 : s.fluid.restDensity * logarithmic(1e-6, 1e-1);
        s.fluid.artificialViscosity = between(0.02, 0.3);
        s.fluid.equationOfState = oneIn(4) ? EquationOfState::Linear : EquationOfState::Tait;
        s.fluid.speedRatio = between(8, 20);
        s.compute.skin = oneIn(4) ? 0 : between(0.02, 0.4);
        s.fluid.bodies.clear();
        for (uint64_t b = 0, n = 1 + random() % 3; b < n; ++b)
            s.fluid.bodies.push_back(randomBody(s, dice, float(scale), size));
        turnRareKnobs(s, seed);
        turnLocal(s, seed);
        const bool fluidsKeepEnergy = turnFluids(s, seed),
                   keepsEnergy = !turnThings(s, seed) && fluidsKeepEnergy;
        turnIncompressible(s, seed);
        try {
            checkScene(s, s.name);
        } catch (const Error&) { continue; }  // makes no sense: the next throw of the dice
        const int64_t count = countParticles(s).fluid;
        if (count < 20 || count > 8000) continue;
        // A sliding lid gives energy; what falls along a periodic axis falls for ever.
        const bool falls = (s.domain.periodicX && s.simulation.gravity.x != 0) ||
                           (s.domain.periodicZ && s.simulation.gravity.z != 0);
        return {s.name, s, 300, {}, {}, !falls && keepsEnergy && s.walls.movingFace == Face::None};
    }
}

}  // namespace spindrift
