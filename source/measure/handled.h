#pragma once
// A hand that drags a scene's solids and stirs its fluid at random, through the calls that the
// mouse makes, and whether the run bears it.
#include "scene/convex.h"
#include "scene/sample_object.h"
#include "sim/simulation.h"

#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace spindrift {

// Each picture it moves on; now and then it takes something else, changes its mind or lets go. It
// goes from one end of the box to the other in a seventh of a second, if it likes.
class RandomHand {
public:
    RandomHand(const Scene&, uint64_t seed);
    // The next picture, a sixtieth of a second of the mouse's time.
    void move(Simulation&);
    double fastest() const { return fastest_; }  // that it was yet, m/s

private:
    float between(float a, float b);
    Vec3 somewhere();
    void takeSomething();
    Vec3 place();

    const Scene& scene_;
    std::mt19937_64 random_;
    int solid_ = -1;
    bool stirs_ = false;
    float pull_ = 0, radius_ = 0;  // of the stirrer, 1/s and m
    int left_ = 0;                 // pictures until it takes something else
    double phase_ = 0, pace_ = 0;  // of its way to and fro between two places
    Vec3 from_, to_, before_;
    double fastest_ = 0;
};

// What must not happen however a scene is handled: values that are no numbers, particles that are
// lost, outside of the box, in solids, through the walls of tubes, or faster than they have a
// reason to be.
class HandlingJudge {
public:
    HandlingJudge(const Scene&, Simulation&);
    // "" while all is well. `hand`: the fastest that the hand was, m/s.
    std::string look(Simulation&, double hand);

private:
    struct Tube {
        int axis;
        size_t first, ring, end;   // of its particles
        std::vector<char> filled;  // whether each particle of fluid has been in it all the time
    };
    bool isIn(const Tube&, const std::vector<Vec3>& places, Vec3d p) const;
    std::string leak(Simulation&, const std::vector<Particle>&);
    static double middleOf(const Tube&, const std::vector<Vec3>& places, size_t ring);

    const Scene& scene_;
    std::vector<Convex> shapes_;
    std::vector<Tube> tubes_;
    int count_;
};

}  // namespace spindrift
