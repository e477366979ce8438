#pragma once
// Sources: which points their fluid comes from, how fast when, and how much in all.
#include "scene/particles.h"
#include "scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace spindrift {

// What fluids a scene has: those of its bodies, or where all comes from sources its own.
std::vector<Body> fluidsOf(const Fluid&);

// A source's name in messages: its own, or sources[0], sources[1], ...
std::string nameOf(const Scene&, const Source&);

// Particles come one behind the other from each point of a mouth, `apart` from each other, so that
// each has a particle's volume of what goes through the mouth. The last `layers` of them, as many
// as a support radius has, have not reached the mouth yet and are held.
struct SourceLattice {
    struct Point {
        Vec3d at;          // m, world coordinates, in the mouth
        double share = 1;  // of the mean velocity
    };
    std::vector<Point> points;
    Vec3d normal, across, up;  // of length 1: to where the fluid goes, along width and height
    double apart = 0;          // m, along the normal
    double area = 0;           // m², in two dimensions m: of the mouth
    int layers = 0;

    double depth() const { return layers * apart; }  // m, behind the mouth, that is held
    double largestShare() const;
};
SourceLattice latticeOf(const Scene&, const Source&);

// From one time on until the next key's, s later, the mean velocity is speed + slope s, and fluid
// has gone on by way + speed s + slope s^2 / 2 since the beginning. Before the first key it rests.
struct SourceKey {
    double time;   // s
    double way;    // m
    double speed;  // m/s
    double slope;  // m/s²
};
// Reads each source's file (a path relative to `folder`) into its velocities or flows, and forgets
// the path: a run that goes on needs no file. Throws Error (Scene).
void readRates(Scene&, const std::string& folder, const std::string& place);
// Throws Error (Scene) where a text has rates beside the file that says them.
void requireOneOfRatesAndFile(const Scene&, const std::string& place);
std::vector<SourceKey> scheduleOf(const Scene&, const Source&);
double wayAt(const std::vector<SourceKey>&, double time);
// m/s, of any of its particles at any time.
double largestSpeed(const Scene&, const Source&);

// How many are held from the beginning; and all sources' together with their places.
int64_t particlesInMouth(const Scene&, const Source&);
void fillMouths(const Scene&, Placement&);

// Where no body has its fluid: just before mouths.
class MouthRoom {
public:
    explicit MouthRoom(const Scene&);
    // A place relative to the domain's lower corner.
    bool takes(Vec3d) const;

private:
    struct Room {
        Vec3d middle, axis[3], half;  // m
        bool round;
    };
    std::vector<Room> rooms_;
};

// The most particles of fluid that a run which has `count` of them now can come to have at any
// time: with all that its sources give until output.time, and no more than the domain has room for.
int64_t mostFluid(const Scene&, int64_t count);

}  // namespace spindrift
