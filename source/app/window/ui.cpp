#include "app/window/ui.h"

#include "core/error.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

namespace spindrift {

double uiTime() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::string freeName(const std::string& extension, const std::string& folder) {
    for (int i = 1;; ++i) {
        const std::string name = fmt::format("spindrift-{:03}{}", i, extension);
        if (!std::filesystem::exists(std::filesystem::path(folder) / name)) return name;
    }
}

OrbitCamera Ui::camera() const {
    return cameraOf(player.scene, float(area.width) / float(area.height));
}

void Ui::moveCamera(const OrbitCamera& camera) {
    keepCamera(player.scene, camera);
    stale = true;
}

void Ui::say(const std::string& text, bool error) {
    message = {text, error, uiTime() + (error ? 12 : 4)};
}

void Ui::toggleRun() {
    player.running = !player.running && player.halted.empty();
    stale = true;
}

void Ui::reset() {
    try {
        player.reset();
        picked.reset();
    } catch (const Error& error) { say(error.what(), true); }
}

void Ui::load(const std::string& file) {
    try {
        player.load(file);
        picked.reset();
        say("loaded " + std::filesystem::path(file).filename().string());
    } catch (const Error& error) { say(error.what(), true); }
}

void Ui::switchBackend() {
    if (!noGpu.empty()) return say("no GPU to switch to: " + noGpu, true);
    try {
        player.switchBackend(onGpu ? Backend::Cpu : Backend::Cuda);
        noteDevice();
        say(std::string("goes on, on the ") + (onGpu ? "GPU" : "CPU"));
    } catch (const Error& error) { say(error.what(), true); }
}

void Ui::noteDevice() {
    device = player.simulation().deviceName();
    onGpu = player.simulation().cudaDevice() != hostMemory;
    rewrite = stale = true;
}

void Ui::colorBy(ColorBy by) {
    player.scene.view.colorBy = by;
    stale = rewrite = true;
}

void Ui::resetCamera() {
    player.scene.view.camera = player.initialCamera();
    stale = true;
}

void Ui::takeScreenshot() {
    screenshot = false;
    try {
        const std::string name = freeName(".png");
        writePng(name, frame.image());
        std::printf("%s\n", std::filesystem::absolute(name).c_str());
        std::fflush(stdout);
        say("saved " + name);
    } catch (const Error& error) { say(error.what(), true); }
}

// Of a run that was stopped by itself: its last good state.
void Ui::saveCheckpoint() {
    try {
        const std::string name = freeName(".h5");
        player.saveCheckpoint(name);
        std::printf("%s\n", std::filesystem::absolute(name).c_str());
        std::fflush(stdout);
        say("saved " + name + ", from which the run can go on");
    } catch (const Error& error) { say(error.what(), true); }
}

// The particle in front whose sphere the ray through the mouse meets.
void Ui::pick() {
    const Vec3d corner = toDouble(player.scene.domain.min);
    const Ray ray = camera().ray((*pickAt)[0], (*pickAt)[1], float(area.width), float(area.height));
    const Vec3d origin = toDouble(ray.origin) + corner, direction = toDouble(ray.direction);
    const double radius = 0.5 * player.scene.simulation.spacing * player.scene.view.particleScale;
    double nearest = 1e30;
    pickAt.reset();
    picked.reset();
    for (const Particle& p : player.simulation().particles()) {
        const Vec3d to = p.position - origin;
        const double along = dot(to, direction);
        if (along <= 0 || along >= nearest || dot(to, to) - along * along > radius * radius)
            continue;
        nearest = along;
        picked = p;
    }
    stale = true;
}

void Ui::grab() {
    grabWanted = false;
    const Vec3 point = stirCenter + player.scene.domain.min;
    const int solid = player.simulation().solidAt(toDouble(point));
    if (solid < 0 || drag != Drag::Stir) return;
    if (player.scene.time.mode == TimeMode::Local) return say("obstacles can't be dragged with local steps (time.mode)", true);
    player.stir({});
    drag = Drag::Solid;
    hold = {solid, toFloat(player.measurement().solids[size_t(solid)].position) - point};
}

void Ui::refreshPicked() {
    if (picked && picked->id < player.simulation().fluidCount())
        picked = player.simulation().particle(picked->id);
}

std::vector<Ring> Ui::rings() const {
    std::vector<Ring> marks;
    if (drag == Drag::Stir) marks.push_back({stirCenter, stirRadius, {1.0f, 0.85f, 0.4f}});
    if (drag == Drag::Solid) marks.push_back({stirCenter, 2 * player.scene.simulation.spacing, {1.0f, 0.85f, 0.4f}});
    for (const Particle& p : player.culprits)
        marks.push_back({toFloat(p.position) - player.scene.domain.min, 2 * player.scene.simulation.spacing, {1.0f, 0.2f, 0.1f}});
    if (picked)
        marks.push_back({toFloat(picked->position) - player.scene.domain.min,
                         0.9f * player.scene.simulation.spacing,
                         {1.0f, 0.35f, 0.45f}});
    return marks;
}

}  // namespace spindrift
