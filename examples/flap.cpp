// A physics engine of one's own that moves an elastic object: here the engine is a hinge, which
// swings a stiff flap to and fro in a tank of water. Prints what it costs to do so. Build: as
// examples/CMakeLists.txt says, or with the program. Run: build/flap_example [seconds]
#include <spindrift/spindrift.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

using namespace spindrift;

namespace {

constexpr double pi = 3.14159265358979323846;

// A tank a metre long with a sheet that stands on its floor, from wall to wall.
constexpr const char* TankWithFlap = R"({
    "version": 2,
    "name": "tank with a flap",
    "simulation": { "spacing": 0.025 },
    "domain": { "min": [0, 0, 0], "max": [1, 0.5, 0.2] },
    "objects": [{ "shape": "sheet", "min": [0.3, 0.025, 0.0125], "max": [0.3, 0.425, 0.1875],
                   "thickness": 0.01 }],
    "fluid": { "bodies": [{ "shape": "block", "min": [0, 0, 0], "max": [1, 0.3, 0.2] }] }
})";

// Turns every particle about the hinge at the flap's foot, by an angle that the engine alone
// decides.
class Hinge final : public ObjectDriver {
public:
    explicit Hinge(Vec3d foot) : foot_(foot) {}

    // A thousand times a second, whatever steps the fluid takes.
    double interval() const override { return 0.001; }

    void exchange(double time, const std::vector<Vec3d>& forces, std::vector<Vec3d>& positions,
                  std::vector<Vec3d>& velocities) override {
        // The work that the flap has done on the water since the last exchange: minus force times
        // velocity.
        for (size_t i = 0; i < forces.size(); ++i)
            work_ -= dot(forces[i], velocities[i]) * (time - before_);
        before_ = time;
        // Where all are at the end of the interval. Particles keep their height on the flap, which
        // the first exchange tells.
        if (heights_.empty())
            for (const Vec3d& x : positions) heights_.push_back(x.y - foot_.y);
        const double angle = angleAt(time + interval()),
                     rate = (angleAt(time + 1.001 * interval()) - angle) / (0.001 * interval());
        for (size_t i = 0; i < positions.size(); ++i) {
            const Vec3d along{std::sin(angle), std::cos(angle), 0},
                across{std::cos(angle), -std::sin(angle), 0};
            positions[i] = foot_ + heights_[i] * along + Vec3d{0, 0, positions[i].z - foot_.z};
            velocities[i] = (rate * heights_[i]) * across;
        }
    }
    double angle() const { return angleAt(before_); }  // rad
    double work() const { return work_; }              // J

private:
    // Begins gently: 20 degrees to either side, once in 1.2 seconds.
    static double angleAt(double time) {
        return std::min(time / 0.5, 1.0) * 20 * pi / 180 * std::sin(2 * pi * time / 1.2);
    }

    Vec3d foot_;
    std::vector<double> heights_;
    double before_ = 0, work_ = 0;
};

void run(double seconds) {
    const Scene scene = parseScene(TankWithFlap, "flap.cpp");
    const auto simulation = makeSimulation(scene);
    Hinge hinge({0.3, 0.025, 0.1});
    simulation->drive(&hinge);
    std::printf("%d particles of water, %d of the flap, on %s\n", simulation->fluidCount(),
                simulation->objectParticleCount(), simulation->deviceName().c_str());
    std::printf("%8s %14s %14s %16s\n", "time, s", "angle, degrees", "work done, J",
                "kinetic energy, J");
    for (double time = 0.1; time < seconds + 0.05; time += 0.1) {
        simulation->stopAt(time);
        while (simulation->clock().time < time) simulation->step();
        std::printf("%8.2f %14.2f %14.4f %16.4f\n", time, hinge.angle() * 180 / pi, hinge.work(),
                    simulation->measure().kineticEnergy);
    }
}

}  // namespace

int main(int count, char** arguments) {
    try {
        const double seconds = count > 1 ? std::atof(arguments[1]) : 1.2;
        if (!(seconds > 0 && seconds <= 100))
            throw Error(
                Failure::Usage,
                "flap_example: seconds must lie above 0 and up to 100, e.g. flap_example 2");
        run(seconds);
    } catch (const Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
