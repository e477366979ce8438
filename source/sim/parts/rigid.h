// Solids that float, as mechanics knows them: mass, turn, and where that puts them.
#pragma once

#include "sim/solid_motion.h"
#include "sim/particles/view.h"

namespace spindrift::LANES {

// In two dimensions of a metre of depth.
struct RigidBody {
    double mass;                      // kg, 0: moves as prescribed
    Vec3d centre, inverseInertia[3];  // m, of mass, from its middle; 1/(kg m^2) about that, row by
                                      // row; in its own axes
    real stiffness, damping,
        friction;  // of one ball where it touches (floating.h): N/m, N s/m, Coulomb's coefficient
    real deepestBall;  // m
    // What share of a change of its acceleration the fluid at its surface is told in a step. All of
    // it would be too much for light bodies: what the layers of boundary particles then press with
    // is as if fluid a spacing thick around the body were part of its mass, but a step late.
    double told = 1;
};

// How near a solid that floats comes to the box or another solid, and which way the fluid would
// press it if its pressure were the same everywhere: against what it is so near to that no fluid is
// between.
struct Gap {
    real width = 1e30;  // m
    double pressed[3] = {0, 0, 0};
    HD_OUT void add(const Gap& o) {
        width = o.width < width ? o.width : width;
        for (int k = 0; k < 3; ++k) pressed[k] += o.pressed[k];
    }
    // 1 where no particle of fluid fits in, 0 where two do.
    HD real narrowness(real spacing) const {
        return min(max(real(2) - width / spacing, real(0)), real(1));
    }
};
// The pressure of the fluid that presses it there: sums of a weight w, w p / rho0^2, and w x.
struct PressureAround {
    double weight = 0, pressure = 0, place[3] = {0, 0, 0};
    HD_OUT void add(const PressureAround& o) {
        weight += o.weight, pressure += o.pressure;
        for (int k = 0; k < 3; ++k) place[k] += o.place[k];
    }
    // p / rho0^2 at x, of fluid at rest under `pull`, m/s^2.
    HD real at(Vector<real> x, Vector<real> pull, real restDensity) const {
        if (weight <= 0) return 0;
        const double per = 1 / weight;
        const double height = pull.x * (x.x - per * place[0]) + pull.y * (x.y - per * place[1]) +
                              pull.z * (x.z - per * place[2]);
        return max(real(per * pressure + height / restDensity), real(0));
    }
};

// What a solid that the mouse drags gives to the objects' particles that it stops in a step, kg
// m/s, and their mass, kg.
struct Stops {
    double momentum[3] = {0, 0, 0}, mass = 0;
    HD_OUT void add(const Stops& o) {
        for (int k = 0; k < 3; ++k) momentum[k] += o.momentum[k];
        mass += o.mass;
    }
};

// How far a solid in the mouse's hand may go until one spacing is left to the box, m, and how fast
// it at least has to go away from the other solid that is nearest: its speed along `away`, m/s.
struct Room {
    real low[3] = {1e30, 1e30, 1e30}, high[3] = {1e30, 1e30, 1e30};
    real least = -1e30, away[3] = {0, 0, 0};
    HD_OUT void add(const Room& o) {
        for (int k = 0; k < 3; ++k) {
            low[k] = o.low[k] < low[k] ? o.low[k] : low[k];
            high[k] = o.high[k] < high[k] ? o.high[k] : high[k];
        }
        if (!(o.least > least)) return;
        least = o.least;
        for (int k = 0; k < 3; ++k) away[k] = o.away[k];
    }
    // What is left of a velocity where the rest of the way takes `time`. Where it reaches through a
    // side of the box no fluid is between.
    HD Vec3d slowed(Vec3d u, double time, double spacing) const {
        auto fastest = [&](double way) {
            return way > 0 ? way / time : way < -2 * spacing ? 1e30 : 0.0;
        };
        for (int k = 0; k < 3; ++k) {
            const double down = fastest(low[k]), up = fastest(high[k]);
            u[k] = u[k] < -down ? -down : u[k] > up ? up : u[k];
        }
        const Vec3d n{away[0], away[1], away[2]};
        const double lacks = least - dot(u, n);
        return lacks > 0 ? u + lacks * n : u;
    }
};

// The quaternion of a small turn, radians, after another one; of length 1.
HD inline void turnBy(Quaternion& q, Vec3d angle) {
    const double size = sqrt(dot(angle, angle)), half = 0.5 * size,
                 share = size > 1e-12 ? sin(half) / size : 0.5, c = cos(half);
    const Vec3d a = share * angle, b{q.x, q.y, q.z};
    const Vec3d v = c * b + q.w * a + cross(a, b);
    const double w = c * q.w - dot(a, b), length = sqrt(w * w + dot(v, v));
    q = {w / length, v.x / length, v.y / length, v.z / length};
}
// From its own axes into space, and back.
struct Turn {
    Vec3d axis[3];
    HD explicit Turn(const Quaternion& q) {
        const double w = q.w, x = q.x, y = q.y, z = q.z;
        axis[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
        axis[1] = {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
        axis[2] = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
    }
    HD Vec3d out(Vec3d a) const { return a.x * axis[0] + a.y * axis[1] + a.z * axis[2]; }
    HD Vec3d in(Vec3d a) const { return {dot(a, axis[0]), dot(a, axis[1]), dot(a, axis[2])}; }
};
// rad/s of an angular momentum, rad/s^2 of a torque.
HD inline Vec3d turning(const RigidBody& body, const SolidMotion& m, Vec3d moment) {
    const Turn turn(m.turn);
    const Vec3d l = turn.in(moment);
    return turn.out({dot(body.inverseInertia[0], l), dot(body.inverseInertia[1], l),
                     dot(body.inverseInertia[2], l)});
}
HD inline Vec3d spinOf(const RigidBody& body, const SolidMotion& m) {
    return turning(body, m, m.angularMomentum);
}

// Where a solid that floats is, `ahead` seconds further on.
HD inline void placeFloating(SolidState& s, const RigidBody& body, SolidMotion m, double ahead) {
    const Vec3d spin = spinOf(body, m);
    turnBy(m.turn, ahead * spin);
    const Turn turn(m.turn);
    auto narrow = [](Vec3d a) { return Vector<real>{real(a.x), real(a.y), real(a.z)}; };
    const Vec3d arm = -1.0 * turn.out(body.centre), centre = m.centre + ahead * m.velocity;
    for (int k = 0; k < 3; ++k) s.axis[k] = narrow(turn.axis[k]);
    s.centreOfMass = narrow(centre);
    s.middle = narrow(centre + arm);
    s.velocity = narrow(m.velocity + cross(spin, arm));
    s.spin = narrow(spin);
    s.acceleration =
        narrow(m.acceleration + cross(m.spinRate, arm) + cross(spin, cross(spin, arm)));
    s.spinRate = narrow(m.spinRate);
    s.speed = real(sqrt(dot(m.velocity, m.velocity)) + double(s.reach) * sqrt(dot(spin, spin)));
}

}  // namespace spindrift::LANES
