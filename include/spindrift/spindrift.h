// clang-format off
// The simulation as a library: scenes in, particles out, no window and no OpenGL. A program that
// uses it links spindrift::sim (find_package(spindrift)), as examples/flap.cpp does.
//
//     using namespace spindrift;
//     const Scene scene = readScene("pool.json");  // or parseScene; or made here, and checkScene
//     const std::unique_ptr<Simulation> run = makeSimulation(scene);
//     run->stopAt(0.5);
//     while (run->clock().time < 0.5) run->step();
//     for (const Particle& p : run->particles()) ...  // m, m/s, kg/m³, Pa
//
// Lengths in m, times in s, SI units throughout. Mistakes are Errors (core/error.h), one line each.
// A Simulation is used by one thread at a time; several of them are independent.
// clang-format on
#pragma once

#include "core/error.h"           // Error
#include "scene/check.h"          // checkScene
#include "scene/json.h"           // readScene, parseScene
#include "scene/sample_object.h"  // where elastic objects have their particles
#include "scene/scene.h"          // Scene
#include "sim/object_driver.h"    // ObjectDriver: an engine of one's own moves elastic objects
#include "sim/simulation.h"       // Simulation, makeSimulation
