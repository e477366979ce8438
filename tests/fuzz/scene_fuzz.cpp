// Any text as a scene file, followed by lines "--set path=value", or, after a '#', bytes that turn
// the knobs of the built-in scene: it is taken, or refused with one line, and what is taken can be
// written, read again and filled with particles. Run by `make fuzz` (libFuzzer, with
// AddressSanitizer and UndefinedBehaviorSanitizer).
#include "core/error.h"
#include "scene/body_lattice.h"
#include "scene/check.h"
#include "scene/json.h"
#include "scene/particles.h"
#include "scene/schema.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>
#include <vector>

namespace {

using namespace spindrift;

void require(bool holds, const char* what, const std::string& shown = "") {
    if (holds) return;
    std::fprintf(stderr, "fuzz: %s: %s\n", what, shown.c_str());
    std::abort();
}

// The scene, and the knobs of the lines that begin with --set.
Scene readText(std::string text) {
    const std::string mark = "\n--set ";
    std::vector<std::string> knobs;
    for (size_t at = text.rfind(mark); at != std::string::npos; at = text.rfind(mark)) {
        knobs.insert(knobs.begin(), text.substr(at + mark.size()));
        text.resize(at);
    }
    Scene scene = parseScene(text, "fuzz");
    for (const std::string& knob : knobs) setKnob(scene, knob);
    return scene;
}

// Three bytes a knob: which one, and where in its range or beside it; a fourth may add a body or a
// solid.
Scene readBytes(const std::string& bytes) {
    Scene scene;
    for (size_t at = 0; at + 3 < bytes.size(); at += 4) {
        const auto byte = [&](size_t k) { return static_cast<unsigned char>(bytes[at + k]); };
        if (byte(3) > 245 && scene.fluid.bodies.size() < 5)
            scene.fluid.bodies.push_back({});
        else if (byte(3) > 235 && scene.solids.size() < 5)
            scene.solids.push_back({});
        int wanted = byte(0);
        visitKnobs(scene, [&](const std::string&, auto& value, const Knob& knob) {
            using T = std::decay_t<decltype(value)>;
            if (wanted-- != 0) return;
            const float share = float(byte(1) + 256 * byte(2)) / 65535, span = knob.max - knob.min;
            // Every third time by powers of ten from the lower end.
            const float number = byte(3) % 3 ? knob.min + share * span
                                             : knob.min + span * std::pow(10.0f, 8 * share - 8);
            if constexpr (std::is_enum_v<T>)
                value = T(byte(1) % enumNames(T()).size());
            else if constexpr (std::is_same_v<T, bool>)
                value = byte(1) % 2 == 1;
            else if constexpr (std::is_same_v<T, Vec3> || std::is_same_v<T, Vec3d>)
                value[byte(3) % 3] = number;
            else if constexpr (std::is_arithmetic_v<T>)
                value = T(number);
        });
    }
    return scene;
}

void requireSound(const Scene& scene) {
    const std::string written = writeScene(scene);
    require(writeScene(parseScene(written, "written")) == written,
            "a scene changes when it is written and read", written);
    const ParticleCount count = countParticles(scene);
    if (count.fluid + count.walls > 20000) return;
    // A thin body that the count allows may still have a lattice of many empty points.
    double points = 0;
    for (const Body& b : scene.fluid.bodies)
        points += double(latticePlanes(scene, b, 0)) * double(latticePlanes(scene, b, 1)) *
                  double(latticePlanes(scene, b, 2));
    if (points > 1e6) return;
    const Placement p = placeParticles(scene);
    require(int64_t(p.positions.size()) <= count.fluid, "more particles than counted");
    require(p.velocities.size() == p.positions.size() && p.pressures.size() == p.positions.size(),
            "fields of different length");
    const Vec3 size = scene.domain.max - scene.domain.min;
    const float slack = scene.simulation.jitter * scene.simulation.spacing + 1e-3f * length(size);
    for (size_t i = 0; i < p.positions.size(); ++i)
        for (int k = 0; k < 3; ++k) {
            const float x = p.positions[i][k];
            require(std::isfinite(x) && x >= -slack && x <= size[k] + slack,
                    "a particle starts outside the box", written);
            require(std::isfinite(p.velocities[i][k]) && std::isfinite(p.pressures[i]),
                    "a start that is no number", written);
        }
    require(std::isfinite(soundSpeed(scene, extentOf(p))), "a speed of sound that is no number",
            written);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    try {
        const std::string text(reinterpret_cast<const char*>(data), size);
        const Scene scene = text.starts_with('#') ? readBytes(text.substr(1)) : readText(text);
        writeScene(scene);
        checkScene(scene, "fuzz");
        requireSound(scene);
    } catch (const spindrift::Error& error) {
        const std::string what = error.what();
        require(!what.empty() && what.find('\n') == std::string::npos,
                "a refusal that is not one line", what);
    }
    return 0;
}
