#pragma once
// Gauges in the fluid: what a scene's probes read.
#include "measure/interpolate.h"
#include "measure/time_series.h"
#include "sim/neighbours/line_of_sight.h"

#include <string>
#include <vector>

namespace spindrift {

// Of a scene's output.probes. Points are reached by particles within the support radius, also over
// periodic sides.
//   point   pressure, density and velocity there, or their mean over a sensor: 3 x 3 (x 3) points
//   of a disc in a face of the domain, or
//           of a ball, evenly spread; 0 where there is no fluid
//   line    the same at `count` points
//   height  along its axis the upper end of the highest stretch of water: where the share of volume
//   that particles fill,
//           sum m / rho0 W, mirrored at walls, is above a half. A stretch shorter than a support
//           radius counts at the lower end only, where it lies on the floor: elsewhere it is spray.
//           Without water the domain's lower end
//   front   along its axis, how far 99.5 % of the particles have come: the last half per cent may
//   be spray
class Probes {
public:
    explicit Probes(const Scene&);
    bool any() const { return !columns_.empty(); }
    // "<name>.pressure" in Pa, "<name>[3].velocity_x" in m/s, "<name>.height" in m and so on, in
    // the scene's order.
    const std::vector<Column>& columns() const { return columns_; }
    // The number of a column. Throws Error (Scene) when there is none of this name.
    size_t column(const std::string& name) const;
    // One reading for each column. Thin solids, where they are now, hide what is behind them;
    // without their poses they hide nothing.
    std::vector<double> read(const std::vector<Particle>&,
                             const std::vector<SolidPose>& solids = {}) const;
    bool looksPastSolids() const { return sight_.anyThin(); }
    // One line about those that solids are over where the run stands, "" when there are none:
    // points inside of one read nothing, or what is on its other side. A gauge through a solid
    // counts when it finds no water: over a beach or a block under water it is where it should be.
    std::string hiddenBySolids(const Scene&, Simulation&) const;

private:
    // Points whose fields are one probe's; `perReading` of them make a mean.
    struct Fielded {
        PointsNear near;
        Order order;
        size_t perReading;
    };
    struct Gauge {
        PointsNear near;
        double low, step, thinnest, share;
    };  // m, m, m; V W(0), what one particle fills
    struct Reader {
        ProbeKind kind;
        size_t index;
    };  // among those of its sort; a front: its axis

    void addFielded(const Scene&, const Probe&);
    void addGauge(const Scene&, const Probe&);
    static double heightOf(const Gauge&, const std::vector<Particle>&, const Sees& = {});
    Sees sightPast(const std::vector<SolidPose>&) const;

    LineOfSight sight_;
    Vec3d low_;  // m, of the domain
    std::vector<Column> columns_;
    std::vector<Reader> readers_;
    std::vector<Fielded> fielded_;
    std::vector<Gauge> gauges_;
};

// m, along the axis: the place that 99.5 % of the particles have not passed.
double frontOf(const std::vector<Particle>&, Axis);

}  // namespace spindrift
