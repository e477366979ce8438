// Descriptions of the scene format, made from the schema: JSON Schema, the table in --help and the
// one in docs/SCENES.md.
#include "scene/json.h"
#include "scene/read_knobs.h"
#include "scene/suggest.h"

#include <algorithm>

namespace spindrift {
namespace {

std::string withUnit(const Knob& knob) {
    return *knob.unit ? fmt::format("{}, {}", knob.help, knob.unit) : std::string(knob.help);
}

// What a JSON Schema says of a knob of each type.
Json typeOf(float, const Knob& k) {
    return {{"type", "number"}, {"minimum", decimal(k.min)}, {"maximum", decimal(k.max)}};
}
Json typeOf(int, const Knob& k) {
    return {{"type", "integer"}, {"minimum", int64_t(k.min)}, {"maximum", int64_t(k.max)}};
}
Json typeOf(bool, const Knob&) { return {{"type", "boolean"}}; }
Json typeOf(const std::string&, const Knob&) { return {{"type", "string"}}; }
Json listOf(const Knob& k, int least, int most) {
    return {{"type", "array"}, {"items", typeOf(0.0f, k)}, {"minItems", least}, {"maxItems", most}};
}
Json typeOf(Vec3, const Knob& k) { return listOf(k, 3, 3); }
Json typeOf(Vec3d, const Knob& k) { return listOf(k, 3, 3); }
Json typeOf(const Keyframes&, const Knob& k) {
    return {{"type", "array"}, {"items", {{"anyOf", {listOf(k, 4, 5), listOf(k, 9, 9)}}}}};
}
Json typeOf(const Rates&, const Knob& k) { return {{"type", "array"}, {"items", listOf(k, 2, 2)}}; }
template <class E>
requires std::is_enum_v<E> Json typeOf(E value, const Knob&) {
    return {{"enum", enumNames(value)}};
}

Json emptyObject() {
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
}

// The properties that hold the last name of `path`, e.g. those of "view.camera" for
// "view.camera.yaw".
Json& parentProperties(Json& root, std::string& path) {
    Json* object = &root;
    for (size_t dot; (dot = path.find('.')) != std::string::npos; path.erase(0, dot + 1)) {
        Json& next = (*object)["properties"][path.substr(0, dot)];
        if (next.is_null()) next = emptyObject();
        object = &next;
    }
    return (*object)["properties"];
}

// The schema of a list's members allows the keys of all kinds; the reader is stricter.
template <class T> Json memberSchema() {
    Json member = emptyObject();
    for (const T& example : oneOfEachKind<T>())
        visitMember(example, "", [&](std::string path, const auto& value, const Knob& knob) {
            Json& property = member["properties"][path.substr(1)];
            property = typeOf(value, knob);
            property["description"] = withUnit(knob);
        });
    return member;
}

// A value as the table shows it.
std::string plain(float value) { return fmt::format("{}", value); }
std::string plain(int value) { return fmt::format("{}", value); }
std::string plain(bool value) { return value ? "true" : "false"; }
std::string plain(const std::string& value) { return value.empty() ? "\"\"" : value; }
template <class T> std::string plain(Vec3Of<T> v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }
std::string plain(const Keyframes& keyframes) {
    std::string text;
    for (const Keyframe& k : keyframes)
        text += fmt::format("[{},{},{}]", k.time, plain(k.offset), k.turn);
    return "[" + text + "]";
}
std::string plain(const Rates& rates) {
    std::string text;
    for (const Rate& r : rates) text += fmt::format("[{},{}]", r.time, r.value);
    return "[" + text + "]";
}
template <class E>
requires std::is_enum_v<E> std::string plain(E value) { return enumNames(value)[size_t(value)]; }

template <class T> std::string allowed(const T& value, const Knob& knob) {
    if constexpr (std::is_enum_v<T>) {
        const auto names = enumNames(value);
        return listed({names.begin(), names.end()}, "|");
    } else if constexpr (std::is_same_v<T, bool>)
        return "true|false";
    else if constexpr (std::is_same_v<T, std::string>)
        return "text";
    else if constexpr (std::is_same_v<T, Keyframes> || std::is_same_v<T, Rates>)
        return "list of lists of numbers";
    else
        return allowedRange(knob);
}

// Calls show(path, value, knob) for each knob once; members of lists are [i], with all that any
// kind of them has.
template <class Show> void visitKnobsOnce(const Show& show) {
    Scene scene;
    visitLists(scene, [](const char*, auto& list, const char*) {
        list = oneOfEachKind<typename std::decay_t<decltype(list)>::value_type>();
    });
    std::vector<std::string> seen;
    visitKnobs(scene, [&](std::string path, const auto& value, const Knob& knob) {
        if (const size_t bracket = path.find('['); bracket != std::string::npos)
            path[bracket + 1] = 'i';
        if (std::find(seen.begin(), seen.end(), path) != seen.end()) return;
        seen.push_back(path);
        show(path, value, knob);
    });
}

// Text in a cell of a Markdown table.
std::string cell(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '|' || c == '*' || c == '<') escaped += '\\';
        escaped += c;
    }
    return escaped;
}

}  // namespace

std::string jsonSchema() {
    Json root{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Spindrift scene"}};
    root.update(emptyObject());
    root["required"] = {"version"};
    root["properties"]["$schema"] = {{"type", "string"}};
    Scene scene;
    visitLists(scene, [](const char*, auto& list, const char*) { list.clear(); });
    visitKnobs(scene, [&](std::string path, const auto& value, const Knob& knob) {
        Json property = typeOf(value, knob);
        property["description"] = withUnit(knob) + (knob.live ? "" : " (restarts the scene)");
        if constexpr (std::is_enum_v<std::decay_t<decltype(value)>>)
            property["default"] = plain(value);
        else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3>)
            property["default"] = {decimal(value.x), decimal(value.y), decimal(value.z)};
        else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, float>)
            property["default"] = decimal(value);
        else if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3d>)
            property["default"] = {value.x, value.y, value.z};
        else if constexpr (!std::is_same_v<std::decay_t<decltype(value)>, Keyframes> &&
                           !std::is_same_v<std::decay_t<decltype(value)>, Rates>)
            property["default"] = value;
        Json& properties = parentProperties(root, path);
        properties[path] = property;
    });
    visitLists(scene, [&](std::string path, const auto& list, const char* what) {
        using Member = typename std::decay_t<decltype(list)>::value_type;
        Json& properties = parentProperties(root, path);
        properties[path] =
            Json{{"type", "array"}, {"items", memberSchema<Member>()}, {"description", what}};
    });
    return root.dump(2) + "\n";
}

std::vector<std::pair<std::string, std::string>> restartKnobs(const Scene& scene) {
    std::vector<std::pair<std::string, std::string>> knobs;
    visitKnobs(scene, [&](const std::string& path, const auto& value, const Knob& knob) {
        if (!knob.live) knobs.emplace_back(path, plain(value));
    });
    return knobs;
}

std::string knobTable() {
    std::string table;
    visitKnobsOnce([&](const std::string& path, const auto& value, const Knob& knob) {
        table += fmt::format("  {:<32} {:<14} {}{}\n{:<50}{}\n", path, plain(value), knob.help,
                             knob.live ? "" : " *", "", allowed(value, knob));
    });
    return "Knobs (path, default, meaning; * = changing it restarts the scene):\n" + table;
}

std::string knobReference() {
    std::string text, section = "none yet";
    visitKnobsOnce([&](const std::string& path, const auto& value, const Knob& knob) {
        const size_t dot = path.rfind('.');
        const std::string parent = dot == std::string::npos ? "" : path.substr(0, dot);
        if (parent != section)
            text += fmt::format(
                "{}### {}\n\n| knob | default | allowed | meaning |\n|---|---|---|---|\n",
                text.empty() ? "" : "\n", parent.empty() ? "The scene" : "`" + parent + "`");
        section = parent;
        text += fmt::format("| `{}`{} | {} | {} | {} |\n", path, knob.live ? "" : " \\*",
                            cell(plain(value)), cell(allowed(value, knob)), cell(knob.help));
    });
    return text;
}

}  // namespace spindrift
