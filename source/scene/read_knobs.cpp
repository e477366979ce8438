#include "scene/read_knobs.h"

#include "scene/suggest.h"

#include <algorithm>
#include <charconv>
#include <iterator>
#include <set>

namespace spindrift {
namespace {

std::string withUnit(const Knob& knob) {
    return *knob.unit ? fmt::format(" in {}", knob.unit) : "";
}

template <class T> void requireRange(T value, const Json& json, const Knob& knob,
                                     const Place& place, const std::string& path) {
    if (!inRange(value, knob))
        place.fail(path,
                   fmt::format("{} is out of range, allowed: {}", shown(json), allowedRange(knob)));
}

// "line 3, column 12" of a byte offset (1 = the first byte).
std::string lineAndColumn(const std::string& text, size_t byte) {
    const size_t end = std::min(byte > 0 ? byte - 1 : 0, text.size());
    const auto begin = text.begin();
    const auto line = 1 + std::count(begin, begin + ptrdiff_t(end), '\n');
    const size_t newline = end > 0 ? text.rfind('\n', end - 1) : std::string::npos;
    const size_t column = newline == std::string::npos ? end + 1 : end - newline;
    return fmt::format("line {}, column {}", line, column);
}

// Refuses a key that an object has twice, of which JSON libraries silently keep one, and nesting
// that no scene has but that would overflow the stack of recursive readers.
class StrictKeys {
public:
    explicit StrictKeys(const std::string& file) : file_(file) {}
    bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
        if (depth > 32)
            throw Error(Failure::Scene, fmt::format("{}: nested more than 32 levels deep", file_));
        if (event == Json::parse_event_t::object_start) keys_.emplace_back();
        if (event == Json::parse_event_t::object_end) keys_.pop_back();
        if (event == Json::parse_event_t::key &&
            !keys_.back().insert(parsed.get<std::string>()).second)
            throw Error(Failure::Scene,
                        fmt::format("{}: the key {} stands twice in one object; remove one", file_,
                                    shown(parsed)));
        return true;
    }

private:
    std::string file_;
    std::vector<std::set<std::string>> keys_;
};

// Splits "bodies[0]" and "min" off "bodies[0].min"; the index is -1 where there is none.
struct Step {
    std::string_view key;
    int index = -1;
};
Step takeStep(std::string_view& path) {
    const size_t dot = std::min(path.find('.'), path.size());
    Step step{path.substr(0, dot)};
    path.remove_prefix(std::min(dot + 1, path.size()));
    const size_t bracket = step.key.find('[');
    if (bracket == std::string_view::npos) return step;
    const std::string_view digits = step.key.substr(bracket + 1);
    std::from_chars(digits.data(), digits.data() + digits.size(), step.index);
    step.key = step.key.substr(0, bracket);
    return step;
}

bool startsWith(const std::string& text, const std::string& start) {
    return text.compare(0, start.size(), start) == 0;
}

void refuseUnknownIn(const Json& json, const std::string& at, const std::vector<std::string>& known,
                     const Place& place) {
    const std::string parent = at.empty() ? "" : at + ".";
    if (!json.is_object())
        place.fail(at.empty() ? "the file" : at,
                   fmt::format("expected an object {{...}}, found {}", shown(json)));
    for (const auto& [key, value] : json.items()) {
        const std::string path = parent + key;
        const bool plain = !key.empty() && key.find_first_of(".[") == std::string::npos;
        const auto inside = [&](const char* next) {
            return plain && std::any_of(known.begin(), known.end(),
                                        [&](auto& k) { return startsWith(k, path + next); });
        };
        if (plain && std::find(known.begin(), known.end(), path) != known.end()) continue;
        if (inside(".")) {
            refuseUnknownIn(value, path, known, place);
        } else if (inside("[") && value.is_array()) {
            for (size_t i = 0; i < value.size(); ++i)
                refuseUnknownIn(value[i], fmt::format("{}[{}]", path, i), known, place);
        } else {
            place.fail(shown(path).substr(1, shown(path).size() - 2),
                       fmt::format("unknown key; {}{}", adviceFor(parent, key, known), place.hint));
        }
    }
}

}  // namespace

double decimal(float value) {
    char text[64];
    const auto end = std::to_chars(std::begin(text), std::end(text), value).ptr;
    double wide = value;
    std::from_chars(text, end, wide);
    return wide;
}

std::string allowedRange(const Knob& knob) {
    const std::string unit = *knob.unit ? fmt::format(" {}", knob.unit) : "";
    return knob.min == knob.max ? fmt::format("{}{}", knob.min, unit)
                                : fmt::format("{} to {}{}", knob.min, knob.max, unit);
}

std::string shown(const Json& json) {
    constexpr size_t Longest = 60;
    // Bytes that are not UTF-8 are replaced; control characters come out escaped.
    const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return text.size() <= Longest ? text : text.substr(0, Longest) + "...";
}

void assign(float& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    if (!json.is_number())
        place.fail(path, fmt::format("expected a number{}, found {}", withUnit(knob), shown(json)));
    const float number = json.get<float>();
    requireRange(number, json, knob, place, path);
    value = number;
}

void assign(int& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    if (!json.is_number() ||
        (json.is_number_float() && json.get<double>() != std::rint(json.get<double>())))
        place.fail(path,
                   fmt::format("expected a whole number{}, found {}", withUnit(knob), shown(json)));
    const double number = json.get<double>();
    requireRange(number, json, knob, place, path);
    value = int(number);
}

void assign(bool& value, const Json& json, const Knob&, const Place& place,
            const std::string& path) {
    if (!json.is_boolean())
        place.fail(path, fmt::format("expected true or false, found {}", shown(json)));
    value = json.get<bool>();
}

void assign(std::string& value, const Json& json, const Knob&, const Place& place,
            const std::string& path) {
    if (!json.is_string())
        place.fail(path, fmt::format("expected text in quotes, found {}", shown(json)));
    value = json.get<std::string>();
}

template <class T> static void assignVector(Vec3Of<T>& value, const Json& json, const Knob& knob,
                                            const Place& place, const std::string& path) {
    const bool numbers =
        json.is_array() && json.size() == 3 &&
        std::all_of(json.begin(), json.end(), [](const Json& j) { return j.is_number(); });
    if (!numbers)
        place.fail(path, fmt::format("expected three numbers [x, y, z]{}, found {}", withUnit(knob),
                                     shown(json)));
    const Vec3Of<T> vector{json[0].get<T>(), json[1].get<T>(), json[2].get<T>()};
    requireRange(vector, json, knob, place, path);
    value = vector;
}
void assign(Vec3& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    assignVector(value, json, knob, place, path);
}
void assign(Vec3d& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    assignVector(value, json, knob, place, path);
}

void assign(Int3& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    if (!json.is_array() || json.size() != 3)
        place.fail(path,
                   fmt::format("expected three whole numbers [x, y, z], found {}", shown(json)));
    assign(value.x, json[0], knob, place, path);
    assign(value.y, json[1], knob, place, path);
    assign(value.z, json[2], knob, place, path);
}

void assign(Keyframes& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    if (!json.is_array())
        place.fail(path, fmt::format("expected a list of keyframes [[t, x, y, z], ...], found {}",
                                     shown(json)));
    Keyframes keyframes;
    for (const Json& row : json) {
        const bool numbers =
            row.is_array() && (row.size() == 4 || row.size() == 5 || row.size() == 9) &&
            std::all_of(row.begin(), row.end(), [](const Json& j) { return j.is_number(); });
        if (!numbers)
            place.fail(path, fmt::format("expected keyframes [t, x, y, z], [t, x, y, z, turn] or "
                                         "[t, x, y, z, turn, vx, vy, vz, spin] in s, m and "
                                         "degrees, found {}",
                                         shown(row)));
        auto at = [&](size_t k) { return k < row.size() ? row[k].get<double>() : 0.0; };
        const Keyframe key{at(0),           {at(1), at(2), at(3)}, at(4),
                           row.size() == 9, {at(5), at(6), at(7)}, at(8)};
        requireRange(key.offset, row, knob, place, path);
        requireRange(key.velocity, row, knob, place, path);
        keyframes.push_back(key);
    }
    value = keyframes;
}

void assign(Rates& value, const Json& json, const Knob& knob, const Place& place,
            const std::string& path) {
    const auto isRow = [](const Json& row) {
        return row.is_array() && row.size() == 2 && row[0].is_number() && row[1].is_number();
    };
    if (!json.is_array() || !std::all_of(json.begin(), json.end(), isRow))
        place.fail(path, fmt::format("expected a list of times in s and values [[t, {}], ...], "
                                     "found {}",
                                     knob.unit, shown(json)));
    Rates rates;
    for (const Json& row : json) rates.push_back({row[0].get<double>(), row[1].get<double>()});
    if (!inRange(rates, knob))
        place.fail(path,
                   fmt::format("{} is out of range, allowed: {}", shown(json), allowedRange(knob)));
    value = rates;
}

int enumIndex(const Json& json, const std::vector<std::string>& names, const Place& place,
              const std::string& path) {
    const std::string name = json.is_string() ? json.get<std::string>() : "";
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return int(found - names.begin());
    const std::string nearest = nearestName(name, names);
    place.fail(path,
               fmt::format("expected one of {}, found {}{}", listed(names), shown(json),
                           nearest.empty() ? "" : fmt::format("; did you mean \"{}\"?", nearest)));
}

const Json* find(const Json& root, std::string_view path) {
    const Json* json = &root;
    while (!path.empty()) {
        const Step step = takeStep(path);
        if (!json->is_object()) return nullptr;
        const auto member = json->find(std::string(step.key));
        if (member == json->end()) return nullptr;
        json = &*member;
        if (step.index < 0) continue;
        if (!json->is_array() || size_t(step.index) >= json->size()) return nullptr;
        json = &(*json)[size_t(step.index)];
    }
    return json;
}

std::string adviceFor(const std::string& parent, const std::string& key,
                      const std::vector<std::string>& known) {
    std::set<std::string> siblings, lasts;
    for (const std::string& path : known) {
        lasts.insert(path.substr(path.rfind('.') + 1));
        if (!startsWith(path, parent)) continue;
        siblings.insert(
            path.substr(parent.size(), path.find_first_of(".[", parent.size()) - parent.size()));
    }
    const std::vector<std::string> near(siblings.begin(), siblings.end());
    if (const std::string name = nearestName(key, near); !name.empty())
        return fmt::format("did you mean \"{}\"?", name);
    // Keys of a body are meant for that body.
    if (parent.find('[') != std::string::npos) return fmt::format("known here: {}", listed(near));
    const std::string last =
        nearestName(key.substr(key.rfind('.') + 1), {lasts.begin(), lasts.end()});
    for (const std::string& path : known)
        if (!last.empty() && path.substr(path.rfind('.') + 1) == last)
            return fmt::format("did you mean {}?", path);
    return fmt::format("known here: {}", listed(near));
}

void refuseUnknown(const Json& root, const std::vector<std::string>& known, const Place& place) {
    refuseUnknownIn(root, "", known, place);
}

Json parseJson(const std::string& text, const std::string& file) {
    try {
        return Json::parse(text, StrictKeys(file), true, true);
    } catch (const Json::parse_error& error) {
        // The library's text ends with what it met and what it expected; its own prefix is for
        // programmers.
        const std::string what = error.what();
        const size_t detail = what.rfind("syntax error");
        throw Error(Failure::Scene,
                    fmt::format("{}: {}: not valid JSON: {}", file, lineAndColumn(text, error.byte),
                                detail == std::string::npos ? what : what.substr(detail)));
    } catch (const Json::exception& error) {
        const std::string what = error.what();
        throw Error(Failure::Scene,
                    fmt::format("{}: not valid JSON: {}", file, what.substr(what.find(']') + 2)));
    }
}

}  // namespace spindrift
