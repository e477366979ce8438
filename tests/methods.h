#pragma once
// All ways to combine formulation, kernel, integrator, pressure form, walls and time mode.
#include "scene/schema.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

namespace spindrift {

// The knobs' values, as numbers of their names.
using Method = std::array<int, 6>;

template <class Visit> void visitMethod(Scene& s, const Visit& visit) {
    visit(0, "simulation.formulation", s.simulation.formulation);
    visit(1, "simulation.kernel", s.simulation.kernel);
    visit(2, "time.integrator", s.time.integrator);
    visit(3, "simulation.pressure_form", s.simulation.pressureForm);
    visit(4, "walls.kind", s.walls.kind);
    visit(5, "time.mode", s.time.mode);
}

inline void setMethod(Scene& s, const Method& m) {
    visitMethod(s, [&](int k, const char*, auto& knob) {
        knob = std::decay_t<decltype(knob)>(m[size_t(k)]);
    });
}

inline std::string nameOf(const Method& m) {
    Scene s;
    std::string name;
    visitMethod(s, [&](int k, const char*, auto& knob) {
        name += std::string(k ? " " : "") + enumNames(knob)[size_t(m[size_t(k)])];
    });
    return name;
}

inline std::vector<Method> allMethods() {
    Scene s;
    std::vector<Method> all{Method{}};
    visitMethod(s, [&](int k, const char*, auto& knob) {
        std::vector<Method> more;
        for (const Method& m : all)
            for (int value = 0; value < int(enumNames(knob).size()); ++value)
                more.push_back(m), more.back()[size_t(k)] = value;
        all = more;
    });
    return all;
}

// What docs/SCENES.md promises to go together ("Which go together").
inline bool goesTogether(const Method& m, int dimensions) {
    Scene s;
    setMethod(s, m);
    const Formulation f = s.simulation.formulation;
    const Integrator i = s.time.integrator;
    const bool shifts = f == Formulation::DeltaPlus || f == Formulation::TransportVelocity;
    if (s.simulation.pressureForm == PressureForm::Mean && f != Formulation::Wcsph) return false;
    if (i == Integrator::Split && f != Formulation::DeltaSph) return false;
    if (s.time.mode == TimeMode::Local && (shifts || i != Integrator::SymplecticEuler))
        return false;
    if (f == Formulation::TransportVelocity && s.walls.kind == WallKind::Reflect) return false;
    if (f == Formulation::DeltaSph && s.simulation.kernel == Kernel::Mueller &&
        s.walls.kind == WallKind::Reflect)
        return false;
    if (f == Formulation::Incompressible)
        return i == Integrator::SymplecticEuler && s.time.mode != TimeMode::Local &&
               s.simulation.kernel != Kernel::Mueller;
    if (f != Formulation::Classic) return true;
    return dimensions == 3 && s.simulation.kernel == Kernel::CubicSpline &&
           i == Integrator::SymplecticEuler;
}

// As few as greed finds of those that go together, such that every two values that do are there.
inline std::vector<Method> coveringMethods(int dimensions) {
    using Pair = std::array<int, 4>;
    const auto pairsOf = [](const Method& m) {
        std::vector<Pair> pairs;
        for (int a = 0; a < 6; ++a)
            for (int b = a + 1; b < 6; ++b) pairs.push_back({a, m[size_t(a)], b, m[size_t(b)]});
        return pairs;
    };
    std::vector<Method> all = allMethods(), chosen;
    std::erase_if(all, [&](const Method& m) { return !goesTogether(m, dimensions); });
    std::set<Pair> open;
    for (const Method& m : all)
        for (const Pair& p : pairsOf(m)) open.insert(p);
    const auto gain = [&](const Method& m) {
        const auto pairs = pairsOf(m);
        return std::count_if(pairs.begin(), pairs.end(),
                             [&](const Pair& p) { return open.contains(p); });
    };
    while (!open.empty()) {
        chosen.push_back(
            *std::max_element(all.begin(), all.end(),
                              [&](const Method& a, const Method& b) { return gain(a) < gain(b); }));
        for (const Pair& p : pairsOf(chosen.back())) open.erase(p);
    }
    return chosen;
}

}  // namespace spindrift
