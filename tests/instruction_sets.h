#pragma once
// The instruction sets that this build and this machine have.
#include "core/error.h"
#include "sim/simulation.h"

#include <vector>

namespace spindrift {

inline std::vector<Simd> instructionSets() {
    std::vector<Simd> sets;
    for (const Simd simd : {Simd::Sse, Simd::Avx2, Simd::Avx512}) {
        Scene scene;
        scene.simulation.dimensions = 2;
        scene.simulation.spacing = 0.1f;
        scene.fluid.bodies = {Body{{.max{0.5f, 0.5f, 1}}}};
        scene.compute.simd = simd;
        try {
            makeSimulation(scene);
            sets.push_back(simd);
        } catch (const Error&) {}
    }
    return sets;
}

}  // namespace spindrift
