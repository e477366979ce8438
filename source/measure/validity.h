#pragma once
// What of a run lies outside of what its method is valid for, and what would mend it.
#include "scene/scene.h"
#include "sim/simulation.h"

#include <string>
#include <vector>

namespace spindrift {

// One line: "mean compression: 24 % at 0.2 s, above 3 %; ...". What stands before the colon is the
// remark's key: there is one remark for each, of when it was first to be made.
struct Remark {
    std::string text;
    double time = 0;  // s simulated
};
std::string keyOf(const std::string& remark);

// Of a scene, before it runs: a support, a body of fluid or a gap of fewer than two spacings; a
// rod so thin that fluid on its two sides is within a support radius, so that each feels the other;
// pressures that are solved for where there is no free surface.
std::vector<std::string> remarksOn(const Scene&);

// Watches one run: the scene's remarks, and those of what is measured. A weakly compressible fluid
// stands for an incompressible one while its density and its Mach number stay low (Monaghan 1994
// aims at 1 % and 0.1).
class Validity {
public:
    static constexpr double MostCompression = 0.03,
                            MostMach = 0.3;  // mean, but for the classic formulation

    explicit Validity(const Scene&);
    void look(const Measurement&);
    // The run has gone back to this time, s.
    void dropAfter(double time);
    const std::vector<Remark>& remarks() const { return remarks_; }

private:
    void remark(std::string text, double time);

    bool isClassic_;
    std::string sources_;  // names of all
    std::vector<Remark> remarks_;
};

}  // namespace spindrift
