"""Tissues hold every field of the engine's, laws are evaluated, presets have their sources."""

import copy
import re
from pathlib import Path

import glisson
import numpy as np
import pytest


def test_every_field_is_there():
    """The class has the fields of the C++ struct, all of them."""
    header = (Path(__file__).parents[2] / "include/glisson/material/tissue.h").read_text(encoding="utf-8")
    body = re.search(r"^struct Tissue \{\n(.*?)^\};", header, re.MULTILINE | re.DOTALL).group(1)
    declared = re.findall(r"^  [\w:<>]+ (\w+)(?: =[^;]*|\{\})?;", body, re.MULTILINE)
    assert len(declared) > 10 and list(glisson.Tissue._fields) == declared


def test_defaults_and_setting():
    """Fields are set by name in the constructor or later, copies are apart, equal tissues are equal."""
    tissue = glisson.Tissue(youngs_modulus=5000, kinematics="green", law=glisson.LinearLaw(slope=2e4))
    other = copy.copy(tissue)
    assert other == tissue
    other.viscosity = 100
    assert tissue.viscosity == 0 and other != tissue
    assert "youngs_modulus=5000.0" in repr(tissue) and "kinematics='green'" in repr(tissue)


def test_words_are_those_of_scenes():
    """A word that the binding knows, a scene knows too, and it means the same."""
    words = {
        "kinematics": ("small", "corotational", "green"),
        "measure": ("equivalent_shear_strain", "one_minus_q", "regular_mean_ratio", "radius_ratio", "solid_angle"),
        "viscous_tensor": ("shear", "deviatoric", "proportional"),
        "law_form": ("secant", "energy"),
        "maxwell_part": ("deviator", "all"),
        "volume_change": ("element", "average_nodal"),
    }
    for field, known in words.items():
        for word in known:
            assert getattr(glisson.tissue_from({field: word}), field) == word
        with pytest.raises(TypeError, match="Literal"):
            setattr(glisson.Tissue(), field, "no such word")
    for word in ("central_difference", "semi_implicit", "implicit", "quasi_static"):
        scene = glisson.parse_scene({"mesh": {"kind": "box"}, "motion": {"integrator": word, "max_steps": 1}})
        assert scene.variants[0].simulation.integrator == word
    assert glisson.Tissue(volume_change="nodal").volume_change == "average_nodal"
    assert glisson.SimulationOptions(integrator="static").integrator == "quasi_static"


def test_lame():
    """λ = E ν / ((1+ν)(1−2ν)) and μ = E / (2(1+ν)), of a tissue and of two numbers."""
    e, nu = 3600.0, 0.4
    expected = (e * nu / ((1 + nu) * (1 - 2 * nu)), e / (2 * (1 + nu)))
    assert glisson.lame_from_young(e, nu) == pytest.approx(expected, rel=1e-14)
    tissue = glisson.Tissue(youngs_modulus=e, poisson_ratio=nu, law=glisson.LinearLaw(slope=e))
    assert tissue.lame() == pytest.approx(expected, rel=1e-14)
    assert tissue.lame_at(1.0) == pytest.approx(tuple(2 * x for x in expected), rel=1e-12)
    assert tissue.is_tensor_mass()


def test_laws_are_evaluated():
    """A law gives numbers for numbers and arrays for arrays, and its derivative is that of its value."""
    x = np.linspace(0, 0.4, 9).reshape(3, 3)
    laws = [
        glisson.ConstantLaw(),
        glisson.StepLaw(threshold=0.2, above=7200, width=0.1),
        glisson.LinearLaw(slope=2e4),
        glisson.PolynomialLaw(coefficients=[1e3, 2e4]),
        glisson.ExponentialLaw(amplitude=500, rate=6),
        glisson.TableLaw(arguments=[0, 0.5], moduli=[3600, 9000]),
    ]
    for law in laws:
        value = glisson.law_value(law, 3600, x)
        assert value.shape == x.shape and value[1, 1] == glisson.law_value(law, 3600, float(x[1, 1]))
        middle, h = 0.2125, 1e-6
        slope = (glisson.law_value(law, 3600, middle + h) - glisson.law_value(law, 3600, middle - h)) / (2 * h)
        # central differences: h² of the third derivative and 1e-16/h of rounding, both below 1e-6 relative here
        assert glisson.law_derivative(law, 3600, middle) == pytest.approx(slope, rel=1e-5, abs=1e-4)


def test_hyperelastic_laws():
    """Every law of large deformation goes into a tissue and has its moduli at rest."""
    laws = {
        1000: glisson.NeoHookean(mu=1000, bulk_modulus=5e4),
        1200: glisson.MooneyRivlin(c10=400, c01=200, bulk_modulus=5e4),
        800: glisson.Yeoh(c1=400, bulk_modulus=5e4),
        700: glisson.Fung(mu=700, b=2, bulk_modulus=5e4),
        900: glisson.Ogden(mu=[500, 400], alpha=[2, -2], bulk_modulus=5e4),
        1100: glisson.Gent(mu=1100, limit=2, bulk_modulus=5e4),
        1300: glisson.Invariants(c10=200, c01=150, a1=400, a2=200, bulk_modulus=5e4),
    }
    for mu, law in laws.items():
        glisson.Tissue(hyperelastic=law).check()
        assert glisson.shear_modulus(law) == pytest.approx(mu) and glisson.bulk_modulus(law) == 5e4
    assert glisson.VerondaWestmann.name == "veronda_westmann"


def test_law_in_python_is_that_law():
    """A law written in Python and the engine's own of the same formula give the same force."""
    forces = []
    for law in (glisson.LinearLaw(slope=2e4), glisson.tabulated(lambda s: 3600 + 2e4 * s)):
        body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue(law=law))
        body.fix("z_min")
        tool = body.drive([207, 211, 212], glisson.PressMotion(depth=0.005))
        body.advance(0.2)
        forces.append(body.force(tool).total[2])
    assert forces[0] == pytest.approx(forces[1], rel=1e-4)  # elements are in float, and tables in their own order


def test_wrong_tissues_are_refused():
    """The message has field, value and range."""
    with pytest.raises(ValueError, match=r"poisson.*0\.6"):
        glisson.Tissue(poisson_ratio=0.6).check()


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: glisson.Tissue(young_modulus=1), r"Tissue: unknown field 'young_modulus': did you mean 'youngs_modulus'\?"),
        (lambda: glisson.Tissue(Density=1), r"unknown field 'Density': did you mean 'density'\?"),
        (lambda: glisson.LinearLaw(slop=1), r"LinearLaw: unknown field 'slop': did you mean 'slope'\?"),
        (lambda: glisson.PressMotion(velocty=1), r"PressMotion: unknown field 'velocty': did you mean 'velocity'\?"),
        (lambda: glisson.SimulationOptions(integrater="implicit"), r"unknown field 'integrater': did you mean 'integrator'\?"),
        (lambda: glisson.NeedleOptions(dimeter=1), r"NeedleOptions: unknown field 'dimeter': did you mean 'diameter'\?"),
        (lambda: glisson.box_mesh(cell=[1, 1, 1]), r"BoxOptions: unknown field 'cell': did you mean 'cells'\?"),
        (lambda: glisson.Tissue(colour=1), r"Tissue: unknown field 'colour'; there are .*youngs_modulus"),
    ],
)
def test_unknown_fields_are_answered_with_the_nearest(make, message):
    """Every class of options answers a misspelt field as a scene does a misspelt key."""
    with pytest.raises(TypeError, match=message):
        make()


def test_presets_have_sources():
    """Presets are found by name, name their source, and a wrong name is answered with the nearest."""
    for preset in glisson.tissue_presets():
        assert preset.source and preset.validity and glisson.tissue_preset(preset.name).tissue == preset.tissue
        assert glisson.tissue_from(preset.toml).youngs_modulus == preset.tissue.youngs_modulus
    name = glisson.tissue_presets()[0].name
    with pytest.raises(ValueError, match=f'did you mean "{name}"'):
        glisson.tissue_preset(name + "x")


def test_branches_and_fibres():
    """Lists of branches and fibres are taken as they are given."""
    tissue = glisson.Tissue(maxwell=[glisson.MaxwellBranch(share=0.3, time=2)], fibres=glisson.Fibres(stiffness=1e3))
    assert tissue.maxwell[0].time == 2 and tissue.fibres.direction.tolist() == [0, 0, 1]


def test_material_point_is_the_closed_form():
    """Simple shear of neo-Hooke is μ γ, and its stress leads back to the shear."""
    law = glisson.NeoHookean(mu=1000, bulk_modulus=1e5)
    tissue, amount, times = glisson.Tissue(hyperelastic=law), np.linspace(0.1, 1, 10), np.arange(1, 11)
    curve = glisson.material_test(tissue, "simple_shear", times, stretch=amount)
    np.testing.assert_allclose(curve.nominal[:, 0, 2], 1000 * amount, rtol=1e-10)
    np.testing.assert_allclose(curve.time, times)
    back = glisson.material_test(tissue, "simple_shear", times, stress=curve.nominal[:, 0, 2])
    np.testing.assert_allclose(back.deformation[:, 0, 2], amount, rtol=1e-10)


def test_material_point_step_by_step():
    """A point keeps its history: held at a stretch, its branches relax."""
    tissue = glisson.Tissue(maxwell=[glisson.MaxwellBranch(share=0.5, time=1)], maxwell_part="all")
    point = glisson.MaterialPoint(tissue)
    free = {"xx": 0, "yy": 0}
    first = point.advance(1e-6, {"zz": 1.1}, stress=free).nominal[2, 2]
    last = point.advance(100, {"zz": 1.1}, stress=free)
    assert first == pytest.approx(360, rel=1e-5) and last.nominal[2, 2] == pytest.approx(180, rel=1e-5)
    assert last.converged and last.deformation[0, 0] == pytest.approx(0.96)


def test_time_of_a_branch_follows_the_deformation():
    """A held shear relaxes by the time at its own measure, and the laws are those of scenes."""
    law = glisson.PowerTime(exponent=2, reference=0.1)
    np.testing.assert_allclose(glisson.time_factor(law, [0.05, 0.2]), [0.25, 4], rtol=1e-12)
    assert glisson.time_factor(glisson.ExponentialTime(rate=3, most=2), 1.0) == 2
    branch = glisson.MaxwellBranch(share=0.5, time=1, time_law=law)
    neo_hooke = glisson.NeoHookean(mu=1000, bulk_modulus=1e5)
    tissue = glisson.Tissue(hyperelastic=neo_hooke, maxwell=[branch])
    held = glisson.material_test(tissue, "simple_shear", [1e-6, 1], stretch=[0.2, 0.2], between=2000).nominal[:, 0, 2]
    s = np.sqrt(1.5 * (1 - 3 / (3 + 0.2**2)))  # the measure of a shear of 0.2
    np.testing.assert_allclose(held[1] / held[0], 0.5 + 0.5 * np.exp(-((0.1 / s) ** 2)), rtol=1e-4)
    assert glisson.tissue_from({"maxwell": [{"share": 0.5, "time_s": 1, "time_law": {"kind": "power", "exponent": 2}}]}).maxwell == [
        branch
    ]
    with pytest.raises(ValueError, match="reference"):
        glisson.Tissue(maxwell=[glisson.MaxwellBranch(share=0.5, time_law=glisson.PowerTime(reference=0))]).check()


def test_oscillation_is_the_generalised_maxwell_body():
    """G* = μ (1 − Σ g/(1 + iωτ)) over frequency; a stretched neo-Hooke is stiffer by λ²."""
    tissue = glisson.Tissue(youngs_modulus=2800, maxwell=[glisson.MaxwellBranch(share=0.4, time=0.5)])
    frequencies = np.logspace(-2, 2, 9)
    exact = 1000 * (1 - 0.4 / (1 + 2j * np.pi * frequencies * 0.5))
    np.testing.assert_allclose(glisson.oscillation(tissue, frequencies), exact, rtol=1e-8)
    neo_hooke = glisson.Tissue(hyperelastic=glisson.NeoHookean(mu=1000, bulk_modulus=1e11))
    assert glisson.oscillation(neo_hooke, 1, stretch=1.2)[0] == pytest.approx(1440, rel=1e-6)
    assert glisson.oscillation(neo_hooke, [1], mode="uniaxial")[0] == pytest.approx(3000, rel=1e-6)
    with pytest.raises(ValueError, match="frequency 1 = -1 Hz"):
        glisson.oscillation(tissue, [-1])


def test_torsion_is_rivlins():
    """Torque and normal force of neo-Hooke in closed form; a cylinder that is held relaxes."""
    mu, radius, twist = 1000.0, 0.01, np.array([20.0, 40.0])
    tissue = glisson.Tissue(hyperelastic=glisson.NeoHookean(mu=mu, bulk_modulus=1e8))
    curve = glisson.torsion(tissue, radius, [1, 2], twist)
    np.testing.assert_allclose(curve.torque, np.pi / 2 * mu * twist * radius**4, rtol=1e-6)
    np.testing.assert_allclose(curve.axial_force, -np.pi / 4 * mu * twist**2 * radius**4, rtol=1e-6)
    assert curve.twist.tolist() == twist.tolist() and curve.time.tolist() == [1, 2]
    tissue.maxwell = [glisson.MaxwellBranch(share=0.5, time=1)]
    held = glisson.torsion(tissue, radius, [0, 100], [20, 20])
    assert held.torque[1] / held.torque[0] == pytest.approx(0.5, rel=1e-2)
    with pytest.raises(ValueError, match="radius = 0 m"):
        glisson.torsion(tissue, 0, [1], [1])


def test_material_point_refuses_bad_input():
    """Bad input is refused by name; a stress that nothing carries warns and keeps what was computed."""
    point = glisson.MaterialPoint(glisson.Tissue())
    with pytest.raises(ValueError, match='"zw" is no component'):
        point.advance(1.0, {"zw": 1.0})
    with pytest.raises(ValueError, match="give one of the two"):
        glisson.material_test(glisson.Tissue(), "uniaxial", [1])
    with pytest.raises(ValueError, match="time 2"):
        glisson.material_test(glisson.Tissue(), "uniaxial", [1, 0.5], stretch=[1.1, 1.2])
    with pytest.warns(RuntimeWarning, match="no deformation carries"):
        curve = glisson.material_test(glisson.Tissue(kinematics="green"), "uniaxial", [1, 2], stress=[-500, -1200])
    assert curve.time.tolist() == [1.0]
