// What leaves the device: vertices for the screen, sums for the measurements.
#pragma once

#include "core/vertex.h"
#include "sim/parts/solid_passes.h"

namespace spindrift::LANES {

HD inline real magnitude(Vector<real> a) { return squareRoot(dot(a, a)); }
HD inline real densityOf(const Particles& p, int i) { return massRatio(p, i) * load(p.density, i); }
HD inline real pressureOf(const Particles& p, int i) {
    return load(p.pressureOverRho2, i) * load(p.density, i) * load(p.density, i);
}

// A colour mode: the scalar that a vertex carries.
struct PlainValue {
    HD static real of(const Particles&, int) { return 0; }
};
struct SpeedValue {
    HD static real of(const Particles& p, int i) { return magnitude(load(p.velocity, i)); }
};
struct AccelerationValue {
    HD static real of(const Particles& p, int i) { return magnitude(load(p.acceleration, i)); }
};
struct DensityValue {
    HD static real of(const Particles& p, int i) { return densityOf(p, i); }
};
struct PressureValue {
    HD static real of(const Particles& p, int i) { return pressureOf(p, i); }
};
struct FluidValue {
    HD static real of(const Particles& p, int i) { return massRatio(p, i); }
};
template <int axis> struct VelocityComponent {
    HD static real of(const Particles& p, int i) {
        const Vector<real> u = load(p.velocity, i);
        return axis == 0 ? u.x : axis == 1 ? u.y : u.z;
    }
};
struct TimeBinValue {
    HD static real of(const Particles& p, int i) { return p.timeBin.data ? load(p.timeBin, i) : 0; }
};
// What a pass over neighbours has left there for the picture.
struct FoundValue {
    HD static real of(const Particles& p, int i) { return load(p.normalLength, i); }
};
struct IdValue {
    HD static real of(const Particles& p, int i) { return real(p.id[i]); }
};

struct ValueRange {
    float low = 3.4e38f, high = -3.4e38f;
    HD_OUT void add(const ValueRange& o) {
        low = o.low < low ? o.low : low;
        high = o.high > high ? o.high : high;
    }
};

// Where vertices go: by ids, or where particles come and go by numbers without gaps, slot by slot.
struct VertexPlaces {
    Vertex* out;
    const int* numbers;  // null: by ids
};
// The numbers where no slot below the last particle's is empty.
struct NumberSlots {
    using Index = int;
    int* numbers;
    HD void operator()(int i) const { numbers[i] = i; }
};

// Position and value of each particle; the range of the values comes with it.
template <class Value> struct WriteVertices {
    Particles p;
    VertexPlaces to;
    HD void addTo(ValueRange& range, int i) const {
        if (p.id[i] < 0) return;
        const Vector<real> x = load(p.position, i);
        const float value = float(Value::of(p, i));
        to.out[to.numbers ? to.numbers[i] : p.id[i]] = {float(x.x), float(x.y), float(x.z), value};
        range.add({value, value});
    }
};

// The same for the boundary particles with the first ids; 1 for those of solids, ids below
// solidsEnd, 0 for the domain's walls. What thin solids have beyond themselves is shown on them.
struct WriteWallVertices {
    using Index = int;
    View v;
    WallsAtHome home;
    Vertex* out;
    int solidsEnd, end;
    HD void operator()(int i) const {
        const Particles& p = v.walls;
        if (p.id[i] < 0 || p.id[i] >= end) return;
        Vector<real> x = load(p.position, i);
        const int solid = home.solidOf(p.id[i]);
        if (solid >= 0 && v.solids[solid].grace > 0) x = onThin(v.solids[solid], p.id[i], x);
        out[p.id[i]] = {float(x.x), float(x.y), float(x.z), p.id[i] < solidsEnd ? 1.0f : 0.0f};
    }
    HD Vector<real> onThin(const SolidState& s, int id, Vector<real> x) const {
        const Vector<real> at = load(home.position, id - home.firstId) - s.home;
        Vector<real> n{0, 0, 0};
        if (surface(s, at, n) <= 0) return x;
        Vector<real> on = at - load(home.face, id - home.firstId);
        for (int k = 0; k < s.planes; ++k)
            on = subtractScaled(on, max(dot(s.normal[k], on) - s.offset[k], real(0)), s.normal[k]);
        return x + turned(s, on - at);
    }
};

// How the values are spread over a range.
template <class Value> struct CountValues {
    static constexpr int bins = 512;
    Particles p;
    const ValueRange* range;
    HD_OUT int bin(int i) const {
        const float low = range->low, high = range->high;
        if (p.id[i] < 0 || !(high > low)) return -1;
        const float share = (float(Value::of(p, i)) - low) / (high - low);
        return share >= 0 ? int((share < 1 ? share : 1) * (bins - 1))
                          : -1;  // division may round up a bit
    }
};

// Sums over the fluid, in double precision.
struct Totals {
    double mass = 0, speed2 = 0, density = 0, compression = 0,
           position2 = 0;  // in masses of the scene's fluid: all but densities
    double velocity[3] = {0, 0, 0}, position[3] = {0, 0, 0}, turning[3] = {0, 0, 0};  // x cross u
    double maxSpeed2 = 0, maxRatio = 0;  // density / that at rest
    int64_t notFinite = 0;
    HD_OUT void add(const Totals& o) {
        mass += o.mass, speed2 += o.speed2, density += o.density, compression += o.compression,
            position2 += o.position2;
        for (int k = 0; k < 3; ++k) {
            velocity[k] += o.velocity[k], position[k] += o.position[k], turning[k] += o.turning[k];
        }
        maxSpeed2 = o.maxSpeed2 > maxSpeed2 ? o.maxSpeed2 : maxSpeed2;
        maxRatio = o.maxRatio > maxRatio ? o.maxRatio : maxRatio;
        notFinite += o.notFinite;
    }
};
struct SumUp {
    Particles p;
    double restDensity;
    HD void addTo(Totals& t, int i) const {
        if (p.id[i] < 0) return;
        const Vector<real> x = load(p.position, i), u = load(p.velocity, i);
        const double mass = massRatio(p, i), ratio = load(p.density, i) / restDensity,
                     excess = ratio - 1, rho = densityOf(p, i);
        const double ux = u.x, uy = u.y, uz = u.z, speed2 = ux * ux + uy * uy + uz * uz;
        Totals one;
        one.mass = mass, one.speed2 = mass * speed2, one.maxSpeed2 = speed2;
        one.density = rho, one.maxRatio = ratio;
        one.compression = excess > 0 ? excess : 0;
        one.velocity[0] = mass * ux, one.velocity[1] = mass * uy, one.velocity[2] = mass * uz;
        one.position[0] = mass * x.x, one.position[1] = mass * x.y, one.position[2] = mass * x.z;
        one.turning[0] = mass * (x.y * uz - x.z * uy),
        one.turning[1] = mass * (x.z * ux - x.x * uz),
        one.turning[2] = mass * (x.x * uy - x.y * ux);
        one.position2 = mass * (double(x.x) * x.x + double(x.y) * x.y + double(x.z) * x.z);
        const double sum = speed2 + rho + double(x.x) + double(x.y) + double(x.z);
        one.notFinite = sum - sum == 0 ? 0 : 1;
        t.add(one);
    }
};

// Where a particle is: its slot's number, from 1 on; 0 where there is none.
struct SlotFound {
    int number = 0;
    HD_OUT void add(const SlotFound& o) { number += o.number; }
};
struct FindSlot {
    const int* id;
    int wanted;
    HD void addTo(SlotFound& found, int slot) const {
        if (id[slot] == wanted) found.add({slot + 1});
    }
};

}  // namespace spindrift::LANES
