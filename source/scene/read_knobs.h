#pragma once
// JSON values -> knobs, with every mistake reported by file, path and remedy. Used by the readers
// of both layouts.
#include "core/error.h"
#include "scene/schema.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace spindrift {

// Keeps the order of keys.
using Json = nlohmann::ordered_json;
// The shortest decimal number that a float is: 0.02 is written as 0.02.
double decimal(float);

// "configs/a.json: fluid.viscosity"; `file` may be a name such as "--set".
struct Place {
    std::string file;
    std::string hint;  // appended to unknown keys
    [[noreturn]] void fail(const std::string& path, const std::string& message) const {
        throw Error(Failure::Scene, fmt::format("{}: {}: {}", file, path, message));
    }
};

// "0 to 100 Pa s"
std::string allowedRange(const Knob&);
// A JSON value as a message shows it: short, on one line.
std::string shown(const Json&);
// Whether a value lies within its knob's range; NaN never does.
template <class T> bool inRange(T value, const Knob& knob) {
    return value >= T(knob.min) && value <= T(knob.max);
}
template <class T> bool inRange(Vec3Of<T> v, const Knob& knob) {
    return inRange(v.x, knob) && inRange(v.y, knob) && inRange(v.z, knob);
}
inline bool inRange(Int3 v, const Knob& knob) {
    return inRange(v.x, knob) && inRange(v.y, knob) && inRange(v.z, knob);
}
inline bool inRange(const Keyframes&, const Knob&) { return true; }  // checkScene looks closer
inline bool inRange(const Rates& rates, const Knob& knob) {
    for (const Rate& rate : rates)
        if (!inRange(float(rate.value), knob)) return false;
    return true;
}
inline bool inRange(bool, const Knob&) { return true; }
inline bool inRange(const std::string&, const Knob&) { return true; }
template <class E>
requires std::is_enum_v<E>
bool inRange(E value, const Knob&) { return size_t(value) < enumNames(value).size(); }

// One overload for each type of knob; throws Error(Failure::Scene).
void assign(float&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(int&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(bool&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(std::string&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(Vec3&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(Vec3d&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(Int3&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(Keyframes&, const Json&, const Knob&, const Place&, const std::string& path);
void assign(Rates&, const Json&, const Knob&, const Place&, const std::string& path);
int enumIndex(const Json&, const std::vector<std::string>& names, const Place&,
              const std::string& path);
template <class E>
requires std::is_enum_v<E>
void assign(E& value, const Json& json, const Knob&, const Place& place, const std::string& path) {
    const auto names = enumNames(value);
    value = E(enumIndex(json, {names.begin(), names.end()}, place, path));
}

// The value at "a.b[0].c", or null when it is absent.
const Json* find(const Json& root, std::string_view path);
// Reports the first key that is not among the known paths and the first object that should be one.
void refuseUnknown(const Json& root, const std::vector<std::string>& known, const Place&);

// Reads every knob of `target` that stands in `root`; absent ones keep their value.
template <class Target> void readKnobs(const Json& root, Target& target, const Place& place) {
    std::vector<std::string> known;
    visitKnobs(target, [&](const std::string& path, auto& value, const Knob& knob) {
        known.push_back(path);
        if (const Json* json = find(root, path)) assign(value, *json, knob, place, path);
    });
    refuseUnknown(root, known, place);
}

// For an unknown key of the object at `parent` ("" or "fluid."): the nearest key of the same
// object, else of another one, else what there is.
std::string adviceFor(const std::string& parent, const std::string& key,
                      const std::vector<std::string>& known);

// Parses text with // comments. Malformed text and duplicate keys are reported with line and
// column.
Json parseJson(const std::string& text, const std::string& file);

}  // namespace spindrift
