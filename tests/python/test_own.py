"""Drivers and interactions written in Python act as those of the engine, and what they raise comes out as it is."""

import glisson
import numpy as np
import pytest


def pose(height=0.0201):
    return glisson.Pose(position=[0, 0, height])


def body_with(*interactions, **options):
    mesh = glisson.cylinder_mesh(radius=0.02, height=0.02, radial_cells=4, axial_cells=5)
    options = {"damping_rate": 20, **options}
    body = glisson.Simulation(mesh, glisson.Tissue(), glisson.SimulationOptions(**options))
    body.fix("bottom")
    for interaction in interactions:
        body.attach(interaction)
    return body


def needle(driver):
    return glisson.Needle(
        glisson.NeedleOptions(
            rupture=glisson.Rupture(force=0.05),
            tip=glisson.TipResistance(cutting=0.02),
            friction=glisson.ShaftFriction(dynamic_in=1, static_in=2),
        ),
        driver,
    )


class Steady(glisson.OwnDriver):
    """Down at 50 mm/s, and remembers what it felt."""

    def __init__(self):
        super().__init__(pose())
        self.felt = []

    def advance(self, time, h, on_tool):
        self.felt.append(on_tool.force[2])
        return pose(0.0201 - 0.05 * (time + h))


def test_a_driver_of_ones_own_leads_a_needle():
    """The same way by a subclass, a function and the engine's own path: the same bytes; the wrench is the needle's force."""
    steady = glisson.SteadyMotion(velocity=0.05, ramp=0.0)
    own = Steady()
    needles = [
        needle(glisson.PathDriver(pose(), steady)),
        needle(own),
        needle(glisson.FunctionDriver(pose(), lambda t, h, wrench: [0, 0, 0.0201 - 0.05 * (t + h)])),
    ]
    bodies = [body_with(x) for x in needles]
    for body in bodies:
        body.advance(0.2)
    assert needles[1].stage == "inside" and needles[1].depth == pytest.approx(needles[0].depth, rel=1e-9)
    assert bodies[1].state_hash == bodies[2].state_hash
    assert np.allclose(bodies[1].displacement, bodies[0].displacement, atol=1e-9)
    assert own.felt[-1] > 0.01 and own.start.position[2] == 0.0201 and own.end is None


def test_a_driver_that_feels():
    """Led by what it feels: a tool goes down until a tenth of a newton stands against it, and stays there."""
    tip = [0.0201]

    def until_force(t, h, on_tool):
        tip[0] -= 0.005 * h * np.clip((0.1 - on_tool.force[2]) / 0.1, -1, 1)
        return [0, 0, tip[0]]

    tool = glisson.ContactTool(
        glisson.ContactOptions(shape=glisson.FlatPunch(radius=0.008)), glisson.FunctionDriver(pose(), until_force)
    )
    body_with(tool).advance(1.5)
    assert -tool.forces.total[2] == pytest.approx(0.1, rel=0.02)


def test_what_a_driver_raises_comes_out():
    """An exception ends the stepping and leaves a body that can go on; so do a wrong answer and a method that is missing."""
    calls = []

    def breaks(t, h, on_tool):
        calls.append(t)
        if len(calls) == 5:
            raise ArithmeticError("five")
        return [0, 0, 0.0201]

    body = body_with(needle(glisson.FunctionDriver(pose(), breaks)))
    with pytest.raises(ArithmeticError, match="five"):
        body.step(100)
    assert len(calls) == 5 and body.steps == 5
    body.step(3)
    assert len(calls) == 8
    with pytest.raises(TypeError, match="expected a Pose"):
        body_with(needle(glisson.FunctionDriver(pose(), lambda *_: "down"))).step()

    class Silent(glisson.OwnDriver):
        pass

    with pytest.raises(TypeError, match="to be overridden"):
        body_with(needle(Silent(pose()))).step()


class Spring(glisson.OwnInteraction):
    """Draws vertices back to where they were at rest."""

    def __init__(self, vertices, stiffness, mass):
        super().__init__()
        self.vertices, self.stiffness, self.mass = np.asarray(vertices), stiffness, mass
        self.seen = 0

    def attached(self, mesh, time):
        self.count = len(mesh.vertices)

    def reach(self, time, h):
        return self.vertices

    def add_forces(self, step):
        at = np.isin(step.vertices, self.vertices)
        step.add_force(step.vertices[at], -self.stiffness * step.displacement[at])

    def squared_frequency(self):
        return self.stiffness / self.mass

    def moved(self, step):
        self.seen += 1

    def past(self):
        return [self.seen]

    def restore(self, past):
        self.seen = int(past[0])
        return True


def loaded(*interactions):
    mesh = glisson.box_mesh(cells=[2, 2, 4])
    options = glisson.SimulationOptions(damping_rate=300, precision="double")
    body = glisson.Simulation(mesh, glisson.Tissue(), options)
    held = body.fix("z_min")
    body.add_load("z_max", [0, 0, -0.2])
    for interaction in interactions:
        body.attach(interaction)
    return body, held


def test_an_interaction_of_ones_own():
    """A spring under each top vertex takes its share of a load: at rest springs and support carry it together, the step is
    kept short for the springs, the balance of energy holds, and a checkpoint goes on to the byte."""
    free, _ = loaded()
    top = free.mesh.vertex_sets["z_max"]
    spring = Spring(top, 50.0, free.masses[top].min())
    body, held = loaded(spring)
    assert spring.count == len(body.mesh.vertices)
    assert body.stable_step < free.stable_step
    free.advance(1.5), body.advance(1.5)
    carried = 50.0 * -body.displacement[top, 2].sum()
    assert carried + body.force(held).total[2] == pytest.approx(0.2, rel=1e-3)
    assert 0 < -body.displacement[top, 2].mean() < -0.8 * free.displacement[top, 2].mean()
    assert abs(body.energies.imbalance) < 1e-9 * body.energies.work_loads
    saved = body.save()
    other = Spring(top, 50.0, free.masses[top].min())
    on, _ = loaded(other)
    on.load(saved)
    assert other.seen == spring.seen == body.steps
    on.step(20), body.step(20)
    assert on.state_hash == body.state_hash


def test_impulses_hold_a_vertex():
    """A row that holds a vertex takes its velocity away, and it stays where it is; solved() has the impulse, a support's force."""

    class Pin(glisson.OwnInteraction):
        def reach(self, time, h):
            return [self.vertex]

        def declare(self, step, rows):
            rows.hold([self.vertex], [[0, 0, 0]])

        def solved(self, step, rows):
            self.force = rows.held[0] / step.h

    pin = Pin()
    body, _ = loaded()
    pin.vertex = int(body.mesh.vertex_sets["z_max"][0])
    body.attach(pin)
    body.advance(0.2)
    assert np.abs(body.displacement[pin.vertex]).max() < 1e-12 < np.abs(body.displacement).max()


def test_a_wall_of_ones_own_presses():
    """A wall that comes down on the top keeps it where a plate does, and has the plate's force."""
    mesh = glisson.box_mesh(cells=[3, 3, 3], size=[0.03, 0.03, 0.03])
    top = mesh.vertex_sets["z_max"]

    class Lid(glisson.OwnInteraction):
        z = 0.0301
        force = np.zeros(3)

        def reach(self, time, h):
            return top

        def declare(self, step, rows):
            rows.press(top, [0, 0, self.z], [0, 0, -1], velocity=[0, 0, -0.02], friction=0.1)
            self.z -= 0.02 * step.h

        def solved(self, step, rows):
            self.force = rows.pressed.sum(axis=0) / step.h

    def body_under(tool):
        body = glisson.Simulation(mesh, glisson.Tissue(), glisson.SimulationOptions(damping_rate=50.0))
        body.fix("z_min")
        body.attach(tool)
        body.advance(0.1)
        return body

    lid = Lid()
    down = glisson.SteadyMotion(direction=[0, 0, -1], velocity=0.02)
    plate = glisson.ContactTool(
        glisson.ContactOptions(shape=glisson.Plate(), friction=0.1),
        glisson.PathDriver(glisson.Pose(position=[0.015, 0.015, 0.0301]), down),
    )
    own, built_in = body_under(lid), body_under(plate)
    assert np.abs(own.displacement - built_in.displacement).max() < 1e-9
    assert abs(lid.force[2] - plate.force[2]) < 1e-6 * abs(plate.force[2])
    assert plate.force[2] < -0.1


def test_mistakes_of_an_interaction_are_told():
    """Vertices that are not there or not active, wrong shapes, a step kept for later, and what it raises itself."""

    class Wrong(glisson.OwnInteraction):
        def __init__(self, act):
            super().__init__()
            self.act = act

        def reach(self, time, h):
            return self.act("reach", None)

        def add_forces(self, step):
            self.act("forces", step)

    kept = []

    def after(what, act, named=(3,)):
        return Wrong(lambda when, step: list(named) if when == "reach" else (act(step) if when == what else None))

    cases = [
        (after("forces", lambda s: None, named=(99999,)), ValueError, "99999"),
        (after("forces", lambda s: s.add_force([20], [[0, 0, 1]])), ValueError, "not active"),
        (after("forces", lambda s: s.add_force([3], [0, 0, 1])), ValueError, "expected"),
        (after("forces", lambda s: 1 / 0), ZeroDivisionError, "division"),
    ]
    for interaction, error, words in cases:
        body, _ = loaded()
        body.attach(interaction)
        with pytest.raises(error, match=words):
            body.step(3)
    body, _ = loaded()
    body.attach(after("forces", kept.append))
    body.step()
    with pytest.raises(RuntimeError, match="the step is over"):
        _ = kept[0].displacement
    with pytest.raises(ValueError, match="implicit"):
        implicit = glisson.SimulationOptions(integrator="implicit")
        glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), implicit).attach(after("forces", kept.append))


def test_a_cutter_parts_a_block():
    """An edge led through a block by hand parts it along its path; views are refused while it would move the body."""
    mesh = glisson.box_mesh(cells=[4, 2, 4], size=[0.04, 0.02, 0.04])
    body = glisson.Simulation(mesh, glisson.Tissue(), glisson.SimulationOptions(mesh_changes=True))
    body.fix("z_min")
    cutter = glisson.Cutter(body, glisson.CutOptions(snap=False))
    cutter.place([[0.0201, -0.01, 0.05], [0.0201, 0.03, 0.05]])
    report = cutter.advance([[0.0201, -0.01, 0.02], [0.0201, 0.03, 0.02]])
    assert report.faces > 0 and report.new_vertices > 0 and report.area == pytest.approx(0.02 * 0.02, rel=0.5)
    assert len(body.mesh.vertices) == len(mesh.vertices) + report.new_vertices
    assert cutter.edge.tolist() == [[0.0201, -0.01, 0.02], [0.0201, 0.03, 0.02]]
    assert all(0 <= piece.tet < len(mesh.tets) and piece.length > 0 for piece in cutter.contact())
    body.step(5)
    again = glisson.Simulation(mesh, glisson.Tissue(), glisson.SimulationOptions(mesh_changes=True))
    again.fix("z_min")
    again.load(body.save())
    other = glisson.Cutter(again, glisson.CutOptions(snap=False))
    other.load(cutter.save())
    one, two = (c.advance([[0.0201, -0.01, -0.01], [0.0201, 0.03, -0.01]]) for c in (cutter, other))
    assert one.faces == two.faces > 0
    with pytest.raises(ValueError, match="3 points"):
        cutter.place(np.zeros((3, 3)))

    held = glisson.Simulation(mesh, glisson.Tissue())
    view = held.displacement
    cutter = glisson.Cutter(held)
    cutter.place([[0.0201, -0.01, 0.05], [0.0201, 0.03, 0.05]])
    with pytest.raises(BufferError, match="views"):
        cutter.advance([[0.0201, -0.01, 0.0], [0.0201, 0.03, 0.0]])
    del view


def test_a_blade_of_ones_own_cuts_as_it_goes():
    """A blade attached by hand cuts as the body is stepped, to its toughness' work; the arrays are copies then."""
    mesh = glisson.box_mesh(cells=[4, 2, 4], size=[0.04, 0.02, 0.04])
    body = glisson.Simulation(mesh, glisson.Tissue(youngs_modulus=2e4), glisson.SimulationOptions(damping_rate=50))
    body.fix("z_min")
    start = glisson.Pose(position=[0.0201, 0.01, 0.041])
    edge = glisson.BladeOptions(name="scalpel", edge_from=[0, -0.02, 0], edge_to=[0, 0.02, 0], toughness=5.0, cut_every=0)
    blade = glisson.Blade(edge, glisson.PathDriver(start, glisson.SteadyMotion(velocity=0.2)))
    body.attach(blade)
    assert blade.name == "scalpel" and blade.area == 0
    body.advance(0.1)
    assert blade.area > 1e-4 and blade.work_of_cut == pytest.approx(5.0 * blade.area)
    assert len(body.mesh.vertices) > len(mesh.vertices) and body.displacement.shape == body.mesh.vertices.shape
    with pytest.raises(ValueError, match="toughness"):
        glisson.Blade(glisson.BladeOptions(toughness=-1), glisson.PathDriver(start, glisson.SteadyMotion()))
    held = glisson.Simulation(mesh, glisson.Tissue())
    view = held.velocity
    with pytest.raises(BufferError, match="views"):
        held.attach(glisson.Blade(glisson.BladeOptions(), glisson.PathDriver(start, glisson.SteadyMotion())))
    del view, body
    assert blade.area > 0  # what it has cut, without the body
