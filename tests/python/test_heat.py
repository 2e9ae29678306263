"""HeatSimulation: freezing against its closed form, death, callbacks, states, and scenes of heat."""

import gc
import weakref

import glisson
import numpy as np
import pytest

SHARP = {"freezing_begins": -1.0, "freezing_ends": -1.05}


def box(cells=4, size=0.04):
    return glisson.box_mesh(cells=[cells] * 3, size=[size] * 3)


def test_front_of_neumann():
    """Half a space at 37 °C whose face is at −140 °C freezes 26.10 mm deep in 600 s (docs/heat.md)."""
    mesh = glisson.box_mesh(cells=[160, 1, 1], size=[0.12, 0.00075, 0.00075])
    s = glisson.HeatSimulation(mesh, glisson.ThermalTissue(**SHARP), glisson.HeatOptions(tolerance=0.025))
    s.hold("x_min", -140.0)
    s.advance(600.0)
    assert s.time == 600.0
    assert s.frozen_volume() / 0.00075**2 == pytest.approx(0.0261, rel=0.01)
    assert abs(s.ledger.imbalance) < 1e-10 * abs(s.ledger.held)
    assert s.temperature.min() == pytest.approx(-140.0)
    assert np.all((s.frozen_share >= 0) & (s.frozen_share <= 1))


def test_probe_freezes_holds_and_thaws():
    """A probe with a surface temperature through a coefficient kills around it; tissue thaws, and stays dead without blood."""
    tissue = glisson.thermal_preset("liver")
    s = glisson.HeatSimulation(box(10), tissue, glisson.HeatOptions(isotherms=[0.0, -40.0]))
    s.add_line_source(
        [0.02, 0.02, 0.01], [0.02, 0.02, 0.03], temperature=-150.0, coefficient=([0, 300, 300], [10, 10, 0]), radius=0.001
    )
    seen = []
    s.advance(300.0, observer=lambda: seen.append((s.time, s.volume_below(-40.0))), every=100.0)
    assert [time for time, _ in seen] == [100.0, 200.0, 300.0]
    dead = s.dead_volume()
    assert dead > 0 and seen[-1][1] > 0
    given = s.ledger.sources
    s.advance(3000.0)
    assert s.ledger.sources == given
    assert s.frozen_volume() == 0.0
    assert s.dead_volume() >= dead
    history = s.history
    assert history["below"].shape == (2, len(s.mesh.vertices))
    assert history["coldest"].min() < -40 and history["dead"].max() == 1 and history["freezings"].max() == 1
    assert s.extent_below(200.0).volume == pytest.approx(0.04**3)
    assert s.temperature_at([[0.0, 0.0, 0.0]])[0] == pytest.approx(s.temperature[0])


def test_functions_of_time_raise_and_are_collected():
    """What a function raises comes out of advance; one that refers to its simulation does not keep it alive."""
    s = glisson.HeatSimulation(box(), glisson.ThermalTissue())

    def course(time):
        if time > 20:
            raise RuntimeError("no more")
        return 37.0 - time if s.steps >= 0 else 37.0

    s.hold("x_min", course)
    with pytest.raises(RuntimeError, match="no more"):
        s.advance(60.0)
    with pytest.raises(TypeError, match="no function of time"):
        s.add_flux("x_max", "warm")
    with pytest.raises(ValueError, match="times ascending"):
        s.add_flux("x_max", ([1, 0], [1, 2]))
    kept = weakref.ref(course)
    del s, course
    gc.collect()
    assert kept() is None


def test_states_go_back():
    """Saved states, in memory and as bytes, go on with the same numbers; foreign bytes are refused."""

    def made():
        s = glisson.HeatSimulation(box(), glisson.ThermalTissue(death=glisson.TissueDeath(cold=-20.0)))
        s.hold("z_min", -80.0)
        return s

    s = made()
    s.advance(50.0)
    state, checkpoint = s.save_state(), s.save()
    s.advance(100.0)
    end = s.temperature
    s.load_state(state)
    assert s.time == 50.0 and state.time == 50.0
    s.advance(100.0)
    assert np.array_equal(s.temperature, end)
    other = made()
    other.load(checkpoint)
    other.advance(100.0)
    assert np.array_equal(other.temperature, end)
    with pytest.raises(RuntimeError):
        other.load(b"nothing of the kind")


def test_refuses_by_name():
    """Kelvin, a region without tissue, a probe outside the body: with name and way out."""
    with pytest.raises(ValueError, match="not in K"):
        glisson.HeatSimulation(box(), glisson.ThermalTissue(), glisson.HeatOptions(temperature=310.0))
    with pytest.raises(ValueError, match="has no thermal tissue"):
        glisson.HeatSimulation(box(), {1: glisson.ThermalTissue()})
    s = glisson.HeatSimulation(box(), glisson.ThermalTissue())
    with pytest.raises(ValueError, match="leaves the body"):
        s.add_line_source([0.02, 0.02, 0.02], [0.02, 0.02, 0.2], power_per_length=-200.0)
    with pytest.raises(ValueError, match="gives no heat"):
        s.add_line_source([0.02, 0.02, 0.01], [0.02, 0.02, 0.02])
    with pytest.raises(ValueError, match="outside the body"):
        s.temperature_at([[1.0, 0.0, 0.0]])


def test_of_a_scene():
    """A shipped scene of heat gives its simulation and what it reads; mechanics are refused for it."""
    scene = glisson.load_scene(glisson.scenes_folder() / "heat" / "neumann.toml", {"heat.tolerance_K": 0.1})
    s = glisson.HeatSimulation.of_variant(scene["at_80"])
    s.advance(600.0)
    assert s.readings["front_m"] == pytest.approx(0.0200812, rel=0.01)
    assert s.readings["depth_1_C"] < 0
    with pytest.raises(glisson.SceneError, match="scene is one of heat"):
        glisson.simulation(scene, "at_80")


def test_options_pickle_and_compare():
    """Options are values, as all others."""
    import pickle

    tissue = glisson.thermal_preset("soft_tissue")
    assert pickle.loads(pickle.dumps(tissue)) == tissue
    assert tissue.death is not None and tissue.death.cold == -40.0
    assert glisson.cem43(43.0, 43.0, 60.0) == pytest.approx(1.0)


def test_currents_and_patterns_give_their_power():
    """A bar between electrodes takes V² σ A / L, a pattern its sum over the tets; both stand in the balance as sources."""
    mesh = glisson.box_mesh(cells=[10, 2, 2], size=[0.1, 0.02, 0.02])
    tissue = glisson.ThermalTissue(electric_conductivity=0.2, electric_rise=0.0)

    def after(given, seconds=5.0):
        s = glisson.HeatSimulation(mesh, tissue, glisson.HeatOptions(temperature=20.0))
        given(s)
        s.advance(seconds)
        return s.ledger.sources / seconds

    bar = 20.0**2 * 0.2 * 4e-4 / 0.1
    assert abs(after(lambda s: s.add_radio("x_min", "x_max", voltage=20.0)) - bar) < 1e-6 * bar
    assert abs(after(lambda s: s.add_radio("x_min", "x_max", power=0.5)) - 0.5) < 1e-6
    pattern = np.full(len(mesh.tets), 1e5)
    assert abs(after(lambda s: s.add_pattern(pattern, 1.0)) - 1e5 * 4e-5) < 1e-9
    with pytest.raises(ValueError, match="pattern of power has 3 values"):
        after(lambda s: s.add_pattern(pattern[:3], 1.0))
