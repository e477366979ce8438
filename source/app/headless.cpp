#include "app/exit_code.h"
#include "app/headless.h"

#include "app/explain.h"
#include "app/film.h"
#include "app/frame.h"
#include "app/output_files.h"
#include "app/progress.h"
#include "app/recorder.h"
#include "app/solid_shapes.h"
#include "app/surface_series.h"
#include "core/error.h"
#include "core/system.h"
#include "measure/checkpoint.h"
#include "measure/health.h"
#include "measure/particle_series.h"
#include "measure/poured.h"
#include "measure/probes.h"
#include "measure/save_particles.h"
#include "measure/series_files.h"
#include "measure/validity.h"
#include "render/egl_context.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

namespace spindrift {
namespace {

constexpr int DefaultSteps = 600;
// Steps between two looks at the health of a run that measures nothing else.
constexpr int HealthInterval = 20;

// What draws; there only when pictures are asked for.
struct Pictures {
    EglContext context;
    Frame frame;
    explicit Pictures(const Scene& scene)
        : context(scene.compute.device),
          frame(scene.window.width, scene.window.height, scene.window.samples) {}
    Image of(Simulation& simulation, const Scene& scene) {
        frame.update(simulation, scene);
        frame.draw(scene);
        return frame.image();
    }
    void save(Simulation& simulation, Scene& scene, const std::string& file) {
        writePng(file, of(simulation, scene));
    }
};

std::vector<SolidSurface> surfacesOf(const Scene& scene) {
    std::vector<SolidSurface> surfaces;
    for (const Solid& solid : scene.solids) {
        SolidSurface& surface = surfaces.emplace_back();
        for (const SolidShape::Corner& c : shapeOf(scene, solid).corners)
            surface.points.push_back(toDouble(c.position));
        for (int32_t k = 0; k + 2 < int32_t(surface.points.size()); k += 3)
            surface.triangles.push_back({k, k + 1, k + 2});
    }
    return surfaces;
}

// A knob's decimal number, which its float is but near to: a run of 0.1 s and a frame at 0.1 s end
// together.
double asWritten(float value) { return std::stod(fmt::format("{}", value)); }

class HeadlessRun {
public:
    HeadlessRun(const Start& start, bool quiet)
        : scene_(start.scene),
          view_(start.view),
          window_(start.window),
          quiet_(quiet),
          progress_(!quiet),
          probes_(start.scene),
          validity_(start.scene) {
        if (isInvalid()) throw Error(Failure::Invalid, refusal());
        requireOutputs(scene_.output, start);
        const Output& output = scene_.output;
        if (!output.screenshot.empty() || !output.frames.empty() || !output.video.empty()) {
            pictures_.emplace(scene_);
            scene_ = onDrawingDevice(std::move(scene_));
        }
        simulation_ = startSimulation(scene_, start.state);
        if (!quiet && !start.state && hasFluidMeshes())
            poured_ = pouredIntoMeshes(scene_, simulation_->particles());
        guard_.emplace(*simulation_, scene_);
        now_ = simulation_->measure();
        if (!output.video.empty())
            film_.emplace(output.video, scene_.window.width, scene_.window.height, filmRate());
        if (!output.series.empty())
            particles_.emplace(scene_, *simulation_, surfacesOf(scene_), now_,
                               1 / double(output.fps));
        if (!output.surface.empty()) surfaces_.emplace(scene_, now_, 1 / double(output.fps));
        series_.emplace(output, probes_.columns(), simulation_->plan(),
                        start.state ? &now_ : nullptr);
        first_ = steps_ = now_.steps, evaluationsBefore_ = now_.evaluations;
        endStep_ = scene_.compute.steps == 0 && output.time == 0 ? first_ + DefaultSteps
                                                                 : scene_.compute.steps;
        addRecorders();
        if (!quiet && !start.said.empty()) fmt::print(stderr, "spindrift: {}\n", start.said);
        if (const std::string hidden = probes_.hiddenBySolids(scene_, *simulation_);
            !hidden.empty())
            fmt::print(stderr, "spindrift: {}\n", hidden);
    }

    int run() {
        try {
            judge();
            record();
            while (!done() && trouble_.empty() && !isInvalid() && os::StopSignals::received() == 0)
                advance();
            progress_.clear();
            finish();
        } catch (...) {  // a GPU was lost, a disk is full: what was measured until then is kept
            progress_.clear();
            tryTo([&] { series_->finish(); });
            tryTo([&] { keepLastGood(); });
            if (particles_) tryTo([&] { particles_->finish(); });
            if (surfaces_) tryTo([&] { surfaces_->finish(); });
            if (film_) tryTo([&] { film_->finish(); });
            throw;
        }
        if (trouble_.empty() && os::StopSignals::received() != 0) {
            fmt::print(stderr, "spindrift: stopped by a signal after {} steps\n", steps_ - first_);
            return 128 + os::StopSignals::received();
        }
        if (!trouble_.empty()) {
            fmt::print(stderr, "spindrift: {}\n", trouble_);
            return int(Exit::Diverged);
        }
        if (!isInvalid()) return int(Exit::Ok);
        fmt::print(stderr, "spindrift: {}\n", refusal());
        return int(Exit::Invalid);
    }

private:
    // The first trouble is the one to tell.
    template <class F> static void tryTo(const F& f) {
        try {
            f();
        } catch (...) {}  // the first trouble is what is told
    }
    bool done() const {
        const double time = asWritten(scene_.output.time);
        return (endStep_ > 0 && steps_ >= endStep_) ||
               (time > 0 && isReached(time, now_.time, shortestStep()));
    }
    // s; times that are nearer than this to each other share a step: rows whose interval does not
    // quite divide the time of the run, an end right behind where a run goes on.
    double shortestStep() const { return 1e-2 * now_.longestStep; }

    // One step; then what is due: a look at the run's health, what is to be recorded, the progress
    // bar.
    void advance() {
        const double stop = nextStop();
        simulation_->stopAt(stop);
        const auto start = std::chrono::steady_clock::now();
        simulation_->step();
        ++steps_, ++made_;
        const bool look = steps_ % HealthInterval == 0 || steps_ == endStep_ ||
                          (stop < never && simulation_->hasReached(stop));
        if (look) simulation_->wait();
        stepSeconds_ +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (look) {
            now_ = simulation_->measure();
            lookAfterIt();
            if (trouble_.empty()) judge(), record();
            if (progress_.due()) progress_.show(share(), describe());
        }
        series_->keepUp();
    }

    // Trouble that shorter steps can't help ends the run; what was written since the state that it
    // goes back to is forgotten.
    void lookAfterIt() {
        const HealthGuard::Finding found = guard_->look(now_);
        if (found == HealthGuard::Finding::GaveUp) {
            trouble_ = guard_->said();
        } else if (!guard_->said().empty()) {
            progress_.clear();
            fmt::print(stderr, "spindrift: {}\n", guard_->said());
        }
        if (found != HealthGuard::Finding::WentBack) return;
        steps_ = now_.steps;
        validity_.dropAfter(now_.time);
        for (Recorder& recorder : recorders_) recorder.goBack(now_.time, shortestStep());
    }

    void judge() {
        validity_.look(now_);
        if (hasRows())
            for (const Remark& r : validity_.remarks()) series_->remark(r.time, r.text);
    }
    bool isInvalid() const { return scene_.output.strict && !validity_.remarks().empty(); }
    std::string refusal() const {
        const size_t more = validity_.remarks().size() - 1;
        return fmt::format("outside its validity (output.strict): {}{}",
                           validity_.remarks()[0].text,
                           more > 0 ? fmt::format("; and {} more", more) : "");
    }

    double share() const {
        const double byTime = scene_.output.time > 0 ? now_.time / scene_.output.time : 0;
        return std::max(byTime, endStep_ > 0 ? double(steps_) / double(endStep_) : 0);
    }

    std::string describe() const {
        return fmt::format("step {}, {:.4g} s, {:.3g} ms/step", steps_, now_.time,
                           1000 * stepSeconds_ / double(made_));
    }

    void record() {
        for (Recorder& recorder : recorders_) recorder.writeIfDue(now_.time, shortestStep());
    }
    bool hasFluidMeshes() const {
        const std::vector<Body>& bodies = scene_.fluid.bodies;
        return std::any_of(bodies.begin(), bodies.end(),
                           [](const Body& b) { return b.shape == Shape::Mesh; });
    }
    bool hasRows() const {
        const Output& output = scene_.output;
        return !output.csv.empty() || !output.json.empty() || !output.hdf5.empty();
    }
    // A row, a frame and a checkpoint of the same moment are written in this order. A run that goes
    // on writes first what comes after the last that is there.
    void addRecorders() {
        const Output& output = scene_.output;
        const double frame = 1 / double(output.fps),
                     row = output.sampleEvery > 0 ? asWritten(output.sampleEvery) : frame;
        const auto after = [this](double last, double every) {
            return last < 0 ? 0 : Recorder::timeAfter(last, every, shortestStep());
        };
        if (hasRows())
            recorders_.push_back({row, after(series_->lastTime(), row), [this] { addRow(); },
                                  [this](double time) { series_->dropAfter(time); }});
        if (scene_.view.pathOf >= 0 && pictures_)
            recorders_.push_back({frame, after(-1, frame),
                                  [this] { pictures_->frame.followPath(*simulation_, scene_); },
                                  [](double) {}});
        if (!output.frames.empty()) {
            if (first_ > 0) countFramesBefore(frame);
            recorders_.push_back(
                {frame, after(frameTimes_.empty() ? -1 : frameTimes_.back(), frame),
                 [this] { saveFrame(); },
                 [this](double time) {
                     std::erase_if(frameTimes_, [&](double drawn) { return drawn > time; });
                 }});
        }
        if (film_)
            recorders_.push_back({frame, after(first_ > 0 ? now_.time : -1, frame),
                                  [this] { addToFilm(); }, [](double) {}});
        if (particles_)
            recorders_.push_back({frame, after(particles_->endBefore(), frame),
                                  [this] { particles_->add(*simulation_, now_.time); },
                                  [this](double time) { particles_->dropAfter(time); }});
        if (surfaces_)
            recorders_.push_back({frame, after(surfaces_->endBefore(), frame),
                                  [this] { surfaces_->add(*simulation_, now_.time); },
                                  [this](double time) { surfaces_->dropAfter(time); }});
        const double checkpoint = asWritten(output.checkpointEvery);
        if (!output.checkpoint.empty() && checkpoint > 0)
            recorders_.push_back({checkpoint, after(now_.time, checkpoint),
                                  [this] { saveCheckpoint(); }, [](double) {}});
    }

    std::string frameFile(size_t number) const {
        return (std::filesystem::path(scene_.output.frames) /
                fmt::format("frame_{:05}.png", number))
            .string();
    }
    void saveFrame() {
        pictures_->save(*simulation_, scene_, frameFile(frameTimes_.size()));
        frameTimes_.push_back(now_.time);
        ++framesMade_;
    }
    // s^-1, as it is shown; with more frames a second of simulated time it shows slow motion.
    double filmRate() const { return std::min(60.0, double(scene_.output.fps)); }
    // What is in a film can't be taken out: it shows trouble as it was, once, and goes on from
    // there.
    void addToFilm() {
        if (now_.time <= filmed_) return;
        film_->add(pictures_->of(*simulation_, scene_));
        filmed_ = now_.time, ++filmFrames_;
    }
    // Those of the run that goes on, as far as they are there.
    void countFramesBefore(double every) {
        while (isReached(double(frameTimes_.size()) * every, now_.time) &&
               std::filesystem::exists(frameFile(frameTimes_.size())))
            frameTimes_.push_back(double(frameTimes_.size()) * every);
    }

    static constexpr double never = 1e300;
    // The next time at which the run is looked at or ends.
    double nextStop() const {
        double stop = scene_.output.time > 0 ? asWritten(scene_.output.time) : never;
        for (const Recorder& recorder : recorders_) stop = std::min(stop, recorder.next);
        return stop;
    }

    void writeCheckpointOf(const RunState& state) {
        Scene scene = scene_;
        scene.view = view_, scene.window = window_;
        writeCheckpoint(scene.output.checkpoint, scene, state);
        written_ = state.clock.time;
    }
    void keepLastGood() {
        if (!scene_.output.checkpoint.empty() && guard_->lastGood().clock.time > written_)
            writeCheckpointOf(guard_->lastGood());
    }
    // The run goes on from what the file holds, so that whoever restarts from it gets the same
    // bits.
    void saveCheckpoint() {
        RunState state = simulation_->state();
        writeCheckpointOf(state);
        simulation_->restart(state);
        guard_->keep(std::move(state));
    }

    void addRow() {
        std::vector<double> readings;
        if (probes_.any())
            readings = probes_.read(simulation_->particles(), probes_.looksPastSolids()
                                                                  ? simulation_->solidPoses()
                                                                  : std::vector<SolidPose>());
        series_->add(now_, simulation_->times(), readings);
        simulation_->resetTimes();
    }

    void finish() {
        const Output& output = scene_.output;
        now_ = simulation_->measure();
        if (trouble_.empty()) trouble_ = divergence(scene_, now_);
        judge();
        if (hasRows() && series_->lastTime() < now_.time) addRow();
        series_->finish();
        if (!output.checkpoint.empty() && trouble_.empty())
            writeCheckpointOf(simulation_->state());
        else
            keepLastGood();
        if (!output.particles.empty() && trouble_.empty())
            saveParticles(output.particles, simulation_->particles(),
                          massesToSave(scene_, *simulation_), fluidsToSave(scene_, *simulation_));
        if (!output.screenshot.empty()) pictures_->save(*simulation_, scene_, output.screenshot);
        if (particles_) particles_->finish();
        if (surfaces_) surfaces_->finish();
        if (film_) film_->finish();
        if (!quiet_)
            summarise();
        else if (!isInvalid())
            for (const Remark& r : validity_.remarks())
                fmt::print(stderr, "spindrift: {}\n", r.text);
    }

    void summarise() const {
        const Output& output = scene_.output;
        // Standard output may already belong to an output.
        std::FILE* out = takesStandardOutput(output) ? stderr : stdout;
        const double ms = made_ > 0 ? 1000 * stepSeconds_ / double(made_) : 0;
        fmt::print(out, "scene          {}\n", scene_.name);
        fmt::print(out, "device         {}\n", simulation_->deviceName());
        if (pictures_ && pictures_->frame.copiesVertices())
            fmt::print(out, "vertices       copied through the host, because {} draws\n", glName());
        fmt::print(out, "particles      {}\n", particlesOf(*simulation_));
        for (const Poured& p : poured_)
            fmt::print(out,
                       "poured         {:.4g} kg into fluid.bodies[{}], {:.4g} kg by its volume\n",
                       p.mass, p.body, p.wanted);
        for (const std::string& body : pouredAmiss(scene_, *simulation_))
            fmt::print(out, "poured         {}\n", body);
        if (now_.comesAndGoes)
            fmt::print(out, "came, left     {:.6g}, {:.6g} {}\n", now_.massIn, now_.massOut,
                       perDepth("kg", now_.dimensions));
        fmt::print(out, "steps          {}, {:.3g} ms each\n", steps_ - first_, ms);
        if (scene_.time.mode == TimeMode::Local && made_ > 0)
            fmt::print(out, "local steps    {:.3g} evaluations of a particle a step\n",
                       (now_.evaluations - evaluationsBefore_) / double(simulation_->fluidCount()) /
                           double(made_));
        fmt::print(out, "simulated      {:.4g} s, last step {:.3g} s\n", now_.time, now_.dt);
        const std::string joule = perDepth("J", now_.dimensions);
        fmt::print(out, "energy         {:.4g} {} kinetic, {:.4g} {} potential\n",
                   now_.kineticEnergy, joule, now_.potentialEnergy, joule);
        fmt::print(out, "density error  {:.3g} % mean, {:.3g} % largest\n", 100 * now_.densityError,
                   100 * now_.maxDensityError);
        for (const Remark& r : validity_.remarks()) fmt::print(out, "not valid      {}\n", r.text);
        if (guard_->retries() > 0)
            fmt::print(out, "went back      {} times, on with shorter steps\n", guard_->retries());
        if (!output.checkpoint.empty())
            fmt::print(out, "checkpoint     {}{}\n", output.checkpoint,
                       trouble_.empty() ? "" : ", from before the trouble");
        if (!output.particles.empty() && trouble_.empty())
            fmt::print(out, "particles in   {}\n", output.particles);
        if (!output.screenshot.empty())
            fmt::print(out, "picture        {}\n",
                       std::filesystem::absolute(output.screenshot).lexically_normal().string());
        if (framesMade_ > 0)
            fmt::print(out, "frames         {} in {}\n", framesMade_, output.frames);
        if (film_)
            fmt::print(out, "film           {}, {} frames, {:.3g} s\n", output.video, filmFrames_,
                       double(filmFrames_) / filmRate());
        if (particles_)
            fmt::print(out, "series         {}, {} moments\n", output.series,
                       particles_->moments());
        if (surfaces_)
            fmt::print(out, "surfaces       {}, {} moments\n", output.surface,
                       surfaces_->moments());
    }

    Scene scene_;
    View view_;  // of the scene's file: what a checkpoint holds
    Window window_;
    bool quiet_;
    Progress progress_;
    std::optional<Pictures>
        pictures_;  // before the simulation: no display is noticed before work begins
    std::unique_ptr<Simulation> simulation_;
    Probes probes_;
    Validity validity_;
    std::optional<HealthGuard> guard_;
    std::optional<SeriesFiles> series_;
    std::vector<Recorder> recorders_;
    std::vector<Poured> poured_;  // at the start
    Measurement now_;
    std::string trouble_;  // why the run stopped early
    int64_t first_ = 0, steps_ = 0,
            endStep_ = 0;  // of the whole run: before this part of it, until now, at its end or 0
    int64_t made_ = 0;     // here, with those that were made in vain
    os::StopSignals signals_;  // until a film's reader is gone
    std::optional<Film> film_;
    std::optional<ParticleSeries> particles_;
    std::optional<SurfaceSeries> surfaces_;
    double filmed_ = -1;  // s, of the film's last frame
    size_t filmFrames_ = 0;
    std::vector<double> frameTimes_;  // s, of the frames written
    size_t framesMade_ = 0;           // here, with those that were drawn twice
    double written_ = -1;             // s simulated, of the checkpoint
    double evaluationsBefore_ = 0;    // this run
    double stepSeconds_ = 0;          // of wall time
};

}  // namespace

int runHeadless(const Start& start, bool quiet) { return HeadlessRun(start, quiet).run(); }

}  // namespace spindrift
