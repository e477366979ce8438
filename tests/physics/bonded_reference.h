#pragma once
// Bonds, gravity and grips once more, plainly, in double precision and by particles: an
// ObjectDriver, against which the built-in passes are checked.
#include "scene/sample_object.h"
#include "sim/object_driver.h"

#include <cmath>

namespace spindrift {

class BondedReference final : public ObjectDriver {
public:
    // `interval` is cut into `parts` steps of symplectic Euler, in which forces of contact stay
    // what they were.
    BondedReference(const Scene& scene, double interval, int parts)
        : scene_(scene), sample_(sampleObjects(scene)), interval_(interval), parts_(parts) {}

    double interval() const override { return interval_; }
    void exchange(double, const std::vector<Vec3d>& contact, std::vector<Vec3d>& x,
                  std::vector<Vec3d>& u) override {
        const double dt = interval_ / parts_;
        if (kept_.empty()) kept_ = x, moving_ = u;
        for (int part = 0; part < parts_; ++part) {
            std::vector<Vec3d> force = contact;
            for (const Bond& b : sample_.bonds) addBond(b, force);
            for (size_t i = 0; i < x.size(); ++i) {
                if (sample_.grips[i] >= 0) continue;
                moving_[i] = moving_[i] + dt * (toDouble(scene_.simulation.gravity) +
                                                (1 / double(sample_.masses[i])) * force[i]);
                kept_[i] = kept_[i] + dt * moving_[i];
            }
        }
        x = kept_, u = moving_;
    }

private:
    void addBond(const Bond& b, std::vector<Vec3d>& force) const {
        const size_t i = size_t(b.a), j = size_t(b.b);
        const double mi = sample_.masses[i], mj = sample_.masses[j], k = b.stiffness;
        const Vec3d r = kept_[j] - kept_[i], n = normalized(r);
        const double damping = 2 * scene_.objects[size_t(sample_.objects[i])].damping *
                               std::sqrt(k * mi * mj / (mi + mj));
        const Vec3d pull =
            (k * (length(r) - b.length) + damping * dot(moving_[j] - moving_[i], n)) * n;
        force[i] = force[i] + pull, force[j] = force[j] - pull;
    }

    const Scene& scene_;
    ObjectSample sample_;
    double interval_;
    int parts_;
    std::vector<Vec3d> kept_, moving_;  // its own places and velocities: no float between
};

}  // namespace spindrift
