// The simulation for Python: import spindrift. Built by make python; python/test_spindrift.py
// shows all of it, examples/*.py use it.
#include "app/frame.h"
#include "app/scene_choice.h"
#include "core/error.h"
#include "measure/checkpoint.h"
#include "measure/health.h"
#include "measure/probes.h"
#include "measure/validity.h"
#include "render/egl_context.h"
#include "scene/check.h"
#include "scene/json.h"
#include "sim/simulation.h"

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace spindrift {
namespace {

// Text stays as it is; numbers, lists, dictionaries and truth values become JSON.
std::string knobText(const py::handle& value) {
    if (py::isinstance<py::str>(value)) return value.cast<std::string>();
    return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

std::vector<KnobChoice> choicesOf(const py::dict& knobs) {
    std::vector<KnobChoice> choices;
    for (const auto& [path, value] : knobs)
        choices.push_back({"knobs", path.cast<std::string>(), knobText(value)});
    return choices;
}

Start startOf(const py::object& scene, const py::dict& knobs) {
    const std::vector<KnobChoice> choices = choicesOf(knobs);
    if (!py::isinstance<py::dict>(scene))
        return chooseStart(py::str(scene).cast<std::string>(), choices);
    Start start;
    start.scene = parseScene(knobText(scene), "scene");
    applyChoices(start.scene, choices);
    checkScene(start.scene, "scene");
    return start;
}

// Three numbers as a new array.
py::array_t<double> arrayOf(const Vec3d& v) {
    py::array_t<double> array(3);
    for (int k = 0; k < 3; ++k) array.mutable_at(k) = v[k];
    return array;
}

Vec3 vectorOf(const std::vector<float>& v, const char* what) {
    if (v.size() != 3) throw Error(Failure::Usage, std::string(what) + ": give three numbers, m");
    return {v[0], v[1], v[2]};
}

// OpenGL while one of these lives. One context for all runs, to the end of the process.
class Drawing {
public:
    explicit Drawing(int device) {
        static EglContext* const only = new EglContext(device);
        (context_ = only)->makeCurrent();
    }
    ~Drawing() { context_->release(); }
    Drawing(const Drawing&) = delete;

private:
    EglContext* context_;
};

// All particles of the fluid at one moment. Arrays are views into it, and keep it alive.
struct Cloud {
    std::vector<Particle> particles;
};
template <class T> py::array viewOf(const py::object& self, T Particle::*member, int width) {
    const std::vector<Particle>& p = self.cast<const Cloud&>().particles;
    const T* first = p.empty() ? nullptr : &(p.data()->*member);
    const auto n = py::ssize_t(p.size()), step = py::ssize_t(sizeof(Particle));
    using Number = std::conditional_t<std::is_same_v<T, Vec3d>, double, T>;
    py::array view = width == 1 ? py::array(py::dtype::of<Number>(), {n}, {step}, first, self)
                                : py::array(py::dtype::of<Number>(), {n, py::ssize_t(width)},
                                            {step, py::ssize_t(sizeof(Number))}, first, self);
    view.attr("flags").attr("writeable") = false;
    return view;
}

class Run {
public:
    Run(const py::object& scene, const py::dict& knobs) : start_(startOf(scene, knobs)) {
        Scene& s = start_.scene;
        s.output.headless = true;
        {
            py::gil_scoped_release others;
            simulation_ = startSimulation(s, start_.state);
        }
        probes_.emplace(s), validity_.emplace(s), guard_.emplace(*simulation_, s);
        tellRemarks();
    }

    ~Run() {
        if (!frame_) return;
        try {
            const Drawing drawing(scene().compute.device);
            frame_.reset();
        } catch (const Error&) {}  // its names are lost with the process
    }

    const Scene& scene() const { return start_.scene; }
    double time() { return simulation().clock().time; }
    int64_t steps() { return simulation().clock().steps; }

    // Trouble that shorter steps can't help is an Error, as it ends a run of the program.
    void step(int count) {
        for (int done = 0; done < count;) {
            const int some = std::min(count - done, Looks);
            advance(some);
            done += some;
            look();
        }
    }
    // Calls each(run), where there is one, after every `every` seconds; False ends the run there.
    void runUntil(double time, const py::object& self, const py::object& each, double every) {
        if (!std::isfinite(time)) throw Error(Failure::Usage, "run: until must be a time, s");
        if (!each.is_none() && !(every > 0))
            throw Error(Failure::Usage, "run: every must be above 0 s when each is given");
        const double begin = this->time();
        for (int64_t calls = 1; !reached(time);) {
            const double next =
                each.is_none() ? time : std::min(time, begin + double(calls) * every);
            simulation().stopAt(next);
            for (int k = 0; k < Looks && !reached(next); ++k) advance(1);
            look();
            if (each.is_none() || !reached(next)) continue;
            ++calls;
            const py::object said = each(self);
            if (py::isinstance<py::bool_>(said) && !said.cast<bool>()) return;
        }
    }

    Cloud particles() { return {simulation().particles()}; }

    py::dict measure() {
        const Measurement m = simulation().measure();
        validity_->look(m);
        tellRemarks();
        py::dict d;
        d["time"] = m.time, d["step"] = m.steps, d["dt"] = m.dt;
        d["kinetic_energy"] = m.kineticEnergy, d["potential_energy"] = m.potentialEnergy;
        d["momentum"] = arrayOf(m.momentum), d["angular_momentum"] = arrayOf(m.angularMomentum);
        d["center_of_mass"] = arrayOf(m.centerOfMass), d["mean_density"] = m.meanDensity;
        d["density_error"] = m.densityError, d["max_density_error"] = m.maxDensityError;
        d["max_speed"] = m.maxSpeed;
        if (m.solvesPressure) d["iterations"] = m.solve.iterations;
        return d;
    }

    py::dict solids() {
        py::dict all;
        for (const SolidMeasurement& s : simulation().measure().solids) {
            py::dict d;
            d["position"] = arrayOf(s.position), d["velocity"] = arrayOf(s.velocity);
            d["spin"] = arrayOf(s.spin), d["torque"] = arrayOf(s.torque);
            d["pressure_force"] = arrayOf(s.pressureForce);
            d["viscous_force"] = arrayOf(s.viscousForce);
            d["force"] = arrayOf(s.pressureForce + s.viscousForce);
            all[s.name.c_str()] = d;
        }
        return all;
    }

    py::dict readProbes() {
        const std::vector<double> values =
            probes_->read(simulation().particles(), simulation().solidPoses());
        py::dict d;
        for (size_t k = 0; k < values.size(); ++k)
            d[probes_->columns()[k].name.c_str()] = values[k];
        return d;
    }

    // A knob that can change while the run goes on.
    void set(const std::string& path, const py::object& value) {
        Scene scene = start_.scene;
        setKnob(scene, path + "=" + knobText(value), "set");
        if (restartKnobs(scene) != restartKnobs(start_.scene))
            throw Error(Failure::Usage,
                        path + ": can't change while the run goes on; begin another Run with it");
        checkScene(scene, "set",
                   ParticleCount{simulation().fluidCount(), simulation().wallCount()});
        guard_->apply(scene);
        start_.scene = scene;
    }
    py::object get(const std::string& path) const {
        const py::object json = py::module_::import("json").attr("loads")(writeScene(scene()));
        py::object at = json;
        std::string name;
        for (const char c : path + ".") {
            if (c != '.') {
                name += c;
                continue;
            }
            if (!py::isinstance<py::dict>(at) || !at.contains(name))
                throw py::key_error(path + ": there is no such knob");
            at = at[py::str(name)];
            name.clear();
        }
        return at;
    }

    void hold(const std::string& solid, const std::vector<float>& target) {
        const std::vector<SolidMeasurement> all = simulation().measure().solids;
        const auto found =
            std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.name == solid; });
        if (found == all.end())
            throw Error(Failure::Usage, "hold: there is no solid \"" + solid + "\"");
        simulation().hold({int(found - all.begin()), vectorOf(target, "hold")});
    }
    void release() { simulation().hold({}); }

    void stir(const std::vector<float>& center, float radius, const std::vector<float>& velocity) {
        Stir stir;
        stir.center = vectorOf(center, "stir"), stir.radius = radius;
        stir.velocity = vectorOf(velocity, "stir");
        simulation().stir(stir);
    }

    void save(const std::string& path) { writeCheckpoint(path, scene(), simulation().state()); }

    py::array_t<uint8_t> picture(int width, int height) {
        const Drawing drawing(scene().compute.device);
        if (!frame_ || frame_->width() != width || frame_->height() != height)
            frame_.emplace(width, height, scene().window.samples);
        frame_->update(simulation(), scene());
        frame_->draw(scene());
        const Image image = frame_->image();
        py::array_t<uint8_t> pixels({image.height, image.width, 3});
        std::copy(image.rgb.begin(), image.rgb.end(), pixels.mutable_data());
        return pixels;
    }

    std::vector<std::string> remarks() const {
        std::vector<std::string> all;
        for (const Remark& r : validity_->remarks()) all.push_back(r.text);
        return all;
    }
    std::string device() { return simulation().deviceName(); }

private:
    static constexpr int Looks = 20;  // steps between two looks at the run's health

    // While another thread steps nothing else may be asked of it.
    Simulation& simulation() {
        if (stepping_)
            throw Error(Failure::Usage, "this Run is stepping on another thread; wait for it");
        return *simulation_;
    }
    void advance(int steps) {
        Simulation& run = simulation();
        struct Stepping {
            bool& now;
            explicit Stepping(bool& s) : now(s) { now = true; }
            ~Stepping() { now = false; }
        };
        {
            const Stepping stepping(stepping_);  // changes with the interpreter's lock held
            py::gil_scoped_release others;
            run.step(steps);
            run.wait();
        }
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    bool reached(double time) {
        const StepState clock = simulation().clock();
        return clock.time >= time * (1 - 1e-9) - 1e-3 * clock.dt;
    }
    void look() {
        Measurement m = simulation().measure();
        const HealthGuard::Finding found = guard_->look(m);
        if (found == HealthGuard::Finding::GaveUp) throw Error(Failure::Usage, guard_->said());
        if (found == HealthGuard::Finding::WentBack) {
            validity_->dropAfter(m.time);
            told_ = std::min(told_, validity_->remarks().size());
        }
        if (!guard_->said().empty()) warn(guard_->said());
        validity_->look(m);
        tellRemarks();
    }
    void tellRemarks() {
        while (told_ < validity_->remarks().size()) warn(validity_->remarks()[told_++].text);
    }
    static void warn(const std::string& text) {
        if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
    }

    Start start_;
    std::unique_ptr<Simulation> simulation_;
    std::optional<Probes> probes_;
    std::optional<Validity> validity_;
    std::optional<HealthGuard> guard_;
    std::optional<Frame> frame_;
    size_t told_ = 0;        // remarks
    bool stepping_ = false;  // now
};

}  // namespace
}  // namespace spindrift

PYBIND11_MODULE(spindrift, module) {
    using namespace spindrift;
    module.doc() = "Particle fluids (SPH). SI units throughout; arrays are NumPy's.";
    py::register_exception<Error>(module, "Error").attr("__doc__") =
        "One line: what is wrong, where, and what to do.";
    module.def("scenes", &shippedScenes, "Names of the shipped scenes.");
    module.def(
        "schema", [] { return py::module_::import("json").attr("loads")(jsonSchema()); },
        "JSON Schema of a scene, a dictionary: every knob with range, unit and help.");

    py::class_<Cloud>(module, "Particles",
                      "All particles of the fluid at one moment, in the order of their ids. Arrays "
                      "are read-only views, n or n x 3.")
        .def("__len__", [](const Cloud& c) { return c.particles.size(); })
        .def_property_readonly(
            "position", [](py::object p) { return viewOf(p, &Particle::position, 3); }, "m")
        .def_property_readonly(
            "velocity", [](py::object p) { return viewOf(p, &Particle::velocity, 3); }, "m/s")
        .def_property_readonly(
            "acceleration", [](py::object p) { return viewOf(p, &Particle::acceleration, 3); },
            "m/s^2")
        .def_property_readonly(
            "density", [](py::object p) { return viewOf(p, &Particle::density, 1); }, "kg/m^3")
        .def_property_readonly(
            "pressure", [](py::object p) { return viewOf(p, &Particle::pressure, 1); }, "Pa")
        .def_property_readonly("id", [](py::object p) { return viewOf(p, &Particle::id, 1); });

    py::class_<Run>(module, "Run", "A scene that runs.")
        .def(py::init<const py::object&, const py::dict&>(), py::arg("scene") = "dam_break",
             py::arg("knobs") = py::dict(),
             "scene: a shipped scene's name, a path (of a checkpoint too), or a dictionary as in a "
             "scene file. knobs: path -> value, {\"simulation.spacing\": 0.02}. Raises Error.")
        .def("step", &Run::step, py::arg("count") = 1, "So many time steps.")
        .def(
            "run",
            [](py::object self, double until, const py::object& each, double every) {
                self.cast<Run&>().runUntil(until, self, each, every);
            },
            py::arg("until"), py::arg("each") = py::none(), py::arg("every") = 0.0,
            "To this time, s, from the beginning of the run on. each(run) is called after every "
            "`every` seconds, and ends it by returning False.")
        .def_property_readonly("time", &Run::time, "s")
        .def_property_readonly("steps", &Run::steps)
        .def_property_readonly("device", &Run::device, "What computes.")
        .def_property_readonly("remarks", &Run::remarks,
                               "What of the run is outside the validity of its method; each is "
                               "also a warning.")
        .def("particles", &Run::particles, "All particles of the fluid, now.")
        .def("measure", &Run::measure,
             "What the run comes to: energies (J), momentum, center of mass, density error.")
        .def("solids", &Run::solids,
             "By their names: position, velocity, spin, force, torque (N, N m).")
        .def("probes", &Run::readProbes, "What the scene's probes read, by column.")
        .def("__getitem__", &Run::get, "The value of a knob: run[\"fluid.viscosity\"].")
        .def("__setitem__", &Run::set, "Changes a knob while the run goes on. Raises Error.")
        .def("hold", &Run::hold, py::arg("solid"), py::arg("target"),
             "Until release() the solid is pulled to this place of its middle, m.")
        .def("release", &Run::release, "Lets go of the solid that is held.")
        .def("stir", &Run::stir, py::arg("center"), py::arg("radius"), py::arg("velocity"),
             "A sphere of fluid is taken along from now on; radius 0 ends it. m, m/s.")
        .def("save", &Run::save, py::arg("path"), "A checkpoint (.h5), which Run takes as scene.")
        .def("picture", &Run::picture, py::arg("width") = 1280, py::arg("height") = 800,
             "height x width x 3 bytes, as the scene's view has it.");
}
