// Solids in the fluid and the box around it, on one device.
#pragma once

#include "core/error.h"
#include "scene/mass.h"
#include "scene/sample_solid.h"
#include "scene/thin_solid.h"
#include "sim/step/flow.h"
#include "sim/parts/part.h"
#include "sim/parts/solid_at_home.h"
#include "sim/parts/solid_loads.h"
#include "sim/parts/solid_passes.h"
#include "sim/physics/walls.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace spindrift::LANES {

inline constexpr const char* faceNames[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};

// Owns the solids and what their particles and those of the domain's walls have from the start.
template <class Device> class Solids : public Part {
public:
    explicit Solids(Flow<Device>& flow)
        : flow_(flow), device_(flow.device), firstId_(flow.fluidCount) {
        const Scene& scene = flow.scene;
        std::vector<SolidState> states;
        std::vector<MotionKey> keys;
        for (const Solid& solid : scene.solids) {
            states.push_back(solidAtHome(scene, solid));
            states.back().firstKey = int(keys.size());
            for (const MotionKey& key : motionOf(solid)) keys.push_back(key);
            states.back().endKey = int(keys.size());
            states.back().steady = solid.keyframes.empty();
            speed_ = std::max(speed_, spindrift::largestSpeed(solid));
        }
        count_ = int(states.size());
        moves_ = std::any_of(scene.solids.begin(), scene.solids.end(),
                             [](const Solid& s) { return s.moves(); });
        floats_ = std::any_of(scene.solids.begin(), scene.solids.end(),
                              [](const Solid& s) { return s.floats(); });
        std::vector<int> thin;
        for (int s = 0; s < count_; ++s)
            if (states[size_t(s)].grace > 0) thin.push_back(s);
        thin_.fill(thin);
        spacing_ = scene.simulation.spacing;
        fields_.fill(fieldsOf(scene, states));
        pointToFields(states, fields_.data());
        states_.fill(states), keys_.fill(keys);
        const Vec3 size = scene.domain.max - scene.domain.min;
        size_ = {real(size.x), real(size.y), real(size.z)};
        flow.solids = states_.data(), flow.solidCount = count_;
        if (count_ == 0) {
            if (wallsMove()) flow.walls.move();
            return;
        }
        placeParticles(scene, flow.wallsAtHome, flow.solidSizes);
        flow.fluid.keepPlace();
        if (wallsMove()) flow.walls.move();
        if (moves_) flow.walls.accelerate();
        if (floats_) reserveLoads();
    }
    int count() const { return count_; }
    bool moves() const { return moves_; }
    bool floats() const { return floats_; }
    bool anyThin() const { return thin_.size() > 0; }
    const char* whyNoneFloats() const {
        return floats_ ? "" : count_ > 0 ? "no solid floats" : "there are no solids";
    }
    // From now on the mouse may drag those that stood still until now as well: their particles are
    // sorted and placed. True: that is new, and the plan is another one.
    bool letMove() {
        if (moves_) return false;
        keepMasses(flow_.walls.view());
        moves_ = true;
        flow_.walls.accelerate();
        // Into the order that they have: makes room for others. A particle on the face of a cell
        // may change sides by a rounding.
        flow_.search.sortWalls(flow_.walls);
        flow_.search.outdate();
        return true;
    }
    // How those that float or are dragged move; not owned.
    void followBodies(const RigidBody* bodies, const SolidMotion* motions) {
        bodies_ = bodies, motions_ = motions;
    }
    // The walls' particles: weighed, and put in order for good where they never move.
    void weighWalls() {
        if (anyTurned()) placeWalls(flow_.view());
        flow_.search.sortWalls(flow_.walls);
        flow_.search.amongWalls(flow_.walls, supportRadius(flow_.scene), [&] {
            withCompiledKernel(flow_.scene.simulation.kernel, [&](auto kernel) {
                flow_.template onWalls<ComputeWallMass<decltype(kernel)>>();
            });
        });
        if (moves_) return keepMasses(flow_.walls.view());
        placeWalls(flow_.view());
        flow_.walls.keepOrder();
    }

    // --- as a part (part.h) ---

    void refresh() {
        const Scene& scene = flow_.scene;
        if (letsSlip(scene)) flow_.walls.letSlip();
        if (!*whyFlowEndsAtWalls()) flow_.walls.continueFlow();
        const bool sticksNow = flow_.fluidSticks() && flow_.walls.carryVelocity();
        withCompiledKernel(scene.simulation.kernel, [&](auto kernel) {
            loads_.template choose<decltype(kernel)>();
            continueFlow_ =
                &Flow<Device>::template onWalls<ContinueFlowIntoWalls<decltype(kernel)>>;
        });
        if (anyThin()) screen();
        // A face slides at another speed or lets fluid slip, or walls are to know which way they
        // face.
        if (sticksNow || ((wallsMove() || flow_.walls.slips()) && !moves_))
            placeWalls(flow_.view());
    }
    double fastestSpeed() const {
        double most = speed_;
        for (int s = 0; s < count_; ++s) most = std::max(most, double(states_.data()[s].speed));
        return most;
    }
    void sorted() {
        if (moves_) {
            flow_.search.sortWalls(flow_.walls);
            placeWalls(flow_.view());  // all but their places, which the sort took along
        }
        if (!anyThin()) return;
        device_.forEach(count_,
                        MeetWalls{states_.data(), count_, flow_.model.shared, size_, spacing_});
        flow_.search.findSides(flow_.view());
    }
    // The clock is at the step's end, what floats at its beginning.
    void place(Plan& plan, Initial initial, bool halfWay) {
        plan.add(
            "solids", [this, halfWay] { placeNow(halfWay ? 0.5 : 0); }, initial,
            moves_       ? ""
            : count_ > 0 ? "no solid moves"
                         : "there are no solids");
    }
    void addRates(Plan& plan) {
        // A step late light bodies would swing against the fluid that they press together.
        plan.add(
            "velocity of walls",
            [this] {
                const View v = flow_.view();
                device_.forEach(v.walls.slots, TellVelocity{v, home(), bodies_, motions_});
            },
            Initial::No, whyNoneFloats());
        plan.add(
            "flow at walls", [this] { (flow_.*continueFlow_)(); }, Initial::No,
            whyFlowEndsAtWalls());
    }

    // To where they are; `halfWay` of a step back.
    void placeNow(double halfWay = 0) {
        moveTo(halfWay, halfWay);
        placeWalls(flow_.view());
    }
    // To the end of a step, which the solids remember to have begun where they were then.
    void sweep() {
        moveTo(1, -1);
        device_.forEach(count_, RememberPose{states_.data()});
        moveTo(0, 0);
        device_.forEach(count_, MeasureTurn{states_.data(), flow_.clock.data()});
    }

    // What fluid does to each of their particles, and the sum over those of one solid. What floats
    // moves by its own particles' loads, what is told has those of its feet too.
    void findLoads(bool withFeet = false) { loads_.find(home(), bodies_, withFeet); }
    // A recorded step can't make room.
    void reserveLoads() { loads_.reserve(flow_.walls.slots()); }
    SumWallPower findPower(bool isViscous, bool isArtificial, ScalarField noPressure) {
        return loads_.findPower(home(), isViscous, isArtificial, noPressure);
    }
    SumSolidLoad sumOf(const View& v, int solid) { return loads_.sumOf(v, solid); }
    // Each where the fluid is since the last step, and what fluid does to it; and to the faces.
    void measure(Measurement& m) {
        if (moves_) placeNow();
        const bool ofFaces = flow_.scene.output.faceForces;
        if (count_ > 0 || ofFaces) findLoads(true);
        const View v = flow_.view();
        const std::vector<SolidState> states = states_.download();
        const double mass = particleMass(flow_.scene);
        auto scaled = [&](const double* a) { return mass * Vec3d{a[0], a[1], a[2]}; };
        for (int s = 0; s < count_; ++s) {
            const SolidLoad load =
                device_.template sum<SolidLoad>(flow_.walls.slots(), sumOf(v, s));
            const SolidState& state = states[size_t(s)];
            const std::string& name = flow_.scene.solids[size_t(s)].name;
            m.solids.push_back({name.empty() ? "solid" + std::to_string(s) : name,
                                toVec3d(state.middle) + toDouble(flow_.scene.domain.min),
                                toVec3d(state.velocity), toVec3d(state.spin), scaled(load.pressure),
                                scaled(load.other), scaled(load.torque)});
        }
        if (!ofFaces) return;
        for (int axis = 0; axis < flow_.scene.simulation.dimensions; ++axis) {
            if (flow_.scene.domain.periodic(axis)) continue;
            const FaceLoads loads =
                device_.template sum<FaceLoads>(flow_.walls.slots(), loads_.sumOfFaces(v, axis));
            for (int end = 0; end < 2; ++end)
                m.faces.push_back({faceNames[2 * axis + end], scaled(loads.pressure[end]),
                                   scaled(loads.other[end])});
        }
    }
    // Asks for where all are now: poses() and at() say so once the device has been waited for.
    void look() {
        if (moves_) placeNow();
        seen_.resize(states_.size());
        device_.fetch(seen_.data(), states_.data(), seen_.size());
    }
    std::vector<SolidPose> poses() const {
        std::vector<SolidPose> out;
        for (const SolidState& s : seen_)
            out.push_back(
                {toVec3d(s.middle), {toVec3d(s.axis[0]), toVec3d(s.axis[1]), toVec3d(s.axis[2])}});
        return out;
    }
    // The one whose surface is within a spacing of a point, m in world coordinates; -1: none.
    int at(Vec3d point) const {
        const Scene& scene = flow_.scene;
        const Vector<real> x = toReal(point - toDouble(scene.domain.min));
        for (size_t s = 0; s < seen_.size(); ++s) {
            const Vector<real> arm = x - seen_[s].middle;
            const Vector<real> own{dot(arm, seen_[s].axis[0]), dot(arm, seen_[s].axis[1]),
                                   dot(arm, seen_[s].axis[2])};
            if (convexOf(scene.solids[s], scene.simulation.dimensions)
                    .nearest(toVec3d(own))
                    .distance < double(scene.simulation.spacing))
                return int(s);
        }
        return -1;
    }

    WallsAtHome home() {
        return {firstId_,       solidOf_.data(), {position_.data()}, {mass_.data()},
                {area_.data()}, size_,           {face_.data()}};
    }

private:
    void moveTo(double stepsBack, double ahead) {
        device_.forEach(count_, MoveSolids{states_.data(), keys_.data(), flow_.clock.data(),
                                           stepsBack, ahead, bodies_, motions_});
    }
    const char* whyFlowEndsAtWalls() const {
        if (!flow_.wallsCarryPressure() || !carriesDensity(flow_.scene))
            return "no divergence is asked for at walls";
        return moves_ || letsSlip(flow_.scene) ? "" : "no solid moves, and no wall lets slip";
    }
    bool anyTurned() const {
        const std::vector<Solid>& solids = flow_.scene.solids;
        return std::any_of(solids.begin(), solids.end(),
                           [](const Solid& s) { return s.turn != 0; });
    }
    bool wallsMove() const {
        return moves_ || (flow_.wallCount > 0 && flow_.scene.walls.movingFace != Face::None);
    }
    void placeWalls(const View& v) { device_.forEach(v.walls.slots, PlaceWalls{v, home()}); }
    void keepMasses(const Particles& walls) {
        device_.forEach(walls.slots, KeepWallMass{walls, home()});
    }
    // As thin ones separate fluid and walls.
    void screen() {
        const Screens screens{states_.data(),     thin_.data(),    int(thin_.size()),
                              flow_.model.shared, firstId_,        solidOf_.data(),
                              {face_.data()},     {least_.data()}, spacing_};
        screens_.resize(1);
        device_.upload(screens_.data(), &screens, 1);
        flow_.screens = screens_.data();
    }
    void placeParticles(const Scene& scene, const std::vector<Vec3>& walls,
                        const std::vector<int>& sizes) {
        const size_t slots = (walls.size() + clusterSize - 1) / clusterSize * clusterSize;
        std::vector<int> solidOf(slots, -1);
        std::vector<real> mass(slots), area(floats_ ? size_t(vectorSize(int(slots))) : 0);
        std::vector<real> face(anyThin() ? size_t(vectorSize(int(slots))) : 0),
            least(anyThin() ? slots : 0);
        // Volumes are of cells a spacing wide, masses of the fluid's particles.
        const double dx = scene.simulation.spacing,
                     cell = std::pow(dx, scene.simulation.dimensions);
        const float share = hasOwnVolume(scene) ? float(cell / particleVolume(scene)) : 1;
        size_t end = 0;
        for (size_t s = 0; s < scene.solids.size(); ++s) {
            const SolidSample& sample = flow_.solidSamples[s];
            const std::vector<float>& volumes = sample.volumes;
            if (sizes.size() <= s || volumes.size() != size_t(sizes[s]))
                throw Error(Failure::Scene,
                            "solids: the particles of this run are of another version of the "
                            "program; start the scene again");
            std::transform(volumes.begin(), volumes.end(), mass.begin() + long(end),
                           [&](float v) { return real(v * share); });
            std::fill_n(solidOf.begin() + long(end), sizes[s], int(s));
            if (scene.solids[s].floats()) fillAreas(scene, scene.solids[s], sample, int(end), area);
            fillFaces(sample, int(end), face, least);
            end += volumes.size();
        }
        std::vector<real> x(vectorSize(int(slots)));
        for (size_t i = 0; i < walls.size(); ++i)
            for (int k = 0; k < 3; ++k) x[vectorOffset(int(i), k)] = walls[i][k];
        solidOf_.fill(solidOf), position_.fill(x), mass_.fill(mass), area_.fill(area);
        face_.fill(face), least_.fill(least);
    }
    // Seen from any place that is nearer to their face than they are, or for one of the faces as
    // near; those that are beyond their solid from anywhere through it.
    static void fillFaces(const SolidSample& sample, int first, std::vector<real>& face,
                          std::vector<real>& least) {
        for (size_t i = 0; i < sample.faces.size(); ++i, ++first) {
            const Vec3 f = sample.faces[i];
            for (int k = 0; k < 3; ++k) face[size_t(vectorOffset(first, k))] = real(f[k]);
            const bool asNear = f.x != 0 ? f.x < 0 : f.y != 0 ? f.y < 0 : f.z < 0;
            least[size_t(first)] = !sample.beyond[i] ? real(asNear ? -1e-30 : 0) : real(-1e30);
        }
    }
    static void fillAreas(const Scene& scene, const Solid& solid, const SolidSample& sample,
                          int first, std::vector<real>& out) {
        const double perMass = 1 / particleMass(scene);
        for (const Vec3d& area : surfaceAreas(scene, solid, sample)) {
            for (int k = 0; k < 3; ++k)
                out[size_t(vectorOffset(first, k))] = real(perMass * area[k]);
            ++first;
        }
    }

    Flow<Device>& flow_;
    Device& device_;
    void (Flow<Device>::*continueFlow_)() = nullptr;
    const RigidBody* bodies_ = nullptr;
    const SolidMotion* motions_ = nullptr;
    int count_ = 0, firstId_ = 0;
    bool moves_ = false, floats_ = false;
    double speed_ = 0;  // m/s
    Vector<real> size_{};
    Buffer<SolidState, Device> states_{device_};
    std::vector<SolidState> seen_;  // by look()
    Buffer<MotionKey, Device> keys_{device_};
    Buffer<real, Device> fields_{device_};  // of meshes, one after the other
    Buffer<int, Device> solidOf_{device_};
    Buffer<real, Device> position_{device_}, mass_{device_}, area_{device_};
    Buffer<int, Device> thin_{device_};
    Buffer<real, Device> face_{device_}, least_{device_};
    Buffer<Screens, Device> screens_{device_};
    real spacing_ = 0;  // m
    SolidLoads<Device> loads_{flow_};
};

}  // namespace spindrift::LANES
