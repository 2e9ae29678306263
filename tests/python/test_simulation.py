"""Simulations are stepped from Python, read without copies, interrupted, continued; what callbacks raise comes out."""

import gc
import os
import signal
import threading
import time

import glisson
import numpy as np
import pytest

PRESS = [207, 211, 212]


def pressed(options=None, motion=None, tissue=None):
    body = glisson.Simulation(glisson.box_mesh(), tissue or glisson.Tissue(), options)
    held = body.fix("z_min")
    tool = body.drive(PRESS, motion or glisson.PressMotion(depth=0.008))
    return body, held, tool


def test_slow_press_has_the_static_stiffness():
    """The linear box of figure 2 has 51.19 N/m under its triangle (docs/paper.md)."""
    body, _, tool = pressed(glisson.SimulationOptions(integrator="quasi_static", precision="double"))
    body.advance(0.5)
    depth = glisson.press_depth(glisson.PressMotion(depth=0.008), body.force_time)
    assert -body.force(tool).total[2] / depth == pytest.approx(51.19, rel=1e-3)


def test_forces_add_up():
    """The parts of a force are its total, and tool and support balance at rest."""
    body, held, tool = pressed(glisson.SimulationOptions(integrator="quasi_static"))
    body.advance(1.0)
    force = body.force(tool)
    parts = force.elastic + force.viscous + force.damping + force.inertial + force.gravity + force.load
    assert np.allclose(parts, force.total, atol=1e-15)
    assert np.allclose(force.total + body.force(held).total, 0, atol=1e-7)


def test_loads_on_faces():
    """A bar under traction has the stress of it; what spans no face is refused."""
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), glisson.SimulationOptions(integrator="quasi_static"))
    body.fix("z_min", axes="z"), body.fix("x_min", axes="x"), body.fix("y_min", axes="y")
    body.add_surface_load("z_max", glisson.SurfaceLoad(traction=[0, 0, 10]), lambda t: min(1.0, t / 0.01))
    body.advance(0.1)
    piola = body.tet_fields()["piola"]
    assert np.allclose(piola[:, 2, 2], 10, rtol=1e-8) and np.allclose(piola[:, 0, 0], 0, atol=1e-7)
    with pytest.raises(ValueError, match="spans no face"):
        body.add_surface_load([212], glisson.SurfaceLoad(pressure=1))


def test_turns_a_set():
    """A rotation turns a set as a rigid body; a function of time that gives poses does the same."""
    turn = glisson.RotationMotion(axis=[0, 0, 1], angle_deg=20, rate_deg_s=100)

    def pose(time):
        a = glisson.rotation_angle(turn, time)
        return glisson.Pose(axes=[[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]])

    torques = []
    for motion in (turn, pose):
        tissue = glisson.Tissue(kinematics="corotational")  # small strain does not balance moments about present places
        body = glisson.Simulation(glisson.box_mesh(), tissue, glisson.SimulationOptions(integrator="quasi_static"))
        foot = body.fix("z_min")
        head = body.drive_rigidly("z_max", motion)
        body.advance(0.2)
        torques.append(body.torque(head, [0, 0, 0])[2])
        assert torques[-1] > 0 and body.torque(foot, [0, 0, 0])[2] == pytest.approx(-torques[-1], rel=1e-5)
    assert torques[0] == pytest.approx(torques[1], rel=1e-9)
    with pytest.raises(ValueError, match="axis"):
        body.drive_rigidly([0], glisson.RotationMotion())


def test_energy_identity():
    """kinetic + elastic + dissipated = work, to the rounding of a float's element forces."""
    body, _, _ = pressed()
    body.advance(0.1)
    energies = body.energies
    assert energies.work_tools > 0 and abs(energies.imbalance) < 1e-5 * energies.work_tools
    assert body.stored_energy == pytest.approx(energies.elastic, rel=1e-5)
    assert body.energy_drift == pytest.approx(energies.elastic - body.stored_energy, abs=1e-15)


def test_a_motion_in_python_is_the_motion():
    """A press written as a function gives the bytes of the engine's own press."""
    press = glisson.PressMotion(depth=0.002, velocity=0.01)
    one, _, _ = pressed(motion=press)
    other, _, _ = pressed(motion=lambda t: (0, 0, -glisson.press_depth(press, t)))
    one.step(200), other.step(200)
    assert one.state_hash == other.state_hash
    assert glisson.press_end(press) == pytest.approx(0.2)


def test_views_follow_without_a_copy():
    """A view shows the engine's numbers after every step, cannot be written to, and keeps the simulation alive."""
    body, _, _ = pressed()
    u = body.displacement
    assert u.shape == (225, 3) and not u.any()
    body.step(10)
    assert u[207, 2] < 0 and np.shares_memory(u, body.displacement)
    assert np.array_equal(body.positions, body.mesh.vertices + u)
    assert body.velocity[207, 2] == pytest.approx(-0.01, rel=1e-6)
    assert body.masses.sum() == pytest.approx(1000 * body.mesh.volume, rel=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        u[0] = 1
    last = u.copy()
    del body
    assert np.array_equal(u, last)


def test_a_body_that_moves_in_memory_lends_no_views():
    """Splitting is refused while a view is held; with mesh_changes the arrays are copies, and splitting goes on."""
    mesh = glisson.box_mesh(cells=[2, 2, 2])
    inner = next(
        face
        for face in np.vstack([mesh.tets[:, list(c)] for c in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))]).tolist()
        if set(face) not in [set(t) for t in mesh.boundary_triangles().tolist()]
    )
    body = glisson.Simulation(mesh, glisson.Tissue())
    u = body.displacement
    with pytest.raises(BufferError, match="copy"):
        body.split_faces([inner])
    del u
    assert body.split_faces([inner]).closed_faces == 1
    body = glisson.Simulation(mesh, glisson.Tissue(), glisson.SimulationOptions(mesh_changes=True))
    u = body.displacement
    body.split_faces([inner])
    body.step(3)
    assert not np.shares_memory(u, body.displacement)


def test_tets_are_removed():
    """What is removed is gone from mass and present mesh, and said again by is_removed."""
    body, _, _ = pressed()
    body.step(5)
    report = body.remove_tets([0, 1])
    assert report.tets == 2 and report.mass > 0 and body.is_removed(0) and not body.is_removed(2)
    assert len(body.present_mesh.tets) == 766 and len(body.mesh.tets) == 768
    body.step(5)


def test_checkpoint_goes_on_with_the_same_bytes():
    """A run that is saved and loaded into another simulation has the bytes of one that was not interrupted."""
    straight, _, _ = pressed()
    straight.step(300)
    first, _, _ = pressed()
    first.step(120)
    second, _, _ = pressed()
    second.load(first.save())
    second.step(180)
    assert second.state_hash == straight.state_hash and second.steps == 300
    with pytest.raises(RuntimeError):
        second.load(b"not a checkpoint")


def test_goes_back_to_states_in_memory():
    """load_state and reset go back, also after a cut, and on with the same bytes; what was added since is refused."""
    body, _, _ = pressed()
    body.step(50)
    before = body.save_state()
    view = body.displacement
    body.step(70)
    after, later = body.state_hash, body.save_state()
    body.load_state(before)
    assert body.time == before.time and np.array_equal(view, body.displacement)
    body.step(70)
    assert body.state_hash == after
    del view
    body.remove_tets([0, 1])
    body.step(3)
    body.load_state(later)
    assert body.state_hash == after and not body.is_removed(0)
    body.reset()
    assert body.time == 0.0 and body.steps == 0 and not np.any(body.displacement)
    body.step(120)
    assert body.state_hash == after
    body.add_load("z_max", (0, 0, 0.1))
    with pytest.raises(ValueError, match="load no. 1 has been added since this state was saved"):
        body.load_state(before)
    other, _, _ = pressed()
    with pytest.raises(ValueError, match="of another simulation"):
        other.load_state(before)


def test_bytes_are_loaded_where_they_were_saved():
    """load takes what save returned in the same simulation too, after instruments have acted and tets have gone."""
    for kind in ("ball", "needle"):
        body = glisson.Simulation(
            glisson.box_mesh(cells=[6, 6, 4], size=[0.04, 0.04, 0.03], origin=[-0.02, -0.02, -0.03]),
            glisson.Tissue(youngs_modulus=4000),
            glisson.SimulationOptions(damping_rate=20.0),
        )
        body.fix("z_min")
        driver = glisson.PathDriver(glisson.Pose(position=[0, 0, 0.001]), lambda t: (0, 0, -0.03 * t))
        if kind == "ball":
            body.attach(glisson.ContactTool(glisson.ContactOptions(shape=glisson.Ball(radius=0.004)), driver))
        else:
            options = glisson.NeedleOptions(zone=8e-3, spacing=3e-3, rupture=glisson.Rupture(force=0.1))
            body.attach(glisson.Needle(options, driver))
        start = body.save()
        body.advance(0.02)
        early, after_early = body.save(), []
        body.advance(0.04)
        after_early.append(body.state_hash)
        body.advance(0.12)
        body.remove_tets([0])
        body.advance(0.13)
        body.load(early)
        body.advance(0.04)
        after_early.append(body.state_hash)
        body.load(start)
        body.advance(0.02)
        body.advance(0.04)
        after_early.append(body.state_hash)
        assert len(set(after_early)) == 1, kind


@pytest.mark.parametrize("integrator", ["central_difference", "semi_implicit", "implicit", "quasi_static"])
def test_arrays_are_what_they_say(integrator):
    """A view is up to date after every step, a copy stays what it was: under every integrator it is one or the other."""
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), glisson.SimulationOptions(integrator=integrator))
    body.fix("z_min")
    body.drive(PRESS, lambda t: (0, 0, -0.01 * t))
    body.step()
    is_view = integrator in ("central_difference", "semi_implicit")
    for name in ("displacement", "positions", "velocity"):
        array = getattr(body, name)
        was = array.copy()
        for _ in range(3):
            body.step()
            expected = getattr(body, name) if is_view and name != "positions" else was
            assert np.array_equal(array, expected), name


def test_state_is_set():
    """set_state puts a body where it is told, and counts energies from there."""
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue())
    still = np.zeros((225, 3))
    thrown = still + [0, 0, 0.5]
    body.set_state(still, thrown)
    body.step(20)
    assert np.allclose(body.displacement, [0, 0, 0.5 * body.time], rtol=1e-5)
    assert body.energies.initial == pytest.approx(0.5 * body.masses.sum() * 0.25, rel=1e-9)
    with pytest.raises(ValueError, match="expected"):
        body.set_state(still[:, :2], still)


def test_loads_and_gravity():
    """At rest the support carries the weight and the load."""
    options = glisson.SimulationOptions(integrator="quasi_static", gravity=[0, 0, -9.81])
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(youngs_modulus=2e4), options)
    held = body.fix("z_min", axes="xyz")
    body.add_load("z_max", (0.1, 0, 0), lambda t: min(1.0, t))
    body.advance(2.0)
    weight = 9.81 * 1000 * body.mesh.volume
    assert np.allclose(body.force(held).total, [-0.1, 0, weight], atol=1e-6)


def test_what_a_callback_raises_comes_out():
    """An exception in a motion ends the stepping and is raised as it is; the simulation can be read after it."""

    def motion(t):
        if t > 0.05:
            raise LookupError("no further")
        return 0, 0, -0.01 * t

    body, _, _ = pressed(motion=motion)
    with pytest.raises(LookupError, match="no further"):
        body.advance(1.0)
    assert 0.04 < body.time < 0.06


def test_observers_see_the_run_and_end_it():
    """An observer is called every so often and at the end; what it raises ends the run there."""
    body, _, tool = pressed()
    seen = []
    body.advance(0.1, observer=lambda: seen.append((body.time, body.force(tool).total[2])), every=0.01)
    assert len(seen) == 10 and np.allclose([t for t, _ in seen], 0.01 * np.arange(1, 11), atol=body.step_size)

    def stop():
        raise StopIteration("enough")

    with pytest.raises(StopIteration, match="enough"):
        body.advance(0.2, observer=stop, every=0.02)
    assert body.time == pytest.approx(0.12, abs=2 * body.step_size)


def test_keyboard_interrupt_ends_a_run():
    """Ctrl-C reaches a simulation that steps without the GIL."""
    body, _, _ = pressed(glisson.SimulationOptions(step=1e-6))
    threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        body.advance(1e6)
    assert time.monotonic() - start < 30  # far from the hours that the run would take
    body.step()


def test_keyboard_interrupt_within_a_long_step():
    """Ctrl-C ends a step of Newton's method that takes longer: nothing has changed, and the next call makes it."""
    mesh = glisson.box_mesh(cells=[16, 16, 16], size=[0.04, 0.04, 0.04])
    tissue = glisson.Tissue(hyperelastic=glisson.NeoHookean(mu=1000, bulk_modulus=50000))
    body = glisson.Simulation(mesh, tissue, glisson.SimulationOptions(integrator="quasi_static", step=1.0))
    body.fix("z_min")
    body.drive("z_max", lambda t: (0.0, 0.0, -0.012 * t))
    for advance in (body.step, lambda: body.advance(1.0)):
        sent = []

        def press():
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        threading.Timer(0.5, press).start()
        with pytest.raises(KeyboardInterrupt):
            advance()
        assert time.monotonic() - sent[0] < 20.0  # 1 s on a machine that does nothing else
        assert body.steps == 0 and body.time == 0 and not np.any(body.displacement)


def test_threads_run_side_by_side_and_apart():
    """Another thread runs Python while one steps; it may not touch that simulation; nor may a callback step it."""
    body, _, _ = pressed(glisson.SimulationOptions(step=1e-6))
    worker = threading.Thread(target=body.step, args=(300_000,))
    worker.start()
    time.sleep(0.05)
    refused = False
    while worker.is_alive():
        try:
            body.displacement  # noqa: B018
        except RuntimeError as error:
            refused = refused or "another thread" in str(error)
    worker.join()
    assert refused and body.steps == 300_000
    loop, _, _ = pressed(motion=lambda t: (loop.step(), (0, 0, 0))[1] if t > 0 else (0, 0, 0))
    with pytest.raises(RuntimeError, match="inside a step or a change"):
        loop.step(3)


def test_steps_that_cannot_be_made():
    """A step above h* is refused with the ways out; a body that nothing holds has no static equilibrium."""
    with pytest.raises(ValueError, match="step"):
        glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), glisson.SimulationOptions(step=0.1))
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(), glisson.SimulationOptions(integrator="quasi_static"))
    body.add_load("z_max", (0, 0, 1))
    for advance in (body.step, lambda: body.advance(0.1)):
        with pytest.raises(glisson.StepError, match="rigid body.*Hold at least three"):
            advance()
    body, _, _ = pressed(motion=lambda t: (0, 0, float("nan") if t > 0.01 else 0))
    with pytest.raises(glisson.StepError, match="not finite.*Ways out"):
        body.advance(0.1)


def test_tet_fields_of_a_uniform_stretch():
    """A uniform stretch gives J, s and stress that the formulas give."""
    mesh = glisson.box_mesh(cells=[2, 2, 2])
    body = glisson.Simulation(mesh, glisson.Tissue(youngs_modulus=1000, poisson_ratio=0.25))
    body.set_state(mesh.vertices * [0, 0, 0.01], np.zeros_like(mesh.vertices))
    fields = body.tet_fields()
    lame, mu = glisson.lame_from_young(1000, 0.25)
    assert np.allclose(fields["jacobian"], 1.01, rtol=1e-9)
    assert np.allclose(fields["stress"][:, 2], (lame + 2 * mu) * 0.01, rtol=1e-9)
    assert fields["piola"].shape == (len(mesh.tets), 3, 3)
    assert np.allclose(fields["piola"][:, 2, 2], fields["stress"][:, 2], rtol=1e-12), "small strain: P is the stress"
    assert np.allclose(fields["q"], 3 * 1.01 ** (2 / 3) / (2 + 1.01**2), rtol=1e-9)
    assert np.allclose(fields["s"], np.sqrt(1.5 * (1 - fields["q"])), rtol=1e-6)


def test_adaptive_precision():
    """At rest the linear law comes into force everywhere; the share says how much of it there is, the field where."""
    mesh = glisson.box_mesh(cells=[2, 2, 2])
    tissue = glisson.Tissue(kinematics="corotational")
    body = glisson.Simulation(mesh, tissue, glisson.SimulationOptions(precision="adaptive", precision_error=0.01))
    assert body.linear_share == 0
    for _ in range(200):
        body.step()
    assert body.linear_share == 1 and np.all(body.tet_fields()["linear"] == 1)
    with pytest.raises(ValueError, match="precision_error"):
        glisson.Simulation(mesh, tissue, glisson.SimulationOptions(precision="adaptive", precision_error=2))
    with pytest.raises(ValueError, match="adaptive.*not supported by the integrator implicit"):
        glisson.Simulation(mesh, tissue, glisson.SimulationOptions(precision="adaptive", integrator="implicit"))


def test_tissues_by_region():
    """Regions take their tissues by number or name; a name that the mesh does not know is refused."""
    box = glisson.box_mesh(cells=[2, 2, 2])
    upper = (box.vertices[box.tets].mean(axis=1)[:, 2] > 0.04).astype(int)
    mesh = glisson.TetMesh(box.vertices, box.tets, regions=upper, region_names={1: "lobe"}, vertex_sets=box.vertex_sets)
    soft, hard = glisson.Tissue(density=1000), glisson.Tissue(density=2000)
    body = glisson.Simulation(mesh, {0: soft, "lobe": hard})
    assert body.masses.sum() == pytest.approx(1500 * mesh.volume, rel=1e-12)
    with pytest.raises(ValueError, match='no region "lob"'):
        glisson.Simulation(mesh, {0: soft, "lob": hard})


def test_readings_of_the_engine():
    """What a simulation says of its step and its evaluation."""
    body, _, _ = pressed(glisson.SimulationOptions(mass_scaling_step=3e-3))
    assert body.step_size <= body.stable_step and body.engine_info.threads >= 1 and body.engine_info.submeshes >= 1
    assert body.limiting_tets(3)[0].step <= body.limiting_tets(3)[2].step
    assert body.mass_scaling.added > 0 and len(body.mass_scaling.tets) > 0
    assert repr(body.mass_scaling).startswith(f"MassScaling(added={body.mass_scaling.added!r}, share=")
    assert body.step() == "ok" and len(body.inverted_tets) == 0


def test_choices_of_vertices():
    """A set by name, numbers, or a mask hold the same; a name that is none is answered with those there are."""
    hashes = set()
    mesh = glisson.box_mesh()
    for choice in ("z_min", mesh.vertex_sets["z_min"], list(mesh.vertex_sets["z_min"]), mesh.vertices[:, 2] == 0):
        body = glisson.Simulation(mesh, glisson.Tissue())
        body.fix(choice)
        body.drive(PRESS, glisson.PressMotion())
        body.step(20)
        hashes.add(body.state_hash)
    assert len(hashes) == 1
    with pytest.raises(ValueError, match='no vertex set "zmin"; did you mean "z_min"\\? the sets are: x_max'):
        body.fix("zmin")
    with pytest.raises(ValueError, match="axes"):
        body.fix("z_max", axes="w")


def test_a_motion_may_refer_to_its_simulation():
    """A simulation whose motion refers to it is freed by the garbage collector."""
    body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue())
    told = []

    class Watcher:
        def __del__(self):
            told.append(True)

    watcher = Watcher()
    body.drive(PRESS, lambda t, b=body, w=watcher: (0, 0, 0))
    body.step(3)
    del body, watcher
    gc.collect()
    assert told == [True]


def test_a_tissue_changes_while_the_body_moves():
    """A static press has twice the force with twice the modulus; the state stays, and the energies balance."""
    body, _, tool = pressed(glisson.SimulationOptions(integrator="quasi_static"))
    body.advance(1.0)
    before, force = body.displacement.copy(), body.force(tool).total[2]
    tissue = body.tissue()
    tissue.youngs_modulus *= 2
    assert body.tissue() != tissue
    body.set_tissue(0, tissue)
    assert body.tissue() == tissue and np.array_equal(body.displacement, before)
    body.step()
    assert body.force(tool).total[2] == pytest.approx(2 * force, rel=1e-6)
    energies = body.energies
    assert energies.changed > 0 and abs(energies.imbalance) < 1e-6 * energies.work_tools


def test_regions_go_by_name_and_refusals_say_why():
    """Regions have names or numbers; a tissue or region that is wrong is refused and changes nothing."""
    mesh = glisson.box_mesh(cells=[2, 2, 4])
    regions = (np.asarray(mesh.vertices)[np.asarray(mesh.tets)].mean(axis=1)[:, 2] > 0.04).astype(int)
    mesh = glisson.TetMesh(mesh.vertices, mesh.tets, regions=regions, region_names={0: "soft", 1: "hard"})
    body = glisson.Simulation(mesh, {"soft": glisson.Tissue(), "hard": glisson.Tissue(youngs_modulus=9000)})
    body.set_tissues({"soft": glisson.Tissue(youngs_modulus=1000), 1: glisson.Tissue(youngs_modulus=2000)})
    assert body.tissue("soft").youngs_modulus == 1000 and body.tissue(1).youngs_modulus == 2000
    body.set_tissues(glisson.Tissue(viscosity=2))
    assert body.tissue(0).viscosity == body.tissue("hard").viscosity == 2
    with pytest.raises(ValueError, match="youngs_modulus"):
        body.set_tissue(0, glisson.Tissue(youngs_modulus=-1))
    with pytest.raises(ValueError, match="soft, hard"):
        body.set_tissue("liver", glisson.Tissue())
    with pytest.raises(ValueError, match="region 7"):
        body.set_tissue(7, glisson.Tissue())
    assert body.tissue(0).viscosity == 2


def test_mistakes_are_told_at_once():
    """A mask of another length, a motion that is none, and fields of the wrong kind are refused with what was given."""
    body = glisson.Simulation(glisson.box_mesh(cells=[2, 2, 2]), glisson.Tissue())
    with pytest.raises(ValueError, match="mask of 3, but the mesh has 27"):
        body.fix(np.ones(3, dtype=bool))
    with pytest.raises(TypeError, match=r"motion = 3.0 is neither"):
        body.drive("z_max", 3.0)
    with pytest.raises(TypeError, match="kinematics = 'big' does not fit; expected .*'corotational'"):
        glisson.Tissue(kinematics="big")
    with pytest.raises(TypeError, match="youngs_modulus = 'stiff' does not fit; expected float"):
        glisson.Tissue(youngs_modulus="stiff")
