// The list of knobs: complete, without doubles, defaults in range, save and load is the identity.
#include "scene/json.h"
#include "scene/read_knobs.h"
#include "scene/schema.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace spindrift {
namespace {

std::vector<std::string> configs() {
    std::vector<std::string> files;
    for (auto& entry :
         std::filesystem::recursive_directory_iterator(SPINDRIFT_SOURCE_DIR "/configs"))
        if (entry.path().extension() == ".json") files.push_back(entry.path().string());
    return files;
}

// Converts to anything, so that a struct of n fields can be initialised by at most n of them.
struct Anything {
    template <class T> operator T() const;
};
template <class S, class... Fields> consteval int fieldCount() {
    if constexpr (requires { S{Fields{}..., Anything{}}; })
        return fieldCount<S, Fields..., Anything>();
    else
        return sizeof...(Fields);
}

int knobCount(const Scene& scene) {
    int count = 0;
    visitKnobs(scene, [&](const std::string&, const auto&, const Knob&) { ++count; });
    return count;
}

// Of all kinds together.
template <class Member> int memberKnobs() {
    std::set<std::string> names;
    for (const Member& member : oneOfEachKind<Member>())
        visitMember(member, "m",
                    [&](const std::string& path, const auto&, const Knob&) { names.insert(path); });
    return int(names.size());
}

TEST(Schema, UnitsHaveOneSpelling) {
    const Scene scene;
    visitKnobs(scene, [&](const std::string& path, const auto&, const Knob& knob) {
        EXPECT_EQ(std::string(knob.unit).find('^'), std::string::npos) << path;
    });
}

TEST(Schema, EveryFieldOfASceneHasItsLine) {
    Scene scene;
    scene.fluid.bodies.clear();
    const int structs = 17;  // window ... output and the lists, each one field of Scene
    const int fields =
        fieldCount<Scene>() - structs + fieldCount<Window>() + fieldCount<Compute>() +
        fieldCount<SimulationKnobs>() + fieldCount<Domain>() + fieldCount<Walls>() +
        fieldCount<Contact>() + fieldCount<Fluid>() - 1 /* bodies */ + fieldCount<TimeKnobs>() +
        fieldCount<Solver>() + fieldCount<View>() - 6 /* structs of its own */ +
        fieldCount<Camera>() + fieldCount<Stirrer>() + fieldCount<Clip>() + fieldCount<Slice>() +
        fieldCount<Threshold>() + fieldCount<Arrows>() + fieldCount<Output>() - 1 /* probes */;
    EXPECT_EQ(knobCount(scene), fields);

    EXPECT_EQ(memberKnobs<Body>(),
              fieldCount<Form>() + fieldCount<Body>() - 2 /* the base, and normal of solids */);
    EXPECT_EQ(memberKnobs<Solid>(), fieldCount<Form>() + fieldCount<Solid>() - 1);
    EXPECT_EQ(memberKnobs<Object>(), fieldCount<Object>());
    EXPECT_EQ(memberKnobs<Grip>(), fieldCount<Grip>());
    EXPECT_EQ(memberKnobs<Cut>(), fieldCount<Cut>());
    EXPECT_EQ(memberKnobs<Source>(), fieldCount<Source>());
    EXPECT_EQ(memberKnobs<Sink>(), fieldCount<Sink>());
    EXPECT_EQ(memberKnobs<Probe>(), fieldCount<Probe>());
}

TEST(Schema, NamesAreUniqueAndSnakeCase) {
    std::set<std::string> names;
    const Scene scene;
    visitKnobs(scene, [&](const std::string& path, const auto&, const Knob& knob) {
        EXPECT_TRUE(names.insert(path).second) << path;
        EXPECT_EQ(path.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_.[]"),
                  std::string::npos)
            << path;
        EXPECT_NE(std::string(knob.help), "") << path;
        EXPECT_LE(knob.min, knob.max) << path;
    });
}

TEST(Schema, DefaultsAreInRange) {
    EXPECT_NO_THROW(requireRanges(Scene{}, "defaults"));
    for (Shape shape : {Shape::Sphere, Shape::Cylinder}) {
        Scene scene;
        scene.fluid.bodies[0].shape = shape;
        EXPECT_NO_THROW(requireRanges(scene, "defaults"));
    }
}

TEST(Schema, NotANumberAndInfinityAreOutOfRange) {
    for (float bad : {NAN, INFINITY, -INFINITY}) {
        Scene scene;
        scene.simulation.gravity.z = bad;
        EXPECT_THROW(requireRanges(scene, "scene"), Error);
        scene = {};
        scene.fluid.viscosity = bad;
        EXPECT_THROW(requireRanges(scene, "scene"), Error);
    }
}

// Gives every knob a value that isn't its default.
struct Change {
    void operator()(const std::string& path, float& v, const Knob& k) const {
        const float other = v + 0.37f * (k.max - v) / 3;
        v = path.starts_with("fluid.bodies") ? v + 0.123f : std::min(other, k.max);
    }
    void operator()(const std::string& path, int& v, const Knob& k) const {
        if (path != "version") v = v + 1 <= k.max ? v + 1 : v - 1;
    }
    void operator()(const std::string&, bool& v, const Knob&) const { v = !v; }
    void operator()(const std::string&, Keyframes& v, const Knob&) const {
        v = {{0, {1, 2, 3}, 4}, {0.1f, {-1, 0, 0}, 0}};
    }
    void operator()(const std::string& path, Rates& v, const Knob&) const {
        v.clear();
        if (path.ends_with(".velocities")) v = {{0.5f, 1.5f}, {2, 0.1f}};  // beside them no flows
    }
    void operator()(const std::string& path, std::string& v, const Knob&) const {
        if (path.ends_with(".motion") || path.starts_with("sources[0].path"))
            return;  // are read and forgotten
        v += " \"new\" \\ \n\t \xc3\xbc // no comment";
    }
    void operator()(const std::string&, Vec3& v, const Knob& k) const {
        const Vec3 before = v;
        v = v + Vec3{0.1f, 1e-7f, std::max(-12.3456789f, 0.7f * k.min)};
        for (int i = 0; i < 3; ++i)
            if (v[i] > k.max) v[i] = before[i] - 0.1f;
    }
    void operator()(const std::string&, Vec3d& v, const Knob&) const {
        v = v + Vec3d{0.1, 1e-17, -500123.45678901234};
    }
    template <class E>
    requires std::is_enum_v<E>
    void operator()(const std::string& path, E& v, const Knob&) const {
        if (!path.ends_with("shape") && !path.ends_with("kind"))
            v = E((int(v) + 1) % int(enumNames(v).size()));
    }
};

TEST(Schema, SaveAndLoadIsTheIdentity) {
    Scene scene;
    EXPECT_EQ(writeScene(parseScene(writeScene(scene), "text")), writeScene(scene));

    Body sphere, cylinder;
    sphere.shape = Shape::Sphere;
    cylinder.shape = Shape::Cylinder;
    scene.fluid.bodies = {Body{}, sphere, cylinder};
    scene.solids.resize(2);
    scene.sources.resize(1);
    scene.output.probes = oneOfEachKind<Probe>();
    visitKnobs(scene, Change{});
    const Scene again = parseScene(writeScene(scene), "text");
    EXPECT_EQ(writeScene(again), writeScene(scene));
    // The values themselves, not their text.
    EXPECT_EQ(again.simulation.gravity, scene.simulation.gravity);
    EXPECT_EQ(again.simulation.spacing, scene.simulation.spacing);
    EXPECT_EQ(again.window.title, scene.window.title);
    EXPECT_EQ(again.fluid.bodies[2].axis, Axis::Z);
    EXPECT_EQ(again.compute.threads, 1);
    EXPECT_NE(writeScene(scene), writeScene(Scene{}));
}

TEST(Schema, FloatsAreWrittenShort) {
    const std::string text = writeScene(Scene{});
    EXPECT_NE(text.find("\"spacing\": 0.02,"), std::string::npos) << text;
    EXPECT_NE(text.find("[0.0, -9.81, 0.0]"), std::string::npos) << text;
}

TEST(Schema, AllConfigsLoadAndSurviveSaving) {
    const auto files = configs();
    EXPECT_GE(files.size(), 12u);
    for (const std::string& file : files) {
        const Scene scene = loadScene(file);
        EXPECT_EQ(writeScene(parseScene(writeScene(scene), file)), writeScene(scene)) << file;
    }
}

TEST(Schema, JsonSchemaHasEveryKnob) {
    const Json schema = parseJson(jsonSchema(), "schema");
    const Scene scene;
    visitKnobs(scene, [&](std::string path, const auto&, const Knob&) {
        std::string pointer;
        if (path.starts_with("fluid.bodies[0]."))
            pointer = "/properties/fluid/properties/bodies/items/properties/" + path.substr(16);
        else
            for (size_t dot; !path.empty(); path.erase(0, dot)) {
                dot = std::min(path.find('.'), path.size());
                pointer += "/properties/" + path.substr(0, dot);
                if (dot < path.size()) ++dot;
            }
        EXPECT_TRUE(schema.contains(Json::json_pointer(pointer))) << pointer;
    });
    EXPECT_EQ(schema["properties"]["fluid"]["properties"]["viscosity"]["maximum"].get<float>(),
              1000);
}

TEST(Schema, TableHasEveryKnobAndItsUnit) {
    const std::string table = knobTable();
    for (const char* text : {"fluid.viscosity", "Pa s", "fluid.bodies[i].height",
                             "wendland_c2|cubic_spline|wendland_c4"})
        EXPECT_NE(table.find(text), std::string::npos) << text;
}

// Below its mark docs/SCENES.md is what `spindrift schema --markdown` writes.
TEST(Schema, ReferenceInTheDocsIsUpToDate) {
    std::ifstream file(SPINDRIFT_SOURCE_DIR "/docs/SCENES.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}}, mark = "\n<!-- knobs -->\n\n";
    const size_t at = page.find(mark);
    ASSERT_NE(at, std::string::npos) << "docs/SCENES.md has no line <!-- knobs -->";
    EXPECT_EQ(page.substr(at + mark.size()), knobReference())
        << "`make knobs` brings docs/SCENES.md up to date";
}

}  // namespace
}  // namespace spindrift
