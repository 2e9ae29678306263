"""Scenes come from files, text and dicts, with the program's own messages, and their runs have its bytes."""

import subprocess
from pathlib import Path

import glisson
import numpy as np
import pytest

SMALL = {
    "mesh": {"kind": "box", "cells": [2, 2, 3], "size_m": np.array([0.02, 0.02, 0.03])},
    "tissue": {"youngs_modulus_Pa": 3000, "viscosity_Pa_s": 20.0},
    "motion": {"duration_s": 0.2},
    "sets": {"press": {"side": {"axis": "z", "end": "max"}}},
    "fixed": [{"set": "z_min"}],
    "tool": [{"set": "z_max", "velocity_mm_s": 10, "depth_mm": 2}],
    "output": {"frames": 3},
    "variant": [{"name": "soft"}, {"name": "hard", "tissue": {"youngs_modulus_Pa": 9000}}],
}
SMALL.pop("sets")


def program_csv(program, scene, out, *options):
    done = subprocess.run(
        [program, "run", scene, "--out", out, "--quiet", *options], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return {file.relative_to(out).as_posix(): file.read_text() for file in out.glob("*/forces*.csv")}


@pytest.mark.parametrize(
    ("name", "options", "overrides"),
    [
        ("paper/figure2.toml", [], {"motion.duration_s": 0.3}),
        ("needle/withdrawal.toml", ["--variant", "dry"], {"motion.duration_s": 0.4}),
        ("fit/liver_container.toml", [], {"motion.duration_s": 0.2}),
        ("tissue/relaxation.toml", [], {"motion.max_steps": 200}),
    ],
)
def test_runs_have_the_bytes_of_the_program(program, scenes, tmp_path, name, options, overrides):
    """forces.csv of a run in Python is that of `glisson run`, byte for byte, further files with it."""
    sets = [word for key, value in overrides.items() for word in ("--set", f"{key}={value}")]
    expected = program_csv(program, scenes / name, tmp_path / "program", *options, *sets)
    variants = options[1:] or None
    glisson.run(scenes / name, variants=variants, overrides=overrides, out=tmp_path / "python")
    found = {f.relative_to(tmp_path / "python").as_posix(): f.read_text() for f in tmp_path.glob("python/*/forces*.csv")}
    assert found == expected and len(found) > 0


def test_a_dict_is_the_scene_it_says(program, tmp_path):
    """A dict, its TOML text, and the file of that text are one scene, and the program runs it to the same bytes."""
    text = glisson.to_toml(SMALL)
    (tmp_path / "small.toml").write_text(text, encoding="utf-8")
    runs = [glisson.run(given) for given in (SMALL, text, tmp_path / "small.toml")]
    tables = [{name: result.forces.to_csv() for name, result in run.items()} for run in runs]
    assert tables[0] == tables[1] == tables[2] and list(tables[0]) == ["soft", "hard"]
    expected = program_csv(program, tmp_path / "small.toml", tmp_path / "out")
    assert {f"{name}/forces.csv": csv for name, csv in tables[0].items()} == expected


def test_results_hold_columns_events_frames_and_summary(scenes):
    """A result has every column as an array, the frames that were asked for, and the program's summary."""
    result = glisson.run(SMALL, variants=["hard"], frames=True)["hard"]
    assert result.end == "finished" and result.trouble == "" and result.name == result.label == "hard"
    table = result.forces
    assert table.array.shape == (len(table), len(result.columns)) and "force_N" in table and "none" not in table
    assert np.array_equal(result["force_N"], table.array[:, result.columns.index("force_N")])
    assert set(table.to_dict()) == set(result.columns) and result.variant.name == "hard"
    assert len(result.frames) == 3 and result.frames[0][0] == 0 and not result.frames[0][1].any()
    assert result.summary["peak_force_N"] == pytest.approx(np.abs(result["force_N"]).max())
    assert result.events == [] and result.further == {}
    with pytest.raises(KeyError, match='no column "force"; there are: time_s'):
        result["force"]
    needle = glisson.run(scenes / "needle" / "withdrawal.toml", variants=["dry"], overrides={"motion.duration_s": 0.6})
    assert [event["event"] for event in needle["dry"].events][:2] == ["contact", "puncture"]


def test_a_run_that_stops_early_warns():
    """A run whose step is refused keeps what it has, and a warning names the variant, why it stopped, and what to do."""
    scene = {
        "mesh": {"kind": "box", "cells": [2, 2, 2]},
        "tissue": {"youngs_modulus_Pa": 3600},
        "load": [{"set": "z_max", "force_N": [0, 0, 1]}],
        "motion": {"integrator": "static", "duration_s": 0.1},
    }
    with pytest.warns(RuntimeWarning, match="main: stopped at 0 s: .*Hold at least three"):
        runs = glisson.run(scene)
    assert runs["main"].end == "stopped_not_held"


def test_messages_are_those_of_the_program(program, tmp_path):
    """SceneError has every line that `glisson check` prints: place, key, what is wrong, the way out."""
    file = tmp_path / "wrong.toml"
    file.write_text("[tissue]\nyoungs_modulus_Pa = -1\npoison_ratio = 0.4\n", encoding="utf-8")
    with pytest.raises(glisson.SceneError) as caught:
        glisson.load_scene(file)
    printed = subprocess.run([program, "check", file], capture_output=True, text=True, check=False).stderr
    for line in str(caught.value).splitlines():
        assert line in printed
    assert "wrong.toml:2" in printed and isinstance(caught.value, ValueError)
    with pytest.raises(glisson.SceneError, match="--set tissue.poisson"):
        glisson.parse_scene(SMALL, overrides={"tissue.poisson": 0.3})


def test_advice_is_that_of_the_program(program, tmp_path):
    """glisson.check has every text that `glisson check` prints, by variant and rule; what mends a tissue ends its warning."""
    locking = SMALL | {"tissue": {"poisson_ratio": 0.49, "law": {"kind": "step", "threshold": 0.2, "above_Pa": 6000}}}
    (tmp_path / "s.toml").write_text(glisson.to_toml(locking), encoding="utf-8")
    printed = subprocess.run([program, "check", tmp_path / "s.toml"], capture_output=True, text=True, check=True).stdout
    words = " ".join(printed.split())
    advice = glisson.check(locking)
    assert all(" ".join(one.text.split()) in words for one in advice)
    found = [(one.variant, one.rule, one.kind, one.about) for one in advice]
    for name in ("soft", "hard"):
        assert (name, "locking", "warning", "tissue") in found and (name, "coarse", "warning", "tool") in found
    assert found[-1] == ("", "cycle_work", "remark", "scene") and advice[-1].name == ""
    assert {one.variant for one in glisson.check(locking, "soft")} == {"soft", ""}
    mended = glisson.check(locking, "hard", overrides={"tissue.volume_change": "average_nodal"})
    assert "locking" not in [one.rule for one in mended] and "text='" in repr(mended[0])
    with pytest.raises(KeyError, match='no variant "hart"'):
        glisson.check(locking, "hart")


def test_variants_are_changed_before_a_run():
    """Tissue, duration and options of a variant may be set; the scene keeps them."""
    scene = glisson.parse_scene(SMALL)
    variant = scene["soft"]
    variant.tissue.youngs_modulus = 9000
    variant.duration = 0.1
    assert scene.variants[0].tissue.youngs_modulus == 9000 and len(scene) == 2
    changed, hard = glisson.run(scene).values()
    assert np.array_equal(changed["force_N"][:40], hard["force_N"][:40]) and changed["time_s"][-1] < 0.11
    assert variant.run_duration() == 0.1 and variant.tools == ["tool"] and variant.instruments == []
    with pytest.raises(KeyError, match='no variant "hart"; there are: soft, hard'):
        scene["hart"]
    with pytest.raises(ValueError, match="overrides"):
        glisson.run(scene, overrides={"tissue.poisson_ratio": 0.3})


def test_a_mesh_from_memory_takes_the_place_of_the_scenes():
    """A scene runs on a mesh that was made in Python, and gives what the same mesh gives as its own."""
    mesh = glisson.box_mesh(cells=[2, 2, 3], size=[0.02, 0.02, 0.03])
    own = glisson.run(SMALL)["soft"].forces.to_csv()
    assert glisson.run(SMALL, mesh=mesh)["soft"].forces.to_csv() == own
    assert glisson.parse_scene(SMALL)["soft"].build_mesh().tets.shape == mesh.tets.shape


def test_scenes_read_mesh_files_by_python(tmp_path):
    """A scene's mesh file is read, and where there is none the file is named."""
    glisson.write_vtu(tmp_path / "box.vtu", glisson.box_mesh(cells=[2, 2, 3], size=[0.02, 0.02, 0.03]))
    scene = SMALL | {"mesh": {"kind": "file", "path": str(tmp_path / "box.vtu")}}
    assert glisson.run(scene)["hard"].forces.to_csv() == glisson.run(SMALL)["hard"].forces.to_csv()
    with pytest.raises(RuntimeError, match=r"none\.vtu"):
        glisson.run(SMALL | {"mesh": {"kind": "file", "path": str(tmp_path / "none.vtu")}})


def test_a_variant_is_stepped_by_hand():
    """A simulation from a scene has the scene's supports and tools by name, and the forces of its run."""
    body = glisson.simulation(SMALL, "hard")
    body.advance(0.1)
    run = glisson.run(SMALL, variants=["hard"])["hard"]
    nearest = np.argmin(np.abs(run["time_s"] - body.force_time))
    # neighbouring samples differ by 2 ms of a steady press: 1 % of the force at 0.1 s
    assert -body.instruments["tool"].force[2] == pytest.approx(run["force_N"][nearest], rel=0.03)
    tool = body.instruments["tool"]
    assert list(tool.columns) == run.columns[1:12]
    assert tool.columns["force_N"] == -tool.force[2] and tool.form["kind"] == "none"
    assert body.container is None and body.capsules == [] and list(body.instruments) == ["tool"]


def test_watchers_are_called_and_end_runs():
    """on_sample sees every line of every variant; what it raises ends all of them."""
    seen = []
    results = glisson.run(SMALL, threads=2, on_sample=lambda name, row: seen.append((name, row["force_N"])))
    for name, result in results.items():
        assert [force for who, force in seen if who == name] == result["force_N"].tolist()

    def refuse(name, row):
        raise OverflowError("that is all")

    for threads in (1, 2):
        with pytest.raises(OverflowError, match="that is all"):
            glisson.run(SMALL, threads=threads, on_sample=refuse)


def test_threads_do_not_change_results():
    """One variant at a time or two: the same bytes."""
    one, two = glisson.run(SMALL, threads=1), glisson.run(SMALL, threads=2)
    assert [r.forces.to_csv() for r in one.values()] == [r.forces.to_csv() for r in two.values()]


def test_a_run_is_stopped_from_outside():
    """A StopFlag ends a run at its next step."""
    flag = glisson.StopFlag()
    flag.stop()
    from glisson._core import run_variant

    assert run_variant(glisson.parse_scene(SMALL)["soft"], stop=flag).end == "interrupted"


def test_toml_of_odd_values():
    """Text, numbers and lists survive the way through TOML; what has no place in a scene is refused."""
    scene = glisson.parse_scene(SMALL | {"title": 'a "quoted"\n\\line\t—', "notes": ("one", "two")})
    assert scene.title == 'a "quoted"\n\\line\t—' and scene.notes == ["one", "two"]
    assert glisson.to_toml({"a b": float("inf"), "c": None, "d": np.float64(0.1), "e": True}) == (
        '"a b" = inf\nd = 0.1\ne = true\n'
    )
    with pytest.raises(TypeError, match="has no place"):
        glisson.to_toml({"a": object()})
    assert "## Sections" in glisson.scene_reference_markdown() and glisson.scenes_folder().is_dir()


def test_versions_agree():
    """The package has the version of the C++ project."""
    project = (Path(__file__).parents[2] / "include/glisson/version.h").read_text(encoding="utf-8")
    assert f'#define GLISSON_VERSION "{glisson.__version__}"' in project
