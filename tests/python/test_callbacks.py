"""What Python functions do from inside a step: what would change the simulation is refused, wrong answers
are named, and poses that make no sense are counted."""

import subprocess
import sys

import glisson
import numpy as np
import pytest

NAN = float("nan")
REFUSED = "inside a step or a change"


class Own(glisson.OwnInteraction):
    """Tells where it is called."""

    def __init__(self, at):
        super().__init__()
        self.at = at

    def attached(self, mesh, time):
        self.at("attached")

    def body_changed(self, mesh, origins):
        self.at("body_changed")

    def reach(self, time, h):
        self.at("reach")
        return [26]

    def add_forces(self, step):
        self.at("add_forces")

    def declare(self, step, rows):
        self.at("declare")

    def solved(self, step, rows):
        self.at("solved")

    def moved(self, step):
        self.at("moved")

    def squared_frequency(self):
        self.at("squared_frequency")
        return 0.0

    def past(self):
        self.at("past")
        return []


PLACES = ["motion", "pose motion", "scale", "driver", "push", "attached", "body_changed", "reach", "add_forces"]
PLACES += ["declare", "solved", "moved", "squared_frequency", "past"]


def run(act):
    """A cube that is driven, turned, loaded and pressed; `act(place, body)` is called where it calls out. Hashes."""
    mesh = glisson.box_mesh(cells=[2, 2, 2], size=[0.02, 0.02, 0.02])
    body = glisson.Simulation(mesh, glisson.Tissue())

    def calling(place, value):
        def function(*given):
            act(place, body)
            return value(*given)

        return function

    body.fix("z_min")
    body.drive([18], calling("motion", lambda t: (0.01 * t, 0, 0)))
    body.drive_rigidly([20], calling("pose motion", lambda t: glisson.Pose(position=[0, 0, -0.01 * t])))
    body.add_load("z_max", [0, 0, -1e-3], calling("scale", lambda t: 1 + t))
    ball = glisson.ContactOptions(shape=glisson.Ball(radius=0.003))
    led, pushed = (glisson.Pose(position=[x, 0.01, 0.020001]) for x in (0.006, 0.014))
    lead = calling("driver", lambda t, h, on_tool: [0.006, 0.01, 0.020001 - 0.02 * (t + h)])
    body.attach(glisson.ContactTool(ball, glisson.FunctionDriver(led, lead)))
    body.attach(glisson.ContactTool(ball, glisson.PushDriver(pushed, calling("push", lambda t: 0.01))))
    body.attach(Own(lambda place: act(place, body)))
    hashes = []
    for k in range(6):
        body.step()
        hashes.append(body.state_hash)
        if k == 2:
            body.remove_tets([7])
    body.save()
    return hashes


def calls_of(body):
    """Every member that changes something."""
    still = np.zeros((27, 3))
    hand = glisson.HandDriver(glisson.Pose(position=[0, 0, 0.05]))
    return {
        "fix": lambda: body.fix([26]),
        "drive": lambda: body.drive([26], lambda t: (0, 0, 0)),
        "drive_rigidly": lambda: body.drive_rigidly([26], lambda t: glisson.Pose()),
        "add_load": lambda: body.add_load([26], [0, 0, 1]),
        "add_surface_load": lambda: body.add_surface_load("z_max", glisson.SurfaceLoad(pressure=10)),
        "attach": lambda: body.attach(glisson.ContactTool(glisson.ContactOptions(name="late"), hand)),
        "remove_tets": lambda: body.remove_tets([0, 5]),
        "split_faces": lambda: body.split_faces(np.zeros((0, 3), dtype=int)),
        "set_tissue": lambda: body.set_tissue(0, glisson.Tissue(youngs_modulus=1e5)),
        "set_tissues": lambda: body.set_tissues(glisson.Tissue(youngs_modulus=1e5)),
        "set_state": lambda: body.set_state(still + 1e-4, still),
        "step": body.step,
        "advance": lambda: body.advance(1.0),
        "save": body.save,
        "load": lambda: body.load(b""),
        "Cutter": lambda: glisson.Cutter(body),
    }


@pytest.mark.parametrize("place", PLACES)
def test_each_member_is_refused_from_each_callback(place):
    """The RuntimeError says where it was called, and the run has the bytes of one in which nothing was called."""
    faults, asked = [], []

    def call_all(here, body):
        if here != place or len(asked) > 2:
            return
        asked.append(here)
        for name, call in calls_of(body).items():
            try:
                call()
                faults.append(f"{name} was not refused")
            except RuntimeError as error:
                if REFUSED not in str(error):
                    faults.append(f"{name}: {error}")

    assert run(call_all) == run(lambda here, body: None)
    assert asked and faults == []


@pytest.mark.parametrize("place", PLACES)
def test_readings_from_each_callback_change_nothing(place):
    """Arrays, forces and energies may be read from inside a step, and leave no trace in the run."""

    def read(here, body):
        if here == place:
            body.displacement, body.velocity, body.positions, body.energies, body.stored_energy  # noqa: B018
            body.state_hash, body.stable_step, body.step_size, body.present_mesh  # noqa: B018
            body.tet_fields(), body.contact_fields()

    assert run(read) == run(lambda here, body: None)


def test_an_observer_may_change_the_simulation():
    """advance() calls it between steps."""
    body = glisson.Simulation(glisson.box_mesh(cells=[2, 2, 2]), glisson.Tissue())
    body.advance(0.01, observer=lambda: body.add_load("z_max", [0, 0, -0.01]), every=0.002)
    assert np.abs(body.displacement).max() > 0
    for until, every in ((float("inf"), 0.1), (NAN, 0.1), (0.02, 0.0), (0.02, NAN)):
        with pytest.raises(ValueError, match="advance"):
            body.advance(until, observer=lambda: None, every=every)


def test_a_step_that_throws_leaves_a_simulation_that_steps():
    """A refused call that nobody catches ends the stepping; later steps and other simulations are as ever."""
    body = glisson.Simulation(glisson.box_mesh(cells=[2, 2, 2]), glisson.Tissue())
    body.drive("z_max", lambda t: (body.fix("z_min"), (0, 0, 0))[1] if 0.001 < t < 0.02 else (0, 0, 0))
    with pytest.raises(RuntimeError, match="fix: it was called from " + REFUSED):
        body.advance(0.1)
    with pytest.raises(RuntimeError, match=REFUSED):
        body.step()
    other = glisson.Simulation(glisson.box_mesh(cells=[2, 2, 2]), glisson.Tissue())
    other.step(3)
    assert other.steps == 3


WRONG = {"None": None, "'down'": "down", "'abc'": "abc", "two numbers": [1, 2], "a dict": {"x": 1}}


@pytest.mark.parametrize("answer", WRONG.values(), ids=WRONG.keys())
def test_a_function_that_returns_something_else_is_named(answer):
    """Motions, loads, pushes and paths: a TypeError has the argument's name, what was returned and what is expected; a
    motion that is refused at once holds nothing."""
    mesh = glisson.box_mesh(cells=[2, 2, 2])
    pose = glisson.Pose(position=[0.02, 0.02, 0.0801])

    def fails(words, *set_up):
        body = glisson.Simulation(mesh, glisson.Tissue())
        with pytest.raises(TypeError, match=words):
            for act in set_up:
                act(body)
            body.step(2)
        return body

    words = "motion returned .*; expected three numbers, a displacement"
    body = fails(words, lambda b: b.drive("z_max", lambda t: answer))
    body.drive("z_max", lambda t: (0, 0, 0))
    later = lambda t: answer if t > 0 else (0, 0, 0)  # noqa: E731
    fails("motion returned .*; expected three numbers", lambda b: b.drive("z_max", later))
    fails("motion returned .*; expected a Pose", lambda b: b.drive_rigidly("z_max", lambda t: answer))
    fails("scale returned .*; expected a number", lambda b: b.add_load("z_max", [0, 0, 1], lambda t: answer))

    def tool(driver):
        return lambda b: b.attach(glisson.ContactTool(glisson.ContactOptions(), driver))

    fails("force returned .*; expected a number", tool(glisson.PushDriver(pose, lambda t: answer)))
    fails("motion returned .*; expected three numbers", tool(glisson.PathDriver(pose, lambda t: answer)))
    fails("advance returned .*; expected a Pose, or three", tool(glisson.FunctionDriver(pose, lambda *given: answer)))


def test_methods_that_forget_to_return_are_named():
    """An interaction whose methods return nothing where something is asked for."""

    class Forgets(glisson.OwnInteraction):
        def __init__(self, method):
            super().__init__()
            setattr(self, method, lambda *given: None)

    mesh = glisson.box_mesh(cells=[2, 2, 2])
    names = {"reach": "reach", "squared_frequency": "squared_frequency returned None", "past": "past returned None"}
    for method, words in names.items():
        body = glisson.Simulation(mesh, glisson.Tissue())
        with pytest.raises(TypeError, match=words):
            body.attach(Forgets(method))
            body.step()
            body.save()
    for words, act in (
        ("scale = 3 is no function", lambda b: b.add_load("z_max", [0, 0, 1], 3)),
        ("motion = 3 is no function", lambda b: glisson.PathDriver(glisson.Pose(), 3)),
    ):
        with pytest.raises(TypeError, match=words):
            act(body)


def test_a_change_is_followed_by_all_whatever_one_raises():
    """What body_changed raises comes out when every interaction has followed the change: a tool after it presses on."""

    class Raises(glisson.OwnInteraction):
        def body_changed(self, mesh, origins):
            raise LookupError("no place")

    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), glisson.SimulationOptions(mesh_changes=True))
    body.fix("z_min")
    body.attach(Raises())
    path = glisson.PathDriver(glisson.Pose(position=[0.02, 0.02, 0.0801]), glisson.SteadyMotion(velocity=0.05))
    tool = glisson.ContactTool(glisson.ContactOptions(), path)
    body.attach(tool)
    body.step(20)
    low = glisson.Cutter(body)
    low.place([[0.0201, -0.01, 0.09], [0.0201, 0.05, 0.09]])
    with pytest.raises(LookupError, match="no place"):
        low.advance([[0.0201, -0.01, 0.05], [0.0201, 0.05, 0.05]])
    with pytest.raises(LookupError, match="no place"):
        body.remove_tets([0, 1, 2])
    body.step(50)
    assert tool.force[2] < -0.001 and np.isfinite(body.displacement).all()


BAD = {
    "nan": glisson.Pose(position=[0.02, NAN, 0.08]),
    "inf": glisson.Pose(position=[0.02, 0.02, float("inf")]),
    "far": glisson.Pose(position=[0.02, 0.02, 1.1]),
    "no rotation": glisson.Pose(position=[0.02, 0.02, 0.08], axes=np.diag([1, 1, 2])),
    "mirrored": glisson.Pose(position=[0.02, 0.02, 0.08], axes=np.diag([1, 1, -1])),
}


def pressed(driver):
    """The box with a flat punch over it."""
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), glisson.SimulationOptions(damping_rate=20))
    body.fix("z_min")
    tool = glisson.ContactTool(glisson.ContactOptions(), driver)
    body.attach(tool)
    return body, tool


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD.keys())
def test_a_hand_keeps_its_last_good_target(bad):
    """set_target raises ValueError, offer_target counts; the force on the device stays that of the last good target."""
    hand = glisson.HandDriver(glisson.Pose(position=[0.02, 0.02, 0.0801]))
    body, tool = pressed(hand)
    for k in range(50):
        hand.set_target(glisson.Pose(position=[0.02, 0.02, 0.0801 - 5e-5 * k]))
        body.step()
    force = hand.device_force.copy()
    with pytest.raises(ValueError, match="set_target: its "):
        hand.set_target(bad)
    assert hand.rejected == 0 and not hand.offer_target(bad) and hand.rejected == tool.rejected == 1
    assert np.array_equal(hand.device_force, force) and np.isfinite(force).all() and force[2] > 0
    body.step(100)
    assert tool.force[2] < -0.01 and np.isfinite(hand.device_force).all()
    assert hand.offer_target(glisson.Pose(position=[0.02, 0.02, 0.077])) and hand.rejected == 1


def test_a_hand_may_have_a_largest_speed():
    """A target that is faster than most_speed from the last one is refused with both speeds."""
    hand = glisson.HandDriver(glisson.Pose(), glisson.HandCoupling(most_speed=0.5))
    assert hand.offer_target(glisson.Pose(position=[0, 0, 0.0004]))
    with pytest.raises(ValueError, match="0.8 m/s from the last good target.*most_speed = 0.5 m/s"):
        hand.set_target(glisson.Pose(position=[0, 0, 0.0012]))
    assert not hand.offer_target(glisson.Pose(position=[0, 0, 0.0016])) and hand.rejected == 1


@pytest.mark.parametrize("bad", BAD.values(), ids=BAD.keys())
def test_a_driver_of_ones_own_that_gives_rubbish_loses_no_tool(bad):
    """Such poses are counted and the tool presses on where it was; positions alone take the last good rotation."""
    given = [0]

    def advance(t, h, on_tool):
        given[0] += 1
        return bad if 20 < given[0] <= 50 else [0.02, 0.02, 0.0801 - 1e-4 * min(given[0], 20)]

    body, tool = pressed(glisson.FunctionDriver(glisson.Pose(position=[0.02, 0.02, 0.0801]), advance))
    body.step(40)
    assert tool.rejected == 20 and tool.pose.position[2] == pytest.approx(0.0781) and tool.force[2] < -0.01
    body.step(20)
    assert tool.rejected == 30 and tool.force[2] < -0.01 and np.array_equal(tool.pose.axes, np.eye(3))


def test_a_state_that_is_none_is_named():
    """__setstate__ of what pickles refuses tuples that __getstate__ did not make."""
    mesh = glisson.box_mesh(cells=[1, 1, 1])
    scene = {"mesh": {"kind": "box", "cells": [1, 1, 1]}, "fixed": [{"set": "z_min"}], "motion": {"max_steps": 3}}
    result = glisson._core.run_variant(glisson.parse_scene(scene).variants[0])
    for good in (mesh, result, result.forces):
        kind, state = type(good), good.__getstate__()
        for wrong in ((), state[:-1], (*state, 0)):
            with pytest.raises(ValueError, match=f"{kind.__name__}.__setstate__: the state has {len(wrong)} parts"):
                kind.__new__(kind).__setstate__(wrong)
        with pytest.raises(TypeError):
            kind.__new__(kind).__setstate__((None,) * len(state))
    names, _ = result.forces.__getstate__()
    with pytest.raises(TypeError, match="Table.__setstate__"):
        kind.__new__(kind).__setstate__((names, np.zeros((2, len(names) + 1))))


def test_a_subinterpreter_is_refused():
    """The engine says so when it is imported there; the main interpreter goes on."""
    script = """
import importlib
names = ("_interpreters", "_xxsubinterpreters")
for name in names:
    try:
        inter = importlib.import_module(name)
        break
    except ImportError:
        pass
else:
    print("none"); raise SystemExit
number = inter.create()
code = "try:\\n import glisson._core\\nexcept ImportError as error:\\n print('refused:', error, flush=True)\\n"
inter.run_string(number, code)
import glisson
body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue())
body.drive("z_max", lambda t: (0, 0, 0))
body.step(3)
print("steps", body.steps)
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("none") or ("refused:" in done.stdout and "steps 3" in done.stdout), done.stdout
