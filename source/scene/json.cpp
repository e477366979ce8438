#include "scene/json.h"

#include "scene/historical.h"
#include "scene/motion.h"
#include "scene/sources.h"
#include "scene/read_knobs.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace spindrift {
namespace {

// Files beyond this are no scenes (a device, a video): refused before memory is spent on them.
constexpr size_t LargestFile = 16 << 20;

// What scenes are made of, opened or dropped in a scene's place.
std::string usedAs(const std::string& file) {
    std::string kind = std::filesystem::path(file).extension().string();
    for (char& c : kind) c = char(std::tolower(static_cast<unsigned char>(c)));
    for (const char* mesh : {".obj", ".stl", ".ply", ".gltf", ".glb"})
        if (kind == mesh)
            return R"(is a mesh; a scene names it, {"shape": "mesh", "path": ...}, in solids or )"
                   "fluid.bodies";
    for (const char* particles : {".csv", ".h5", ".hdf5"})
        if (kind == particles)
            return R"(is no scene; one takes its particles, {"shape": "file", "path": ...}, in )"
                   "fluid.bodies";
    return "";
}

std::string readText(const std::string& file) {
    const auto refuse = [&](const std::string& why) {
        throw Error(Failure::Scene, fmt::format("{}: {}", file, why));
    };
    if (!std::filesystem::exists(file))
        refuse("no such file; check the path, or name a shipped scene");
    if (const std::string use = usedAs(file); !use.empty()) refuse(use);
    if (std::filesystem::is_directory(file)) refuse("is a folder; name a scene file in it");
    std::ifstream stream(file, std::ios::binary);
    if (!stream) refuse("can't be opened; check its permissions");
    std::string text(LargestFile + 1, '\0');
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(stream.gcount()));
    if (text.size() > LargestFile) refuse("is larger than 16 MiB, which no scene file is");
    return text;
}

// Each list becomes as long as the file's, each member from the defaults.
template <class T>
void resizeList(Json& root, const std::string& path, std::vector<T>& list, const Place& place) {
    const Json* json = find(root, path);
    if (!json) return;
    if (!json->is_array())
        place.fail(path,
                   fmt::format("expected a list of objects [{{...}}], found {}", shown(*json)));
    list.assign(json->size(), T{});
    for (size_t i = 0; i < json->size(); ++i)
        if (!(*json)[i].is_object())
            place.fail(fmt::format("{}[{}]", path, i),
                       fmt::format("expected an object {{...}}, found {}", shown((*json)[i])));
    if (json->empty()) {  // done, and no knob knows it
        const size_t dot = path.rfind('.');
        (dot == std::string::npos ? root : root[path.substr(0, dot)]).erase(path.substr(dot + 1));
    }
}

void readScene(Json& root, Scene& scene, const Place& place) {
    if (root.is_object()) root.erase("$schema");  // tells an editor where the schema is
    visitLists(scene, [&](const char* path, auto& list, const char*) {
        resizeList(root, path, list, place);
    });
    readKnobs(root, scene, place);
}

Json toJson(float value) { return decimal(value); }
Json toJson(int value) { return value; }
Json toJson(bool value) { return value; }
Json toJson(const std::string& value) { return value; }
Json toJson(Vec3 v) { return Json::array({decimal(v.x), decimal(v.y), decimal(v.z)}); }
Json toJson(Vec3d v) { return Json::array({v.x, v.y, v.z}); }
Json toJson(const Keyframes& keyframes) {
    Json list = Json::array();
    for (const Keyframe& k : keyframes)
        k.hasRates ? list.push_back({k.time, k.offset.x, k.offset.y, k.offset.z, k.turn,
                                     k.velocity.x, k.velocity.y, k.velocity.z, k.spin})
                   : list.push_back({k.time, k.offset.x, k.offset.y, k.offset.z, k.turn});
    return list;
}
Json toJson(const Rates& rates) {
    Json list = Json::array();
    for (const Rate& r : rates) list.push_back({r.time, r.value});
    return list;
}
template <class E>
requires std::is_enum_v<E> Json toJson(E value) { return enumNames(value)[size_t(value)]; }

// The place in `root` of a path such as "fluid.bodies[0].min", made where it isn't yet.
Json& placeFor(Json& root, const std::string& path) {
    std::string pointer = "/" + path;
    for (char& c : pointer)
        if (c == '.' || c == '[') c = '/';
    std::erase(pointer, ']');
    return root[Json::json_pointer(pointer)];
}

// Objects over several lines, lists of plain values on one.
void write(const Json& json, const std::string& indent, std::string& out) {
    const bool nested =
        !json.empty() && (json.is_object() || (json.is_array() && json[0].is_structured()));
    if (!nested) {
        std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
        if (json.is_array())
            for (size_t at = 0; (at = text.find(',', at)) != std::string::npos; at += 2)
                text.insert(at + 1, 1, ' ');
        out += text;
        return;
    }
    const std::string inner = indent + "    ";
    out += json.is_object() ? "{" : "[";
    bool first = true;
    for (const auto& [key, value] : json.items()) {
        out += (first ? "\n" : ",\n") + inner;
        if (json.is_object()) out += fmt::format("\"{}\": ", key);
        write(value, inner, out);
        first = false;
    }
    out += fmt::format("\n{}{}", indent, json.is_object() ? '}' : ']');
}

// Motions and what sources give over time; a relative path starts at the folder.
void readTables(Scene& scene, const std::string& folder, const std::string& place) {
    readMotions(scene, folder, place);
    readRates(scene, folder, place);
}

// What follows "=": JSON if it is, numbers with commas as a list, else plain text.
Json looseValue(const std::string& text) {
    if (text.empty()) return text;
    for (const std::string& attempt : {text, "[" + text + "]"}) try {
            return parseJson(attempt, "--set");
        } catch (const Error&) {}
    return text;
}

}  // namespace

Scene parseScene(const std::string& text, const std::string& place) {
    Json root = parseJson(text, place);
    if (root.is_object() && !root.contains("version")) return readHistorical(root, place);
    Scene scene;
    readScene(root, scene, Place{place, ""});
    requireOneOfRatesAndFile(scene, place);
    readTables(scene, std::filesystem::path(place).parent_path().string(), place);
    return scene;
}

Scene loadScene(const std::string& file) {
    const std::string text = readText(file);
    Scene scene = parseScene(text, file);
    if (parseJson(text, file).value("name", "").empty())
        scene.name = std::filesystem::path(file).stem().string();
    // A file that a scene names is beside it; known by its whole path the scene can be saved
    // anywhere.
    auto findBeside = [&](std::string& path) {
        if (!path.empty())
            path =
                (std::filesystem::absolute(file).parent_path() / path).lexically_normal().string();
    };
    for (Body& body : scene.fluid.bodies) findBeside(body.path);
    for (Solid& solid : scene.solids) findBeside(solid.path);
    for (Object& object : scene.objects) findBeside(object.path);
    findBeside(scene.view.colorFile);
    return scene;
}

std::string writeScene(const Scene& scene) {
    Json root;
    visitKnobs(scene, [&](const std::string& path, const auto& value, const Knob&) {
        placeFor(root, path) = toJson(value);
    });
    visitLists(scene, [&](const char* path, const auto& list, const char*) {
        if (list.empty()) placeFor(root, path) = Json::array();
    });
    std::string out;
    write(root, "", out);
    return out + "\n";
}

void setKnob(Scene& scene, const std::string& assignment, const std::string& origin) {
    const size_t equals = assignment.find('=');
    const Place place{origin, " (`spindrift --help` lists all knobs)"};
    if (equals == std::string::npos)
        place.fail(assignment, "expected path=value, e.g. fluid.viscosity=0.1");
    const std::string path = assignment.substr(0, equals), text = assignment.substr(equals + 1);
    const Json value = looseValue(text);

    Scene changed = scene;
    bool found = false;
    visitLists(changed, [&](const char* list, auto&, const char*) { found |= path == list; });
    if (found) {
        Json root;
        placeFor(root, path) = value;
        readScene(root, changed, place);
        requireOneOfRatesAndFile(changed, origin);
        readTables(changed, "", origin);
        scene = changed;
        return;
    }
    std::vector<std::string> known;
    visitKnobs(changed, [&](const std::string& name, auto& knobValue, const Knob& knob) {
        known.push_back(name);
        if (name != path) return;
        found = true;
        // Text is taken as it stands, so that output.csv=1 is a file name.
        constexpr bool isText = std::is_same_v<std::decay_t<decltype(knobValue)>, std::string>;
        assign(knobValue, isText && !value.is_string() ? Json(text) : value, knob, place, path);
    });
    if (found) {
        readTables(changed, "", origin);
        scene = changed;
        return;
    }
    // Within a member of a list the keys of that member are meant.
    const size_t bracket = path.find("].");
    std::string body = bracket == std::string::npos ? "" : path.substr(0, bracket + 2);
    if (std::none_of(known.begin(), known.end(), [&](auto& k) { return k.starts_with(body); }))
        body.clear();
    place.fail(path, fmt::format("unknown knob; {}{}",
                                 adviceFor(body, path.substr(body.size()), known), place.hint));
}

void requireRanges(const Scene& scene, const std::string& place) {
    visitKnobs(scene, [&](const std::string& path, const auto& value, const Knob& knob) {
        if (!inRange(value, knob))
            Place{place, ""}.fail(path, fmt::format("{} is out of range, allowed: {}",
                                                    shown(toJson(value)), allowedRange(knob)));
    });
}

}  // namespace spindrift
