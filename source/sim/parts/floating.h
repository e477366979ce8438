// Solids that float or are dragged, on one device.
#pragma once

#include "scene/mass.h"
#include "sim/parts/floating_passes.h"
#include "sim/parts/solids.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace spindrift::LANES {

// Owns what is known of solids as bodies that move by themselves or are dragged.
template <class Device> class Floating : public Part {
public:
    Floating(Flow<Device>& flow, Solids<Device>& solids)
        : flow_(flow), device_(flow.device), solids_(solids) {
        for (const Solid& solid : flow.scene.solids) {
            const SolidSample& sample = flow.solidSamples[onHost_.size()];
            onHost_.push_back(bodyOf(flow.scene, solid, sample));
            faces_.push_back(solid.floats() ? ballsOfAFace(flow.scene, solid, sample) : 1);
        }
        loads_.resize(onHost_.size()), touches_.resize(onHost_.size()), also_.resize(1);
        room_.resize(1), target_.resize(1);
        takeInHand(-1);
        if (solids.floats())
            bounces(std::max((flow.fluidCount + clusterSize - 1) / clusterSize * clusterSize,
                             flow.fluid.reserved()));
    }
    // Null where none floats.
    const RigidBody* bodies() const { return solids_.floats() ? bodies_.data() : nullptr; }
    Springs springs() const { return springs_; }
    int held() const { return held_; }

    // The mouse pulls at a solid, or lets it go; says whether that is another one than before.
    bool hold(const Hold& h) {
        const Vec3 target = h.target - flow_.scene.domain.min;
        device_.upload(target_.data(), &target, 1);
        if (h.solid == held_) return false;
        device_.forEach(int(onHost_.size()), LetGo{bodies_.data(), motions_.data()});
        takeInHand(h.solid);
        return true;
    }
    // `sum(solid)` is the reduction over `count` of what else touches it.
    template <class Sum> void addTouches(int count, const Sum& sum) {
        forFloating([&](int s) {
            device_.reduce(count, sum(s), also_.data());
            device_.forEach(1, AddTouch{also_.data(), touches_.data() + s});
        });
    }
    // What the solid in hand gave to `count` others.
    template <class Sum> void feelStops(int count, const Sum& sum) {
        device_.reduce(count, sum, stops_.data());
    }

    // --- as a part (part.h) ---

    static constexpr bool feelsPressure = true;

    void restart(const RunState& state) {
        std::vector<SolidMotion> motions = state.solids;
        for (size_t s = motions.size(); s < onHost_.size(); ++s)
            motions.push_back(flow_.scene.solids[s].floats()
                                  ? motionAtHome(flow_.scene, flow_.scene.solids[s], onHost_[s])
                                  : SolidMotion{});
        CHECK(motions.size() == onHost_.size());
        motions_.fill(motions);
        solids_.followBodies(bodies_.data(), motions_.data());
    }
    void save(RunState& state) {
        if (!solids_.moves()) return;
        state.solids.resize(motions_.size());
        device_.download(state.solids.data(), motions_.data(), motions_.size());
    }
    // How balls press: a face full of them swings a fifth of a radian in the longest step.
    void knowLongestStep(double step) {
        const double rate = 0.2 / step,
                     lost = std::log(std::max(double(flow_.scene.walls.restitution), 1e-6)),
                     ratio = -lost / std::hypot(lost, std::numbers::pi);
        springs_ = {real(rate), real(ratio)};
        for (size_t s = 0; s < onHost_.size(); ++s) {
            if (onHost_[s].mass <= 0) continue;
            onHost_[s].stiffness = real(onHost_[s].mass * rate * rate / faces_[s]);
            onHost_[s].damping = real(2 * ratio * onHost_[s].mass * rate / faces_[s]);
        }
        bodies_.fill(onHost_);
        solids_.followBodies(bodies_.data(), motions_.data());
    }
    void addForces(Plan& plan, Initial initial) {
        plan.add(
            "solid forces", [this] { findForces(); }, initial,
            held_ >= 0 ? "" : solids_.whyNoneFloats());
    }
    void move(Plan& plan, ShareOfStep share) {
        plan.add(
            "floating solids", [this, share] { moveBodies(share); }, Initial::No,
            held_ >= 0 && share.drifts ? "" : solids_.whyNoneFloats());
    }
    void collide(Plan& plan) {
        plan.add(
            "solid collisions", [this] { keepOut(); }, Initial::No,
            solids_.count() > 0 ? "" : "there are no solids");
    }

private:
    template <class F> void forFloating(const F& f) {
        for (size_t s = 0; s < flow_.scene.solids.size(); ++s)
            if (flow_.scene.solids[s].floats()) f(int(s));
    }
    void findForces() {
        solids_.findLoads();
        const View v = flow_.view();
        if (handMass_ > 0)
            device_.reduce(v.walls.slots, solids_.sumOf(v, held_), loads_.data() + held_);
        forFloating([&](int s) {
            device_.reduce(v.walls.slots, solids_.sumOf(v, s), loads_.data() + s);
            device_.reduce(v.walls.slots, SumTouches{v, solids_.home(), bodies_.data(), s},
                           touches_.data() + s);
        });
    }
    void moveBodies(ShareOfStep share) {
        if (handMass_ > 0)
            device_.reduce(flow_.walls.slots(),
                           FindRoom{flow_.view(), solids_.home(), bodies_.data(), held_},
                           room_.data());
        device_.forEach(solids_.count(), MoveFloating{flow_.view(),
                                                      bodies_.data(),
                                                      motions_.data(),
                                                      loads_.data(),
                                                      touches_.data(),
                                                      double(particleMass(flow_.scene)),
                                                      held_,
                                                      target_.data(),
                                                      {handMass_, stops_.data(), room_.data()},
                                                      0.5 * share.halvesOfKick,
                                                      share.drifts ? 1.0 : 0.0});
    }
    void keepOut() {
        if (solids_.moves()) solids_.sweep();
        const int slots = flow_.fluid.slots();
        const bool floats = solids_.floats();
        device_.forEach(slots, KeepOutOfSolids{flow_.view(), floats ? bounces(slots) : Bounces{}});
        if (floats) takeMomentum(flow_.view());
    }
    Bounces bounces(int slots) {
        change_.resize(vectorSize(slots)), stoppedBy_.resize(size_t(slots));
        return {{change_.data()}, {stoppedBy_.data()}};
    }
    void takeMomentum(const View& v) {
        forFloating([&](int s) {
            device_.reduce(
                v.fluid.slots,
                SumBounces{v, bounces(v.fluid.slots), real(particleMass(flow_.scene)), s},
                touches_.data() + s);
        });
        device_.forEach(v.solidCount, TakeMomentum{bodies_.data(), touches_.data(), motions_.data(),
                                                   flow_.scene.simulation.dimensions});
    }
    // From now on the mouse holds this one, -1: none.
    void takeInHand(int solid) {
        stops_.fill(std::vector<Stops>(1)), loads_.fill(std::vector<SolidLoad>(onHost_.size()));
        handMass_ = 0, held_ = solid;
        if (solid < 0 || flow_.scene.solids[size_t(solid)].floats()) return;
        solids_.reserveLoads();
        handMass_ = massInHand(flow_.scene, flow_.scene.solids[size_t(solid)]);
    }
    // Of fluid in its place, kg; thin ones take more along than that, planes all of it.
    double massInHand(const Scene& scene, Solid solid) const {
        if (solid.shape == Shape::Plane) return particleMass(scene) * flow_.fluidCount;
        solid.density = scene.fluid.restDensity;
        Vec3d side = 2.0 * halfExtent(solid);
        if (scene.simulation.dimensions == 2) side.z = 0;
        if (side.x < side.y) std::swap(side.x, side.y);
        if (side.y < side.z) std::swap(side.y, side.z);
        if (side.x < side.y) std::swap(side.x, side.y);
        const double along =
            scene.simulation.dimensions == 2 ? side.x * side.x : side.x * side.y * side.y;
        return std::max(massOf(scene, solid).mass, 0.1 * double(solid.density) * along);
    }
    static real deepestBall(const Scene& scene) { return real(0.75) * scene.simulation.spacing; }
    static RigidBody bodyOf(const Scene& scene, const Solid& solid, const SolidSample& sample) {
        const real hard = real(1e30);
        RigidBody body{0, {}, {{}, {}, {}}, hard, hard, solid.friction, deepestBall(scene)};
        if (!solid.floats()) return body;
        const Mass mass = massOf(scene, solid);
        body.mass = mass.mass, body.centre = mass.centre;
        double area = 0;  // m^2
        for (const Vec3d& a : surfaceAreas(scene, solid, sample)) area += length(a);
        const double layer =
            double(scene.fluid.restDensity) * double(scene.simulation.spacing) * area;
        body.told = body.mass / (body.mass + layer);
        invertTransposed(mass.inertia, body.inverseInertia);
        return body;
    }
    // As if it were a cube.
    static double ballsOfAFace(const Scene& scene, const Solid& solid, const SolidSample& sample) {
        const Convex shape = convexOf(solid, scene.simulation.dimensions);
        double outermost = 0;
        for (size_t i = 0; i < sample.positions.size(); ++i) {
            const Vec3d at = toDouble(sample.positions[i] + scene.domain.min) - shape.middle;
            if (sample.faces.empty())
                outermost += -shape.nearest(at).distance <= double(deepestBall(scene));
            else
                outermost += length(toDouble(sample.faces[i])) <= double(deepestBall(scene)) &&
                             shape.nearest(at - toDouble(sample.faces[i])).distance < 1e-6;
        }
        return std::max(1.0, outermost / (2 * scene.simulation.dimensions));
    }
    static SolidMotion motionAtHome(const Scene& scene, const Solid& solid, const RigidBody& body) {
        SolidMotion m;
        const SolidState home = solidAtHome(scene, solid);
        const int axis = int(solid.spinAxis);
        Vec3d angle;
        angle[axis] = double(solid.turn) * std::numbers::pi / 180;
        turnBy(m.turn, angle);
        const Turn turn(m.turn);
        m.centre = Vec3d{home.middle.x, home.middle.y, home.middle.z} + turn.out(body.centre);
        m.velocity = toDouble(solid.velocity);
        m.angularMomentum = (double(solid.spin) * std::numbers::pi / 180) *
                            turn.out(massOf(scene, solid).inertia[axis]);
        return m;
    }

    Flow<Device>& flow_;
    Device& device_;
    Solids<Device>& solids_;
    int held_ = -1;                         // by the mouse
    Buffer<Vec3, Device> target_{device_};  // where it is wanted, in MoveFloating
    std::vector<RigidBody> onHost_;
    std::vector<double> faces_;  // balls of a face of each
    Springs springs_{};
    Buffer<RigidBody, Device> bodies_{device_};
    Buffer<SolidMotion, Device> motions_{device_};
    Buffer<SolidLoad, Device> loads_{device_};
    Buffer<Wrench, Device> touches_{device_}, also_{device_};
    double handMass_ = 0;                                        // kg
    Buffer<Stops, Device> stops_{device_};                       // of what the mouse holds
    Buffer<Room, Device> room_{device_};                         // likewise
    Buffer<real, Device> change_{device_}, stoppedBy_{device_};  // of fluid, see Bounces
};

}  // namespace spindrift::LANES
