#include "app/window/ui.h"

#include "core/error.h"
#include "core/output_file.h"

#include <fmt/format.h>

#include <algorithm>
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
    if (player.looksBack()) return playMoments();
    player.running = !player.running && player.halted.empty();
    stale = true;
}

void Ui::reset() { player.reset(); }

void Ui::load(const std::string& file) { player.load(file); }

void Ui::takeLoaded() {
    const std::string before = player.file();
    const Scene knobsBefore = player.scene;
    try {
        if (!player.takeLoaded()) return;
        endRecording();
        picked.reset();
        pickedSolid = -1;
        isSlow = false, slowSince = uiTime();
        if (player.file() != before) {
            knobs = KnobHistory(player.scene);
            ruler.reset(), measuring = false, bookmarks = {};
            say("loaded " + player.file());
        } else if (const auto changed =
                       changedKnobs(knobsBefore, player.scene, KnobKind::ButCamera);
                   !changed.empty()) {
            say("as loaded again: " + joined(changed) + " (Ctrl + Z brings them back)");
        }
    } catch (const Error& error) { say(error.what(), true); }
    stale = rewrite = true;
}

Escape escapeFrom(const Opened& o) {
    if (o.question) return Escape::Stay;
    if (o.loading) return Escape::CancelLoading;
    if (o.popup) return Escape::ClosePopup;
    if (o.help) return Escape::CloseHelp;
    if (o.looksBack) return Escape::ReturnToPresent;
    if (o.fullscreen) return Escape::LeaveFullScreen;
    return o.unsaved ? Escape::Ask : Escape::Leave;
}

void Ui::escape() {
    switch (escapeFrom({asking, player.loading() != nullptr, popupOpen, showHelp,
                        player.looksBack(), fullscreen, player.unsaved()})) {
        case Escape::Stay:
            asking = false;
            break;
        case Escape::CancelLoading:
            player.cancelLoading();
            say("cancelled");
            break;
        case Escape::ClosePopup:
            closePopups = true;
            break;
        case Escape::CloseHelp:
            showHelp = false;
            break;
        case Escape::ReturnToPresent:
            returnToPresent();
            break;
        case Escape::LeaveFullScreen:
            fullscreen = false;
            break;
        case Escape::Ask:
            asking = true;
            break;
        case Escape::Leave:
            quit = true;
            break;
    }
}

// To close the window while the question is there is an answer.
void Ui::leave() {
    quit = asking || !player.unsaved();
    asking = true;
}

void Ui::undo() {
    const std::vector<std::string> paths = knobs.undo(player.scene);
    if (paths.empty()) return say("no change of a knob is left to undo");
    player.knobsChanged();
    stale = rewrite = true;
    say("undone: " + joined(paths));
}

// What a moment of before brings with it is no change, until the run goes on from there.
void Ui::settleKnobs() {
    if (!player.looksBack()) knobs.settle(player.scene);
}

bool Ui::lookBack() {
    replay.playing = false;
    if (player.looksBack()) return true;
    stale = rewrite = true;
    try {
        return player.lookBack();
    } catch (const Error& error) {  // a GPU was lost
        say(error.what(), true);
        return false;
    }
}

void Ui::lookAt(double time) {
    if (lookBack()) player.look(player.history().at(time));
}

void Ui::lookOn(int moments) {
    if (!lookBack()) return;
    const int at = int(player.lookedAt()) + moments;
    if (at >= 0) player.look(size_t(at));
}

void Ui::playMoments() {
    if (replay.playing || !lookBack()) {
        replay.playing = false;
        return;
    }
    if (player.lookedAt() + 1 == player.history().size()) player.look(0);
    replay.start();
    replayedAt = uiTime();
}

void Ui::replayOn() {
    const double passed = uiTime() - std::exchange(replayedAt, uiTime());
    if (!player.looksBack()) replay.playing = false;
    if (!replay.playing) return;
    const double speed = double(player.scene.view.speed);
    player.look(replay.next(player.history(), player.lookedAt(), passed, speed));
}

void Ui::goOnFromHere() {
    if (!player.looksBack()) return;
    replay.playing = false;
    const std::shared_ptr<const Scene> present = player.history().back().asked;
    const Scene before = knobs.settled();
    try {
        player.goOnFromHere();
    } catch (const Error& error) { return say(error.what(), true); }
    if (player.scene.simulation.formulation != present->simulation.formulation)
        endRecording();  // its series would get other columns
    noteDevice();
    const auto changed = changedKnobs(before, player.scene, KnobKind::Physics);
    say(fmt::format("goes on from {:.4g} s{}", player.measurement().time,
                    changed.empty() ? ""
                                    : " with other knobs than before: " + joined(changed) +
                                          " (Ctrl + Z brings those back)"));
}

void Ui::returnToPresent() {
    replay.playing = false;
    player.returnToPresent();
}

void Ui::toggleRecording() {
    if (recording) return endRecording();
    if (player.looksBack())
        return say("looking back: Enter goes on from here, then it can be recorded");
    try {
        recording = std::make_unique<Recording>(player.scene, player.measurement().time, area.width,
                                                area.height);
        say("recording; V ends it");
    } catch (const Error& error) { say(error.what(), true); }
}

void Ui::endRecording() {
    if (!recording) return;
    const std::unique_ptr<Recording> ended = std::move(recording);
    if (ended->seconds() == 0) return say("nothing was recorded");
    try {
        ended->finish();
        std::printf("%s\n%s\n", ended->film().c_str(), ended->series().c_str());
        std::fflush(stdout);
        say(fmt::format("film of {:.3g} s: {}\nseries: {}", ended->seconds(), ended->film(),
                        ended->series()));
        message.until += 4;  // two paths to read
    } catch (const Error& error) { say(error.what(), true); }
}

float Ui::stirRadius() const {
    const Scene& scene = player.scene;
    const Vec3 size = scene.domain.max - scene.domain.min;
    const float side = scene.simulation.dimensions == 2 ? std::min(size.x, size.y)
                                                        : std::min({size.x, size.y, size.z});
    return scene.view.stir.radius > 0 ? scene.view.stir.radius
                                      : std::max(side / 8, 2 * scene.simulation.spacing);
}

void Ui::setStirRadius(float wanted) {
    const Scene& scene = player.scene;
    player.scene.view.stir.radius =
        std::clamp(wanted, scene.simulation.spacing, length(scene.domain.max - scene.domain.min));
    stale = true;
}

std::string Ui::whyNoSwitch() const {
    return onGpu ? "" : !noGpu.empty() ? noGpu : whyNotForGpus(player.scene);
}

void Ui::switchBackend() {
    if (const std::string why = whyNoSwitch(); !why.empty())
        return say("no GPU to switch to: " + why, true);
    try {
        player.goOnWith(player.scene.simulation.formulation, onGpu ? Backend::Cpu : Backend::Cuda);
        noteDevice();
        say(std::string("goes on, on the ") + (onGpu ? "GPU" : "CPU"));
    } catch (const Error& error) { say(error.what(), true); }
}

// What lasts: not the moments in which a run begins or is disturbed.
void Ui::noteWhetherSlow() {
    const double factor = player.realTimeFactor(), wanted = double(player.scene.view.speed);
    const bool late = player.running && factor > 0 && factor < 0.8 * wanted,
               inTime = player.running && factor >= 0.95 * wanted;
    if (isSlow ? !inTime : !late) slowSince = uiTime();
    if (uiTime() - slowSince < 1.5) return;
    isSlow = !isSlow, slowSince = uiTime();
    remedies =
        isSlow ? remediesFor(player.scene, player.beganFromCheckpoint()) : std::vector<Remedy>{};
}

void Ui::take(Remedy::How how) {
    // Of the scene as it is now: knobs may have changed since the remedies were offered.
    for (const Remedy& remedy : remediesFor(player.scene, player.beganFromCheckpoint())) {
        if (remedy.how != how) continue;
        try {
            take(remedy);
        } catch (const Error& error) { say(error.what(), true); }
    }
    remedies = remediesFor(player.scene, player.beganFromCheckpoint());
}

void Ui::take(const Remedy& remedy) {
    switch (remedy.how) {
        case Remedy::How::Again:
            return player.beginAnew(remedy.scene);
        case Remedy::How::GoOn:
            player.goOnWith(remedy.scene.simulation.formulation, player.scene.compute.backend);
            endRecording();  // its series would get other columns
            noteDevice();
            return say("goes on, and solves for pressures");
        case Remedy::How::Live:
            copyKnobs(player.scene, remedy.scene, KnobKind::Physics);
            return player.knobsChanged();
    }
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
    player.scene.view.camera = player.loadedScene().view.camera;
    stale = true;
}

void Ui::keepView(size_t bookmark) {
    bookmarks[bookmark] = player.scene.view.camera;
    say(fmt::format("view kept: F{} shows it again", bookmark + 5));
}

void Ui::showView(size_t bookmark) {
    if (!bookmarks[bookmark])
        return say(fmt::format("no view is kept here: Shift + F{} keeps this one", bookmark + 5));
    player.scene.view.camera = *bookmarks[bookmark];
    stale = true;
}

void Ui::useRuler(Vec3 at) {
    if (measuring)
        measuring = false;
    else if (ruler)
        ruler.reset();
    else
        ruler = {at, at}, measuring = true;
    if (measuring) say("measures from here to the mouse; M ends");
    stale = true;
}

void Ui::stretchRuler(Vec3 to) {
    (*ruler)[1] = to;
    const Vec3 way = to - (*ruler)[0];
    say(fmt::format("{:.4g} m: {:.4g}, {:.4g}, {:.4g}", length(way), way.x, way.y, way.z));
    stale = true;
}

std::vector<std::array<Vec3, 2>> Ui::marks() const {
    return ruler ? std::vector<std::array<Vec3, 2>>{*ruler} : std::vector<std::array<Vec3, 2>>{};
}

namespace {

// Saves by save(path) under the first free name in this folder and returns the path; "" and a
// message when that fails.
template <class Save>
std::string saveAs(Ui& ui, const std::string& extension, const std::string& more, Save save) {
    try {
        const std::string path = std::filesystem::absolute(freeName(extension)).string();
        requireWritable(path);
        save(path);
        std::printf("%s\n", path.c_str());
        std::fflush(stdout);
        ui.say("saved " + path + more);
        return path;
    } catch (const Error& error) {
        ui.say(error.what(), true);
        return "";
    }
}

}  // namespace

void Ui::takeScreenshot() {
    screenshot = false;
    saveAs(*this, ".png", "", [&](const std::string& path) { writePng(path, frame.image()); });
}

// Of a run that was stopped by itself: its last good state.
bool Ui::saveCheckpoint() {
    return !saveAs(*this, ".h5", ", from which the run can go on", [&](const std::string& path) {
                player.saveCheckpoint(path);
            }).empty();
}

void Ui::saveCurves() {
    saveAs(*this, ".csv", "",
           [&](const std::string& path) { writeText(path, csvOf(player.curves())); });
}

std::string csvOf(const Curves& h) {
    std::string text = "time [s]";
    for (const char* form : {"kinetic", "potential", "total"})
        text += fmt::format(",{} energy [{}]", form, perDepth("J", h.dimensions));
    text += ",mean density error\n";
    for (size_t i = 0; i < h.time.size(); ++i)
        text += fmt::format("{},{},{},{},{}\n", h.time[i], h.kinetic[i], h.potential[i], h.total[i],
                            h.densityError[i]);
    return text;
}

namespace {

std::optional<Particle> nearestTo(Vec3d place, const std::vector<Particle>& particles) {
    const auto found = std::min_element(
        particles.begin(), particles.end(), [&](const Particle& a, const Particle& b) {
            return length(a.position - place) < length(b.position - place);
        });
    return found == particles.end() ? std::nullopt : std::optional(*found);
}

}  // namespace

// The particle in front whose sphere the ray through the mouse meets, of those that are shown;
// where fluid isn't drawn, the one that is nearest to the surface under the mouse.
void Ui::pick() {
    const Scene& scene = player.scene;
    const Vec3d corner = toDouble(scene.domain.min);
    const bool unseen = scene.view.slice.axis != Across::None && !scene.view.slice.fluid;
    const std::array<float, 2> at = *pickAt;
    const Ray ray = camera().ray(at[0], at[1], float(area.width), float(area.height));
    const Vec3d origin = toDouble(ray.origin), direction = toDouble(ray.direction);
    const double radius = 0.5 * scene.simulation.spacing * scene.view.particleScale;
    const std::optional<Vec3> seen = frame.surfaceAt(int(at[0]), int(at[1]));
    double nearest = unseen ? 2 * double(scene.simulation.spacing) : 1e30;
    std::optional<Vec3d> place;
    pickAt.reset();
    picked.reset();
    pickedSolid = -1;
    for (const Vec3& shown : frame.shownFluid(scene)) {
        if (unseen && !seen) break;
        const Vec3d to = toDouble(shown) - origin;
        const double along = dot(to, direction);
        const bool isMet = along > 0 && dot(to, to) - along * along <= radius * radius;
        if (!unseen && !isMet) continue;
        const double far = unseen ? length(toDouble(shown - *seen)) : along;
        if (far >= nearest) continue;
        nearest = far;
        place = toDouble(shown) + corner;
    }
    const bool inFront =
        seen && (unseen || length(toDouble(*seen) - origin) < nearest - 2 * radius);
    if (inFront) pickedSolid = player.simulation().solidAt(toDouble(*seen) + corner);
    if (place && pickedSolid < 0) picked = nearestTo(*place, player.simulation().particles());
    player.scene.view.pathOf = picked ? picked->id : -1;
    stale = rewrite = true;
}

void Ui::grab() {
    grabWanted = false;
    const Vec3 point = stirCenter + player.scene.domain.min;
    const int solid = player.simulation().solidAt(toDouble(point));
    if (solid < 0 || drag != Drag::Stir) return;
    if (player.scene.time.mode == TimeMode::Local)
        return say("obstacles can't be dragged with local steps (time.mode)", true);
    player.stir({});
    drag = Drag::Solid;
    hold = {solid, toFloat(player.measurement().solids[size_t(solid)].position) - point};
}

void Ui::refreshPicked() {
    if (picked) picked = player.simulation().find(picked->id);
}

std::vector<Ring> Ui::rings() const {
    std::vector<Ring> marks;
    if (drag == Drag::Stir || (sizing && drag == Drag::None))
        marks.push_back({stirCenter, stirRadius(), {1.0f, 0.85f, 0.4f}});
    if (drag == Drag::Solid)
        marks.push_back({stirCenter, 2 * player.scene.simulation.spacing, {1.0f, 0.85f, 0.4f}});
    for (const Particle& p : player.culprits)
        marks.push_back({toFloat(p.position) - player.scene.domain.min,
                         2 * player.scene.simulation.spacing,
                         {1.0f, 0.2f, 0.1f}});
    if (picked)
        marks.push_back({toFloat(picked->position) - player.scene.domain.min,
                         0.9f * player.scene.simulation.spacing,
                         {1.0f, 0.35f, 0.45f}});
    return marks;
}

}  // namespace spindrift
