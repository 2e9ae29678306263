"""Instruments are made, driven and read from Python."""

import glisson
import numpy as np
import pytest


def cylinder():
    return glisson.cylinder_mesh(radius=0.02, height=0.02, radial_cells=4, axial_cells=5)


def body_with(*interactions, damping=20):
    body = glisson.Simulation(cylinder(), glisson.Tissue(), glisson.SimulationOptions(damping_rate=damping))
    body.fix("bottom")
    for interaction in interactions:
        body.attach(interaction)
    return body


def pose(height=0.0201):
    return glisson.Pose(position=[0, 0, height])


def test_an_instrument_belongs_to_one_simulation():
    """Attached a second time, to the same simulation or another, an instrument is refused by name, and the first goes on."""
    still = glisson.PathDriver(pose(), glisson.SteadyMotion())
    for interaction, name in [
        (glisson.Needle(glisson.NeedleOptions(name="trocar"), still), "trocar"),
        (glisson.ContactTool(glisson.ContactOptions(name="finger"), still), "finger"),
        (glisson.Container(glisson.ContainerOptions(name="pot")), "pot"),
        (glisson.Capsule(glisson.CapsuleOptions(name="skin")), "skin"),
    ]:
        body, other = body_with(interaction), body_with()
        for second in (body, other):
            with pytest.raises(ValueError, match=f'"{name}" acts on a simulation already.*make a new one'):
                second.attach(interaction)
        body.step(3)
        other.step(3)


def test_a_needle_pierces_and_goes_on():
    """A needle presses until its rupture force, pierces, cuts on; its events and lengths say so."""
    options = glisson.NeedleOptions(
        rupture=glisson.Rupture(force=0.05),
        tip=glisson.TipResistance(cutting=0.02),
        friction=glisson.ShaftFriction(dynamic_in=1, static_in=2),
    )
    needle = glisson.Needle(options, glisson.PathDriver(pose(), glisson.SteadyMotion(velocity=0.05)))
    body = body_with(needle)
    assert needle.stage == "outside"
    body.advance(0.25)
    names = [event.event for event in needle.events]
    assert needle.stage == "inside" and names[:2] == ["contact", "puncture"]
    assert needle.depth == pytest.approx(0.0125, rel=0.02)
    assert 0 < needle.inserted_length < needle.depth and needle.path.shape[1] == 3
    assert needle.crossing.shape == (1, 2) and np.ptp(needle.crossing) == pytest.approx(needle.inserted_length)
    forces = needle.forces
    assert np.allclose(forces.normal + forces.friction + forces.cutting, forces.total, atol=1e-12)
    assert -forces.total[2] > 0 and needle.tip_force > 0 and needle.centre_line[-1, 2] < 0.0201
    assert needle.options.rupture.force == 0.05 and "puncture" in repr(needle.events[1])


def test_an_inner_membrane_is_broken():
    """A membrane below the surface is an option of the needle, and an event when it breaks; drawn ones are options, too."""
    options = glisson.NeedleOptions(
        rupture=glisson.Rupture(force=0.05),
        tip=glisson.TipResistance(cutting=0.02),
        membranes=[glisson.InnerMembrane(depth=0.004, puncture=0.06, cutting=0.03)],
    )
    needle = glisson.Needle(options, glisson.PathDriver(pose(), glisson.SteadyMotion(velocity=0.05)))
    body_with(needle).advance(0.3)
    assert [event.event for event in needle.events].count("inner puncture") == 1 and needle.path_length > 0.004
    drawn = glisson.NeedleOptions(drawn_membranes=glisson.MembraneProcess(spacing=0.002, seed=3))
    assert drawn.drawn_membranes.seed == 3 and drawn.drawn_membranes.spread == 0.2


def test_a_punch_presses_and_its_pressure_adds_up():
    """What a punch exerts along its axis is the sum of its pressures over their areas, which bear at the surface."""
    tool = glisson.ContactTool(
        glisson.ContactOptions(shape=glisson.FlatPunch(radius=0.008)),
        glisson.PathDriver(pose(), glisson.PressMotion(velocity=0.05, depth=0.003)),
    )
    body = body_with(tool)
    assert not tool.touches
    body.advance(0.06)
    vertices, pressure = tool.contact_pressure
    assert tool.touches and len(vertices) == len(pressure) > 0 and (pressure > 0).all()
    mean = -tool.forces.total[2] / tool.contact_area
    assert pressure.min() <= mean <= pressure.max()
    assert tool.force_depth <= tool.depth and tool.direction.tolist() == [0, 0, -1] and tool.name == "tool"


def test_paths_of_every_kind():
    """Strokes, sines, records, and a function of Python lead a tool where they say."""
    ways = [
        (glisson.StrokeMotion(strokes=[glisson.Stroke(to=[0, 0, -0.002], velocity=0.1)]), -0.002),
        (glisson.RecordedMotion(times=[0, 0.05], positions=[[0, 0, 0], [0, 0, -0.001]]), -0.001),
        (glisson.SineMotion(amplitude=0.001, frequency=5, duration=0.05), -0.001),
        (lambda t: (0, 0, -0.02 * t), -0.02 * 0.05),
    ]
    for way, z in ways:
        tool = glisson.ContactTool(glisson.ContactOptions(shape=glisson.Ball()), glisson.PathDriver(pose(0.05), way))
        body_with(tool).advance(0.05)
        assert tool.pose.position[2] == pytest.approx(0.05 + z, abs=2e-5)


def test_a_push_and_a_hand():
    """A pushed tool comes to rest where the tissue balances the push; a hand feels what it is drawn back by."""
    push = glisson.PushDriver(pose(), 0.2, mass=0.02, damping=2.0)
    tool = glisson.ContactTool(glisson.ContactOptions(shape=glisson.FlatPunch(radius=0.008)), push)
    body_with(tool).advance(1.5)
    assert -tool.forces.total[2] == pytest.approx(0.2, rel=0.02) and abs(push.velocity[2]) < 1e-3

    hand = glisson.HandDriver(pose(), glisson.HandCoupling(stiffness=200))
    tool = glisson.ContactTool(glisson.ContactOptions(shape=glisson.FlatPunch(radius=0.008)), hand)
    body = body_with(tool)
    for i in range(600):
        hand.set_target(pose(0.0201 - min(i, 300) * 1e-5))
        body.advance(1e-3 * (i + 1))
    felt = hand.device_force[2]
    assert felt > 0 and felt == pytest.approx(200 * (tool.pose.position[2] - 0.0171), rel=1e-6)
    assert glisson.largest_passive_stiffness(glisson.HandCoupling()) > 300


def test_a_push_written_in_python():
    """A force that is a function of time is asked for, and what it raises comes out."""

    def force(t):
        if t > 0.02:
            raise ArithmeticError("too far")
        return 0.1

    tool = glisson.ContactTool(glisson.ContactOptions(), glisson.PushDriver(pose(), force))
    with pytest.raises(ArithmeticError, match="too far"):
        body_with(tool).advance(0.1)


def test_a_container_weighs_what_lies_in_it():
    """A block at rest loads the bottom by its weight."""
    container = glisson.Container(glisson.ContainerOptions(vessel=glisson.CylinderVessel(radius=0.0201)))
    options = glisson.SimulationOptions(damping_rate=200, gravity=[0, 0, -9.81], gravity_ramp=0.1)
    body = glisson.Simulation(cylinder(), glisson.Tissue(youngs_modulus=2e4), options)
    body.attach(container)
    body.advance(1.0)
    weight = 9.81 * body.masses.sum()
    assert container.sensor_loads.bottom[2] == pytest.approx(-weight, rel=0.02) and container.up.tolist() == [0, 0, 1]
    assert np.allclose(container.sensor_loads.total, container.sensor_loads.bottom + container.sensor_loads.side)


def test_a_capsule_tears_where_it_is_told():
    """A hole takes tension off, and its area is counted."""
    capsule = glisson.Capsule(glisson.CapsuleOptions(thickness=1e-5, youngs_modulus=1e5, prestretch=1.05))
    body = body_with(capsule)
    body.step(20)
    assert capsule.largest_tension > 0 and capsule.energy > 0 and capsule.open_area == 0
    opened = capsule.open_at([0, 0, 0.02], 0.004)
    assert capsule.open_area == pytest.approx(opened) and capsule.open_share.max() > 0
    capsule.tear(0)
    assert capsule.is_torn(0) and len(capsule.tension) == len(body.mesh.boundary_triangles())
    assert capsule.tension_at([0, 0, 0]) >= 0 and capsule.released_energy > 0


def test_a_needle_tears_a_capsule():
    """The hole of a puncture opens the capsule."""
    capsule = glisson.Capsule(glisson.CapsuleOptions(thickness=1e-5, youngs_modulus=1e5))
    needle = glisson.Needle(
        glisson.NeedleOptions(rupture=glisson.Rupture(force=0.05)),
        glisson.PathDriver(pose(), glisson.SteadyMotion(velocity=0.05)),
    )
    needle.tears(capsule)
    body_with(capsule, needle).advance(0.2)
    assert needle.stage == "inside" and capsule.open_area > 0


def test_distances_of_shapes():
    """A shape's distance and its normal, at places where they are known."""
    assert glisson.distance_to(glisson.Ball(radius=0.01), [0, 0, 0.03])[0] == pytest.approx(0.01)
    distance, normal = glisson.distance_to(glisson.Plate(), [0, 0, -0.5])
    assert distance == 0.5 and normal.tolist() == [0, 0, -1]
    assert glisson.distance_to(glisson.Block(size=[2, 2, 2]), [0, 0, 1])[0] == -1
    assert glisson.distance_to(glisson.CylinderWall(radius=1), [0.5, 0, 0])[0] == pytest.approx(0.5)
    assert glisson.distance_to(glisson.NeedleShape(), [0, 0, -0.01])[0] > 0


def test_wrong_options_are_refused():
    """Option, value and range are in the message."""
    with pytest.raises(ValueError, match="diameter"):
        glisson.Needle(glisson.NeedleOptions(diameter=-1), glisson.PathDriver(pose(), glisson.SteadyMotion()))
    with pytest.raises(ValueError, match="radius"):
        glisson.ContactTool(
            glisson.ContactOptions(shape=glisson.Ball(radius=0)), glisson.PathDriver(pose(), glisson.SteadyMotion())
        )
    newmark = glisson.ImplicitOptions(scheme="newmark")
    options = glisson.SimulationOptions(integrator="implicit", implicit=newmark)
    body = glisson.Simulation(cylinder(), glisson.Tissue(), options)
    ball = glisson.ContactOptions(shape=glisson.Ball(radius=0.005))
    with pytest.raises(ValueError, match="needs scheme = backward_euler under implicit"):
        body.attach(glisson.ContactTool(ball, glisson.PathDriver(pose(), glisson.SteadyMotion())))


def test_a_blade_of_a_scene_cuts(scenes):
    """A scene's blade is read like other instruments; the body's arrays are copies then."""
    body = glisson.simulation(scenes / "needle" / "cut.toml")
    blade = next(x for x in body.instruments.values() if isinstance(x, glisson.Blade))
    assert blade.form["kind"] == "blade" and len(blade.form["size_m"]) == 6 and blade.centre_line.shape == (1, 3)
    before = body.displacement
    body.step(5)
    assert blade.area >= 0 and blade.work_of_cut >= 0 and blade.length_in_tissue >= 0
    assert not np.shares_memory(before, body.displacement)


def test_an_instrument_belongs_to_one_simulation():
    """A second simulation, or the same one again, is refused by the instrument's name; the first one goes on."""
    tool = glisson.ContactTool(
        glisson.ContactOptions(name="finger", shape=glisson.Ball(radius=0.005)),
        glisson.PathDriver(pose(0.025), glisson.SteadyMotion(velocity=0.1)),
    )
    first, second = body_with(tool), body_with()
    for body in (first, second):
        with pytest.raises(ValueError, match='instrument "finger" acts on a simulation already'):
            body.attach(tool)
    first.step(20)
    second.step(20)
