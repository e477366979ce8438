// All terms, and the choice of those that a scene wants.
#pragma once

#include "sim/physics/mixing_terms.h"
#include "sim/physics/pressure_terms.h"
#include "sim/physics/viscous_terms.h"

#include <algorithm>

namespace spindrift::LANES {

template <class T> T makeTerm(const Model& m) {
    if constexpr (requires { T::of(m); })
        return T::of(m);
    else
        return {};
}
// Some terms, with their parameters.
template <class... Ts> struct TermList : Ts... {
    static constexpr unsigned needs = (0u | ... | Ts::needs);
    static TermList of(const Model& m) { return {makeTerm<Ts>(m)...}; }
};
// The longest step, s, that those bear that the scene wants.
template <class T> double longestStepOf(const Model& m) {
    if constexpr (requires { T::longestStep(m); })
        return *T::skipped(*m.scene) ? 1e9 : T::longestStep(m);
    else
        return 1e9;
}
template <class... Ts> double longestStepOf(const Model& m, TermList<Ts...>) {
    return std::min({longestStepOf<Ts>(m)...});
}
using Mixing = TermList<VelocityTransfer, Buoyancy>;  // in a pass of their own, as rare as they are
template <ViscosityForm form> using Viscosities =
    TermList<LaminarViscosity<form>, ArtificialViscosity>;  // of all formulations but the classic
template <class... A, class... B> TermList<A..., B...> joined(TermList<A...>*, TermList<B...>*);
template <class A, class B> using Joined =
    decltype(joined(static_cast<A*>(nullptr), static_cast<B*>(nullptr)));
using OptionalTerms =
    Joined<TermList<LaminarViscosity<ViscosityForm::Monaghan>>,
           Joined<Viscosities<ViscosityForm::Morris>,
                  TermList<MixtureViscosity<ViscosityForm::Morris>,
                           MixtureViscosity<ViscosityForm::Monaghan>, ClassicViscosity>>>;

// Calls done with the form of viscosity that a scene has, as a type's value.
template <ViscosityForm form> struct FormOf { static constexpr ViscosityForm value = form; };
template <class Done> auto withViscosityForm(const Scene& s, Done done) {
    return viscosityForm(s) == ViscosityForm::Morris ? done(FormOf<ViscosityForm::Morris>{})
                                                     : done(FormOf<ViscosityForm::Monaghan>{});
}

// Calls done(TermList<...>) with just the terms this scene wants: a run-time scene becomes a
// compile-time list.
template <class Done, class... Chosen>
auto chooseTerms(const Scene&, Done done, TermList<Chosen...> chosen, TermList<>) {
    return done(chosen);
}
template <class Done, class... Chosen, class T, class... Rest>
auto chooseTerms(const Scene& s, Done done, TermList<Chosen...> chosen, TermList<T, Rest...>) {
    return *T::skipped(s) ? chooseTerms(s, done, chosen, TermList<Rest...>{})
                          : chooseTerms(s, done, TermList<Chosen..., T>{}, TermList<Rest...>{});
}

}  // namespace spindrift::LANES
