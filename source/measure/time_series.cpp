#include "measure/time_series.h"

#include "core/error.h"
#include "core/hdf5_file.h"
#include "core/output_file.h"
#include "core/units.h"

#include "measure/validity.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace spindrift {
namespace {

struct Quantity {
    const char *name, *unit;
    double (*of)(const Measurement&);
    bool hasDepth = false;  // in two dimensions it is per metre of depth
};

// The first columns, in their order; those of the caller and the passes' times, averages of one
// run, follow them.
constexpr Quantity Quantities[] = {
    {"time", "s", [](const Measurement& m) { return m.time; }},
    {"step", "", [](const Measurement& m) { return double(m.steps); }},
    {"dt", "s", [](const Measurement& m) { return m.dt; }},
    {"kinetic_energy", "J", [](const Measurement& m) { return m.kineticEnergy; }, true},
    {"potential_energy", "J", [](const Measurement& m) { return m.potentialEnergy; }, true},
    {"momentum_x", "kg m/s", [](const Measurement& m) { return m.momentum.x; }, true},
    {"momentum_y", "kg m/s", [](const Measurement& m) { return m.momentum.y; }, true},
    {"momentum_z", "kg m/s", [](const Measurement& m) { return m.momentum.z; }, true},
    {"angular_momentum_x", "kg m²/s", [](const Measurement& m) { return m.angularMomentum.x; },
     true},
    {"angular_momentum_y", "kg m²/s", [](const Measurement& m) { return m.angularMomentum.y; },
     true},
    {"angular_momentum_z", "kg m²/s", [](const Measurement& m) { return m.angularMomentum.z; },
     true},
    {"center_of_mass_x", "m", [](const Measurement& m) { return m.centerOfMass.x; }},
    {"center_of_mass_y", "m", [](const Measurement& m) { return m.centerOfMass.y; }},
    {"center_of_mass_z", "m", [](const Measurement& m) { return m.centerOfMass.z; }},
    {"mean_density", "kg/m³", [](const Measurement& m) { return m.meanDensity; }},
    {"density_error", "1", [](const Measurement& m) { return m.densityError; }},
    {"max_density_error", "1", [](const Measurement& m) { return m.maxDensityError; }},
    {"max_speed", "m/s", [](const Measurement& m) { return m.maxSpeed; }},
    {"evaluations", "",
     [](const Measurement& m) {
         return m.evaluations;
     }},  // of a particle's forces, since the beginning
};

// Of the formulation that solves for pressures.
constexpr Quantity SolveQuantities[] = {
    {"iterations", "", [](const Measurement& m) { return double(m.solve.iterations); }},
    {"solve_error", "1", [](const Measurement& m) { return m.solve.error; }},
};

// Where fluid comes and goes, since the beginning.
constexpr Quantity SourceQuantities[] = {
    {"mass_in", "kg", [](const Measurement& m) { return m.massIn; }, true},
    {"mass_out", "kg", [](const Measurement& m) { return m.massOut; }, true},
    {"mass_missed", "kg", [](const Measurement& m) { return m.massMissed; }, true},
};

struct SolidQuantity {
    const char *name, *unit;
    Vec3d SolidMeasurement::*of;
    bool hasDepth = false;
};
constexpr SolidQuantity SolidQuantities[] = {
    {"position", "m", &SolidMeasurement::position},
    {"velocity", "m/s", &SolidMeasurement::velocity},
    {"spin", "rad/s", &SolidMeasurement::spin},
    {"pressure_force", "N", &SolidMeasurement::pressureForce, true},
    {"viscous_force", "N", &SolidMeasurement::viscousForce, true},
    {"torque", "N m", &SolidMeasurement::torque, true}};

struct FaceQuantity {
    const char* name;
    Vec3d FaceMeasurement::*of;
};
constexpr FaceQuantity FaceQuantities[] = {{"pressure_force", &FaceMeasurement::pressureForce},
                                           {"viscous_force", &FaceMeasurement::viscousForce}};

struct EnergyQuantity {
    const char* name;
    double EnergyMeasurement::*of;
};
constexpr EnergyQuantity EnergyQuantities[] = {
    {"compression_energy", &EnergyMeasurement::compression},
    {"gravity_work", &EnergyMeasurement::gravityWork},
    {"wall_work", &EnergyMeasurement::wallWork},
    {"stir_work", &EnergyMeasurement::stirWork},
    {"other_work", &EnergyMeasurement::otherWork},
    {"viscous_dissipation", &EnergyMeasurement::viscosity},
    {"artificial_dissipation", &EnergyMeasurement::artificialViscosity},
    {"diffusion_dissipation", &EnergyMeasurement::diffusion},
    {"shifting_dissipation", &EnergyMeasurement::shifting},
    {"wall_dissipation", &EnergyMeasurement::wallPressure},
    {"unexplained_energy", &EnergyMeasurement::unexplained}};

// Calls f(name, unit, value) for each column but those of passes.
template <class F> void forValues(const Measurement& m, const F& f) {
    const auto unitOf = [&](const auto& q) {
        return q.hasDepth ? perDepth(q.unit, m.dimensions) : q.unit;
    };
    for (const Quantity& q : Quantities) f(q.name, unitOf(q), q.of(m));
    if (m.solvesPressure)
        for (const Quantity& q : SolveQuantities) f(q.name, unitOf(q), q.of(m));
    if (m.energy)
        for (const EnergyQuantity& q : EnergyQuantities)
            f(q.name, perDepth("J", m.dimensions), *m.energy.*q.of);
    for (const FaceMeasurement& face : m.faces)
        for (const FaceQuantity& q : FaceQuantities)
            for (int k = 0; k < 3; ++k)
                f(fmt::format("face.{}.{}_{}", face.name, q.name, "xyz"[k]),
                  perDepth("N", m.dimensions), (face.*q.of)[k]);
    if (m.comesAndGoes)
        for (const Quantity& q : SourceQuantities) f(q.name, unitOf(q), q.of(m));
    for (const SolidMeasurement& s : m.solids)
        for (const SolidQuantity& q : SolidQuantities)
            for (int k = 0; k < 3; ++k)
                f(fmt::format("{}.{}_{}", s.name, q.name, "xyz"[k]), unitOf(q), (s.*q.of)[k]);
}

}  // namespace

TimeSeries::TimeSeries(std::vector<Column> more, const std::vector<PlanRow>& plan)
    : more_(std::move(more)) {
    for (const PlanRow& row : plan) {
        const bool ownTime = row.skipped.empty() && row.name.find(": ") == std::string::npos;
        if (ownTime && !find(passes_, row.name)) passes_.push_back({row.name, "ms"});
    }
}

void TimeSeries::chooseColumns(const Measurement& m) {
    forValues(m, [&](const std::string& name, const std::string& unit, double) {
        columns_.push_back({name, unit});
    });
    columns_.insert(columns_.end(), more_.begin(), more_.end());
    columns_.insert(columns_.end(), passes_.begin(), passes_.end());
}

void TimeSeries::goOn(const Measurement& now, const SeriesTable& earlier) {
    CHECK(columns_.empty());
    chooseColumns(now);
    std::vector<size_t> places;
    for (const Column& c : earlier.columns) {
        const std::optional<size_t> known = find(columns_, c.name);
        if (known && unitFactor(c.unit, columns_[*known].unit) != 1.0)  // however it is spelt
            throw Error(
                Failure::Output,
                fmt::format(
                    "{}: {} is in [{}] there, here in [{}]; name another file for the series",
                    earlier.path, c.name, c.unit, columns_[*known].unit));
        places.push_back(known.value_or(columns_.size()));
        if (!known) columns_.push_back(c);
    }
    for (const std::vector<double>& before : earlier.rows) {
        std::vector<double>& row = rows_.emplace_back(columns_.size(), std::nan(""));
        for (size_t i = 0; i < places.size(); ++i) row[places[i]] = before[i];
    }
    remarks_ = earlier.remarks;
}

void TimeSeries::add(const Measurement& m, const std::vector<PassTime>& passes,
                     const std::vector<double>& more) {
    CHECK(more.size() == more_.size());
    if (columns_.empty()) chooseColumns(m);
    std::vector<double> row;
    forValues(m,
              [&](const std::string&, const std::string&, double value) { row.push_back(value); });
    row.insert(row.end(), more.begin(), more.end());
    row.resize(row.size() + passes_.size(), 0);
    row.resize(columns_.size(), std::nan(""));
    for (const PassTime& pass : passes)
        if (const auto at = find(columns_, pass.name); at && pass.runs > 0)
            row[*at] = pass.ms / double(pass.runs);
    rows_.push_back(std::move(row));
}

bool TimeSeries::remark(double time, const std::string& text) {
    const auto same = [&](const SeriesRemark& r) { return keyOf(r.text) == keyOf(text); };
    if (std::any_of(remarks_.begin(), remarks_.end(), same)) return false;
    remarks_.push_back({rows_.size(), text, time});
    return true;
}

size_t TimeSeries::dropAfter(double time) {
    const size_t before = rows_.size() + remarks_.size();
    while (!rows_.empty() && !(rows_.back()[0] <= time)) rows_.pop_back();  // column 0 is the time
    std::erase_if(remarks_, [&](const SeriesRemark& r) { return r.time > time; });
    return before - rows_.size() - remarks_.size();
}

std::string TimeSeries::csvLine(size_t row) const {
    std::string text;
    for (double value : rows_[row])
        fmt::format_to(std::back_inserter(text), "{}{:.9g}", text.empty() ? "" : ",", value);
    return text + "\n";
}

std::string TimeSeries::csv() const {
    std::string text;
    for (const Column& c : columns_)
        text += (text.empty() ? "" : ",") + c.name +
                (c.unit.empty() ? "" : fmt::format(" [{}]", c.unit));
    text += "\n";
    for (size_t r = 0; r <= rows_.size(); ++r) {
        for (const SeriesRemark& remark : remarks_)
            if (remark.row == r) text += "# " + remark.text + "\n";
        if (r < rows_.size()) text += csvLine(r);
    }
    return text;
}

std::string TimeSeries::json() const {
    std::string text = "{\"columns\": [";
    for (size_t i = 0; i < columns_.size(); ++i)
        text += fmt::format("{}\n  {{\"name\": \"{}\", \"unit\": \"{}\"}}", i ? "," : "",
                            columns_[i].name, columns_[i].unit);
    text += "],\n";
    nlohmann::json remarks;
    for (const SeriesRemark& r : remarks_) remarks.push_back({{"row", r.row}, {"text", r.text}});
    if (!remarks_.empty()) text += "\"remarks\": " + remarks.dump() + ",\n";
    text += "\"rows\": [";
    for (size_t r = 0; r < rows_.size(); ++r) {
        text += r ? ",\n  [" : "\n  [";
        for (size_t i = 0; i < columns_.size(); ++i) {
            const double value = rows_[r][i];
            text +=
                (i ? ", " : "") + (std::isfinite(value) ? fmt::format("{:.9g}", value) : "null");
        }
        text += "]";
    }
    return text + "]}\n";
}

void TimeSeries::writeHdf5(const std::string& path) const {
    replaceFile(path, [&](const std::string& temporary) {
        return hdf5::writeFile(temporary, [&](hid_t file) {
            std::string remarks;
            for (const SeriesRemark& r : remarks_) remarks += fmt::format("{} {}\n", r.row, r.text);
            hdf5::writeText(file, Remarks, remarks);
            std::vector<double> values(rows_.size());
            for (size_t i = 0; i < columns_.size(); ++i) {
                for (size_t r = 0; r < rows_.size(); ++r) values[r] = rows_[r][i];
                hdf5::writeNumbers(file, columns_[i].name, columns_[i].unit, values);
            }
        });
    });
}

}  // namespace spindrift
