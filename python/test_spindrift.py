"""What import spindrift can do. make python builds it; ctest -L python runs this."""
import threading
import time

import numpy as np
import pytest

import spindrift

SMALL = {"simulation.spacing": 0.04, "compute.backend": "cpu"}
POOL = {
    "version": 2,
    "simulation": {"spacing": 0.05},
    "domain": {"max": [1, 1, 1]},
    "solids": [{"name": "ball", "shape": "sphere", "center": [0.5, 0.25, 0.5], "radius": 0.15}],
    "fluid": {"bodies": [{"shape": "block", "min": [0, 0, 0], "max": [1, 0.5, 1]}]},
    "output": {"probes": [{"name": "deep", "position": [0.1, 0.1, 0.1], "radius": 0.1}]},
    "compute": {"backend": "cpu"},
}


def test_shipped_scenes_and_schema():
    assert "dam_break" in spindrift.scenes()
    assert "simulation" in spindrift.schema()["properties"]


def test_particles_are_views_that_outlive_their_owner():
    run = spindrift.Run("dam_break", SMALL)
    particles = run.particles()
    position = particles.position
    assert position.shape == (len(particles), 3)
    assert position.base is not None and not position.flags.writeable
    np.testing.assert_array_equal(particles.id, np.arange(len(particles)))
    before = position.copy()
    velocity = particles.velocity
    del particles
    run.step(20)
    np.testing.assert_array_equal(position, before)  # a moment, not the run
    assert np.all(velocity == 0)
    moved = run.particles()
    assert np.abs(moved.velocity).max() > 0
    energy = run.measure()
    mass = 1000 * 0.04**3
    kinetic = 0.5 * mass * (moved.velocity**2).sum()
    assert kinetic == pytest.approx(energy["kinetic_energy"], rel=0.02)


def test_runs_to_a_time_and_calls_back():
    run = spindrift.Run("dam_break", SMALL)
    times = []
    run.run(0.1, each=lambda r: times.append(r.time), every=0.02)
    assert times == pytest.approx([0.02, 0.04, 0.06, 0.08, 0.1], abs=1e-6)
    assert run.time == pytest.approx(0.1, abs=1e-6)
    run.run(1, each=lambda r: False, every=0.01)
    assert run.time < 0.12
    with pytest.raises(ZeroDivisionError):
        run.run(1, each=lambda r: 1 / 0, every=0.01)
    with pytest.raises(spindrift.Error, match="every must be above 0"):
        run.run(1, each=print)


def test_the_same_bits_as_the_program_and_after_a_checkpoint(tmp_path):
    one, two = (spindrift.Run("dam_break", SMALL) for _ in range(2))
    one.step(30)
    two.step(10)
    two.save(str(tmp_path / "run.h5"))
    three = spindrift.Run(str(tmp_path / "run.h5"))
    assert three.steps == 10
    two.step(20)
    np.testing.assert_array_equal(one.particles().position, two.particles().position)


def test_solids_probes_and_forces():
    run = spindrift.Run(POOL, {"simulation.gravity_ramp": 0.1})
    run.run(0.5)
    ball = run.solids()["ball"]
    lift = 1000 * 9.81 * 4 / 3 * np.pi * 0.15**3
    assert ball["force"][1] == pytest.approx(lift, rel=0.35)  # three particles a radius, and sound
    np.testing.assert_allclose(ball["force"], ball["pressure_force"] + ball["viscous_force"])
    assert run.probes()["deep.pressure"] == pytest.approx(1000 * 9.81 * 0.4, rel=0.15)
    run.hold("ball", [0.6, 0.25, 0.5])
    run.run(0.8)
    assert run.solids()["ball"]["position"][0] > 0.52
    run.release()
    with pytest.raises(spindrift.Error, match="no solid"):
        run.hold("bell", [0, 0, 0])
    with pytest.raises(spindrift.Error, match="three numbers"):
        run.hold("ball", [0, 0])


def test_stirring_moves_the_fluid():
    run = spindrift.Run(POOL)
    run.step(5)
    run.stir([0.2, 0.25, 0.5], 0.2, [1, 0, 0])
    run.step(60)
    assert run.measure()["momentum"][0] > 1


def test_knobs_change_while_it_runs_or_say_why_not():
    run = spindrift.Run("dam_break", SMALL)
    assert run["simulation.spacing"] == pytest.approx(0.04)
    run["fluid.viscosity"] = 0.5
    assert run["fluid.viscosity"] == pytest.approx(0.5)
    with pytest.raises(spindrift.Error, match="can't change while the run goes on"):
        run["simulation.spacing"] = 0.03
    with pytest.raises(spindrift.Error, match="fluid.viscosity"):
        run["fluid.viscosity"] = -1
    assert run["fluid.viscosity"] == pytest.approx(0.5)
    with pytest.raises(KeyError):
        run["fluid.taste"]


def test_pictures_are_arrays():
    run = spindrift.Run("dam_break", SMALL)
    first = run.picture(320, 200)
    assert first.shape == (200, 320, 3) and first.dtype == np.uint8
    assert first.std() > 5
    run.run(0.2)
    assert np.abs(run.picture(320, 200).astype(int) - first).max() > 50


@pytest.mark.parametrize("scene, knobs, words", [
    ("dam_brake", {}, "dam_break"),
    ("dam_break", {"simulation.spacin": 1}, "spacing"),
    ({"version": 2, "domain": {"max": [1, 1, -1]}}, {}, "domain"),
])
def test_mistakes_are_one_line(scene, knobs, words):
    with pytest.raises(spindrift.Error) as error:
        spindrift.Run(scene, knobs)
    assert words in str(error.value) and "\n" not in str(error.value)


def test_what_is_outside_its_validity_is_a_warning():
    full = {"version": 2, "simulation": {"formulation": "incompressible", "spacing": 0.05},
            "domain": {"max": [0.5, 0.5, 0.5]}, "compute": {"backend": "cpu"},
            "fluid": {"bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.5, 0.5, 0.5]}]}}
    with pytest.warns(UserWarning):
        run = spindrift.Run(full)
    assert len(run.remarks) >= 1


def test_two_runs_draw_each_their_own():
    one, two = spindrift.Run("dam_break", SMALL), spindrift.Run(POOL)
    first = one.picture(320, 200)
    other = two.picture(320, 200)
    assert np.abs(first.astype(int) - other).max() > 50
    np.testing.assert_array_equal(one.picture(320, 200), first)
    del one
    np.testing.assert_array_equal(two.picture(320, 200), other)


def test_a_run_belongs_to_one_thread_at_a_time():
    run = spindrift.Run("dam_break", {"simulation.spacing": 0.02, "compute.backend": "cpu"})
    refused = []

    def look():
        for _ in range(200):
            try:
                run.measure()
            except spindrift.Error as error:
                refused.append(str(error))
            time.sleep(0.001)

    looker = threading.Thread(target=look)
    looker.start()
    done = 0
    while looker.is_alive():
        try:
            run.step(1)
            done += 1
        except spindrift.Error:
            pass
    looker.join()
    assert refused and "another thread" in refused[0]
    assert run.steps == done


def test_time_must_be_one():
    run = spindrift.Run("dam_break", SMALL)
    with pytest.raises(spindrift.Error, match="must be a time"):
        run.run(float("nan"))
