#define SPINDRIFT_REAL double
#define LANES doubles
#include "sim/neighbours/line_of_sight.h"

#include "device/omp.h"
#include "sim/parts/solids.h"

namespace spindrift {

using namespace doubles;

struct LineOfSight::Solids {
    std::vector<SolidState> states;
    std::vector<double> fields;
    std::vector<int> thin;
    StepParameters c{};
    Vector<real> size;
    double spacing;
};

LineOfSight::LineOfSight(const Scene& scene) {
    const auto solids = std::make_shared<Solids>();
    for (const Solid& solid : scene.solids) {
        if (thinness(scene, solid) > 0) solids->thin.push_back(int(solids->states.size()));
        solids->states.push_back(solidAtHome(scene, solid));
    }
    solids_ = solids;
    if (!anyThin()) return;
    solids->fields = fieldsOf(scene, solids->states);
    pointToFields(solids->states, solids->fields.data());
    solids->size = toReal(scene.domain.size());
    solids->spacing = scene.simulation.spacing;
    StepParameters& c = solids->c;
    c.support = supportRadius(scene);
    auto period = [&](int k) { return scene.domain.periodic(k) ? scene.domain.size()[k] : 0.0; };
    auto inverse = [](double a) { return a > 0 ? 1 / a : 0; };
    c.period = {period(0), period(1), period(2)};
    c.inversePeriod = {inverse(c.period.x), inverse(c.period.y), inverse(c.period.z)};
    c.periodic = c.period.x > 0 || c.period.y > 0 || c.period.z > 0;
}

bool LineOfSight::anyThin() const { return !solids_->thin.empty(); }

std::function<double(Vec3d, Vec3d)> LineOfSight::past(const std::vector<SolidPose>& poses) const {
    const auto now = std::make_shared<Solids>(*solids_);
    pointToFields(now->states, now->fields.data());
    const int count = int(now->states.size());
    for (size_t k = 0; k < now->states.size(); ++k) {
        SolidState& s = now->states[k];
        s.middle = toReal(poses[k].middle);
        for (int a = 0; a < 3; ++a) s.axis[a] = toReal(poses[k].axis[a]);
    }
    for (int k = 0; k < count; ++k)
        MeetWalls{now->states.data(), count, now->c, now->size, now->spacing}(k);
    return [now](Vec3d from, Vec3d to) {
        const Screens screens{
            now->states.data(), now->thin.data(), int(now->thin.size()), now->c, 0, nullptr, {}, {},
            now->spacing};
        const Vector<real> x = toReal(from);
        return sightOf(screens, x, imageOf(now->c, x - toReal(to)), -1);
    };
}

}  // namespace spindrift
