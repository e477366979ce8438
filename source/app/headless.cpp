#include "app/headless.h"

#include "app/explain.h"
#include "app/frame.h"
#include "app/progress.h"
#include "core/error.h"
#include "measure/checkpoint.h"
#include "measure/health.h"
#include "measure/output_file.h"
#include "measure/probes.h"
#include "measure/time_series.h"
#include "render/egl_context.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <optional>
#include <set>

namespace spindrift {
namespace {

constexpr int DefaultSteps = 600;
// Steps between two looks at the health of a run that measures nothing else.
constexpr int HealthInterval = 20;

// The signal that asked for an end, 0 = none.
volatile std::sig_atomic_t stopSignal = 0;

// While it lives SIGINT and SIGTERM are noted; a second one kills as usual.
struct StopSignals {
    StopSignals() {
        stopSignal = 0;
        struct sigaction action{};
        action.sa_handler = [](int signal) { stopSignal = signal; };
        action.sa_flags = int(SA_RESETHAND);
        sigaction(SIGINT, &action, &before_[0]);
        sigaction(SIGTERM, &action, &before_[1]);
    }
    ~StopSignals() {
        sigaction(SIGINT, &before_[0], nullptr);
        sigaction(SIGTERM, &before_[1], nullptr);
    }

private:
    struct sigaction before_[2];
};

// Every output is tried before the first step: an hour of computing must not end at a missing
// folder.
void requireOutputs(const Output& output) {
    if (output.csv == "-" && output.json == "-")
        throw Error(
            Exit::Output,
            "output.csv and output.json both want standard output; give one of them a file");
    std::set<std::string> files;
    for (const std::string& file : {output.screenshot, output.csv, output.json, output.hdf5, output.particles, output.checkpoint}) {
        if (file.empty() || file == "-") continue;
        requireWritable(file);
        if (!files.insert(file).second)
            throw Error(Exit::Output,
                        file + ": two outputs want this file; give each a file of its own");
    }
    if (!output.frames.empty()) requireFolder(output.frames);
}

// What draws; there only when pictures are asked for.
struct Pictures {
    EglContext context;
    Frame frame;
    explicit Pictures(const Scene& scene)
        : context(scene.compute.device), frame(scene.window.width, scene.window.height, scene.window.samples) {}
    void save(Simulation& simulation, const Scene& scene, const std::string& file) {
        frame.update(simulation, scene);
        frame.draw(scene);
        writePng(file, frame.image());
    }
};

// A knob's decimal number, which its float is but near to: a run of 0.1 s and a frame at 0.1 s end together.
double asWritten(float value) { return std::stod(fmt::format("{}", value)); }

class HeadlessRun {
public:
    HeadlessRun(const Start& start, bool quiet)
        : scene_(start.scene), quiet_(quiet), progress_(!quiet), probes_(start.scene), series_(probes_.columns()) {
        if (scene_.compute.steps == 0 && scene_.output.time == 0)
            scene_.compute.steps = DefaultSteps;
        requireOutputs(scene_.output);
        const Output& output = scene_.output;
        if (!output.screenshot.empty() || !output.frames.empty()) {
            pictures_.emplace(scene_);
            scene_ = onDrawingDevice(std::move(scene_));
        }
        rows_ = !output.csv.empty() || !output.json.empty() || !output.hdf5.empty();
        sampling_ = rows_ || !output.frames.empty();
        simulation_ = startSimulation(scene_, start.state);
        guard_.emplace(*simulation_, scene_);
    }

    int run() {
        try {
            now_ = simulation_->measure();
            first_ = now_.steps, evaluationsBefore_ = now_.evaluations;
            if (checkpointsByTime()) nextCheckpoint_ = after(now_.time, asWritten(scene_.output.checkpointEvery));
            sample();
            while (!done() && trouble_.empty() && stopSignal == 0) advance();
        } catch (...) {   // a GPU was lost, a disk is full: what was measured until then is kept
            progress_.clear();
            writeSeries();
            throw;
        }
        progress_.clear();
        finish();
        if (trouble_.empty() && stopSignal != 0) {
            fmt::print(stderr, "spindrift: stopped by a signal after {} steps\n", steps_);
            return 128 + stopSignal;
        }
        if (trouble_.empty()) return int(Exit::Ok);
        fmt::print(stderr, "spindrift: {}\n", trouble_);
        return int(Exit::Diverged);
    }

private:
    bool done() const {
        const int steps = scene_.compute.steps;
        const double time = asWritten(scene_.output.time);
        return (steps > 0 && steps_ >= steps) || (time > 0 && reached(time));
    }

    // One step; then what is due: a look at the run's health, a sample, the progress bar.
    void advance() {
        const double stop = nextStop();
        simulation_->stopAt(stop);
        const auto start = std::chrono::steady_clock::now();
        simulation_->step();
        ++steps_, ++made_;
        const bool look = steps_ % HealthInterval == 0 || steps_ == scene_.compute.steps ||
                          (stop < never && isReached(stop, simulation_->clock().time));
        if (look) simulation_->wait();
        stepSeconds_ +=
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (!look) return;
        now_ = simulation_->measure();
        lookAfterIt();
        if (sampling_ && trouble_.empty()) sample();
        if (checkpointsByTime() && trouble_.empty() && reached(nextCheckpoint_)) saveCheckpoint();
        if (progress_.due()) progress_.show(share(), describe());
    }

    // Trouble that shorter steps can't help ends the run; what was written since the state that it goes back to is forgotten.
    void lookAfterIt() {
        const HealthGuard::Finding found = guard_->look(now_);
        if (found == HealthGuard::Finding::GaveUp) {
            trouble_ = guard_->said();
        } else if (!guard_->said().empty()) {
            progress_.clear();
            fmt::print(stderr, "spindrift: {}\n", guard_->said());
        }
        if (found != HealthGuard::Finding::WentBack) return;
        steps_ = now_.steps - first_;
        series_.dropAfter(now_.time);
        while (!frameTimes_.empty() && frameTimes_.back() > now_.time) frameTimes_.pop_back();
        lastRow_ = std::min(lastRow_, steps_);
        nextRow_ = std::min(nextRow_, after(now_.time, rowInterval()));
        nextFrame_ = std::min(nextFrame_, after(now_.time, frameInterval()));
        if (checkpointsByTime()) nextCheckpoint_ = after(now_.time, asWritten(scene_.output.checkpointEvery));
    }

    double share() const {
        const int steps = scene_.compute.steps;
        const double byTime = scene_.output.time > 0 ? now_.time / scene_.output.time : 0;
        return std::max(byTime, steps > 0 ? double(steps_) / steps : 0);
    }

    std::string describe() const {
        return fmt::format("step {}, {:.4g} s, {:.3g} ms/step", steps_, now_.time,
                           1000 * stepSeconds_ / double(made_));
    }

    // A row of the series and a frame of the sequence, if they are due.
    void sample() {
        const Output& output = scene_.output;
        if (rows_ && reached(nextRow_)) {
            addRow();
            nextRow_ = after(now_.time, rowInterval());
        }
        if (!output.frames.empty() && reached(nextFrame_)) {
            const auto file = std::filesystem::path(output.frames) / fmt::format("frame_{:05}.png", frameTimes_.size());
            pictures_->save(*simulation_, scene_, file.string());
            frameTimes_.push_back(now_.time);
            nextFrame_ = after(now_.time, frameInterval());
        }
    }

    static constexpr double never = 1e300;
    // The next time at which the run is looked at or ends.
    double nextStop() const {
        const Output& output = scene_.output;
        double stop = output.time > 0 ? asWritten(output.time) : never;
        if (rows_) stop = std::min(stop, nextRow_);
        if (!output.frames.empty()) stop = std::min(stop, nextFrame_);
        return checkpointsByTime() ? std::min(stop, nextCheckpoint_) : stop;
    }
    // Two times that should be the same, but are sums of different steps, are.
    static bool isReached(double time, double now) { return now >= time * (1 - 1e-9); }
    bool reached(double time) const { return isReached(time, now_.time); }
    double frameInterval() const { return 1 / double(scene_.output.fps); }
    double rowInterval() const { return scene_.output.sampleEvery > 0 ? asWritten(scene_.output.sampleEvery) : frameInterval(); }
    // Of the multiples of `every` the first one that is still ahead.
    static double after(double time, double every) { return (std::floor(time / every * (1 + 1e-9)) + 1) * every; }

    bool checkpointsByTime() const { return !scene_.output.checkpoint.empty() && scene_.output.checkpointEvery > 0; }
    // The run goes on from what the file holds, so that whoever restarts from it gets the same bits.
    void saveCheckpoint() {
        RunState state = simulation_->state();
        writeCheckpoint(scene_.output.checkpoint, scene_, state);
        written_ = state.clock.time;
        simulation_->restart(state);
        guard_->keep(std::move(state));
        nextCheckpoint_ = after(now_.time, asWritten(scene_.output.checkpointEvery));
    }

    void addRow() {
        series_.add(now_, simulation_->times(), probes_.any() ? probes_.read(simulation_->particles()) : std::vector<double>());
        simulation_->resetTimes();
        lastRow_ = steps_;
    }

    void writeSeries() const {
        const Output& output = scene_.output;
        if (!output.csv.empty()) writeText(output.csv, series_.csv());
        if (!output.json.empty()) writeText(output.json, series_.json());
        if (!output.hdf5.empty()) series_.writeHdf5(output.hdf5);
    }

    void finish() {
        const Output& output = scene_.output;
        now_ = simulation_->measure();
        if (trouble_.empty()) trouble_ = divergence(scene_, now_);
        if (rows_ && lastRow_ < steps_) addRow();
        writeSeries();
        if (!output.checkpoint.empty() && trouble_.empty())
            writeCheckpoint(output.checkpoint, scene_, simulation_->state());
        else if (!output.checkpoint.empty() && guard_->lastGood().clock.time > written_)
            writeCheckpoint(output.checkpoint, scene_, guard_->lastGood());
        if (!output.particles.empty() && trouble_.empty()) saveParticles(output.particles, simulation_->particles());
        if (!output.screenshot.empty()) pictures_->save(*simulation_, scene_, output.screenshot);
        if (!quiet_) summarise();
    }

    void summarise() const {
        const Output& output = scene_.output;
        // Standard output may already belong to the series.
        std::FILE* out = output.csv == "-" || output.json == "-" ? stderr : stdout;
        const double ms = made_ > 0 ? 1000 * stepSeconds_ / double(made_) : 0;
        fmt::print(out, "scene          {}\n", scene_.name);
        fmt::print(out, "device         {}\n", simulation_->deviceName());
        if (pictures_ && pictures_->frame.copiesVertices())
            fmt::print(out, "vertices       copied through the host, because {} draws\n", glName());
        fmt::print(out, "particles      {}\n", particlesOf(*simulation_));
        fmt::print(out, "steps          {}, {:.3g} ms each\n", steps_, ms);
        if (scene_.time.mode == TimeMode::Local && made_ > 0)
            fmt::print(out, "local steps    {:.3g} evaluations of a particle a step\n",
                       (now_.evaluations - evaluationsBefore_) / double(simulation_->fluidCount()) / double(made_));
        fmt::print(out, "simulated      {:.4g} s, last step {:.3g} s\n", now_.time, now_.dt);
        fmt::print(out, "energy         {:.4g} J kinetic, {:.4g} J potential\n", now_.kineticEnergy,
                   now_.potentialEnergy);
        fmt::print(out, "density error  {:.3g} % mean, {:.3g} % largest\n", 100 * now_.densityError,
                   100 * now_.maxDensityError);
        if (guard_->retries() > 0) fmt::print(out, "went back      {} times, on with shorter steps\n", guard_->retries());
        if (!output.checkpoint.empty())
            fmt::print(out, "checkpoint     {}{}\n", output.checkpoint, trouble_.empty() ? "" : ", from before the trouble");
        if (!output.particles.empty() && trouble_.empty()) fmt::print(out, "particles in   {}\n", output.particles);
        if (!output.screenshot.empty())
            fmt::print(out, "picture        {}\n",
                       std::filesystem::absolute(output.screenshot).lexically_normal().string());
        if (!frameTimes_.empty()) fmt::print(out, "frames         {} in {}\n", frameTimes_.size(), output.frames);
    }

    Scene scene_;
    bool quiet_, rows_ = false, sampling_ = false;   // of the series; anything by time
    Progress progress_;
    std::optional<Pictures>
        pictures_;  // before the simulation: no display is noticed before work begins
    std::unique_ptr<Simulation> simulation_;
    Probes probes_;
    std::optional<HealthGuard> guard_;
    TimeSeries series_;
    Measurement now_;
    std::string trouble_;  // why the run stopped early
    int64_t first_ = 0, steps_ = 0, lastRow_ = 0;   // steps before this run, in it, until the last row
    int64_t made_ = 0;                              // with those that were made in vain
    std::vector<double> frameTimes_;                // s, of the frames written
    double nextRow_ = 0, nextFrame_ = 0, nextCheckpoint_ = 0, written_ = -1;  // s simulated; the last: of the checkpoint
    double evaluationsBefore_ = 0;                  // this run
    double stepSeconds_ = 0;                      // of wall time
    StopSignals signals_;
};

}  // namespace

int runHeadless(const Start& start, bool quiet) { return HeadlessRun(start, quiet).run(); }

}  // namespace spindrift
