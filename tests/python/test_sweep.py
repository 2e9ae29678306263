"""Parameter studies: every point once, resumed, and through the death of a worker, here and on a Dask cluster."""

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import glisson
import numpy as np
import pyarrow.parquet as pq
import pytest

SCENE = {
    "mesh": {"kind": "box", "cells": [1, 1, 2]},
    "motion": {"duration_s": 0.05},
    "fixed": [{"set": "z_min"}],
    "tool": [{"set": "z_max", "velocity_mm_s": 10, "depth_mm": 1}],
}
POINTS = {"tissue.youngs_modulus_Pa": [2000, 4000, 8000], "tissue.poisson_ratio": [0.3, 0.4]}


def largest(result):
    return {"largest_N": float(np.max(result["force_N"])), "worker": os.getpid()}


def deadly(result):
    """Kills its worker the first time it sees a tissue of 4000 Pa."""
    mark = Path(os.environ["GLISSON_TEST_MARK"])
    if result.variant.tissue.youngs_modulus == 4000 and not mark.exists():
        mark.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return largest(result)


def always_deadly(result):
    if result.variant.tissue.youngs_modulus == 4000:
        os.kill(os.getpid(), signal.SIGKILL)
    return largest(result)


def test_every_point_is_the_run_of_its_own(tmp_path):
    """Rows are the runs of single points, column by column, and the Parquet files hold them."""
    table = glisson.sweep(SCENE, POINTS, tmp_path, workers=2).to_pylist()
    assert len(table) == 6 and len(list(tmp_path.glob("*.parquet"))) == 6
    for row in table:
        point = {key: row[key] for key in POINTS}
        alone = glisson.run(SCENE, overrides=point)["main"]
        assert row["force_N"] == alone["force_N"].tolist() and row["end"] == "finished"
    assert pq.read_table(tmp_path).num_rows == 6


def test_a_study_goes_on_where_it_stopped(tmp_path):
    """Points whose file is there are not run again; new ones are; another measure is another study."""
    first = glisson.sweep(SCENE, [{"tissue.youngs_modulus_Pa": 2000}], tmp_path, measure=largest, workers=1)
    told = []
    both = glisson.sweep(
        SCENE,
        [{"tissue.youngs_modulus_Pa": e} for e in (2000, 5000)],
        tmp_path,
        measure=largest,
        workers=1,
        progress=lambda done, planned: told.append((done, planned)),
    )
    assert told == [(2, 2)] and both.to_pylist()[0] == first.to_pylist()[0]
    assert both["worker"][0] != both["worker"][1]


def test_a_killed_worker_costs_nothing(tmp_path, monkeypatch):
    """A worker that is killed in the middle of its point: all points are there in the end."""
    monkeypatch.setenv("GLISSON_TEST_MARK", str(tmp_path / "mark"))
    table = glisson.sweep(SCENE, POINTS, tmp_path / "out", measure=deadly, workers=3)
    assert (tmp_path / "mark").exists() and table.num_rows == 6
    assert sorted(set(table["tissue.youngs_modulus_Pa"].to_pylist())) == [2000, 4000, 8000]


@contextlib.contextmanager
def held(folder):
    """Another process that writes a run or a study into a folder."""
    code = "import sys; from glisson._folder_lock import alone_in\nwith alone_in(sys.argv[1]): print('held', flush=True); sys.stdin.read()"
    with subprocess.Popen(
        [sys.executable, "-c", code, str(folder)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as other:
        assert other.stdout.readline() == "held\n"
        try:
            yield other.pid
        finally:
            other.kill()


def test_a_second_study_into_one_folder_is_refused(tmp_path):
    """While another process holds the folder, a study and a run into it are refused with nothing changed; then they go on."""
    with held(tmp_path) as process:
        for write in (lambda: glisson.sweep(SCENE, POINTS, tmp_path, workers=1), lambda: glisson.run(SCENE, out=tmp_path)):
            with pytest.raises(RuntimeError, match=f"another run is being written there by process {process}, .* give another folder as `out`"):
                write()
        assert list(tmp_path.iterdir()) == []
    assert glisson.sweep(SCENE, POINTS, tmp_path, workers=1).num_rows == 6


def test_a_study_inside_or_around_another_is_refused(tmp_path):
    """The rule of the program: no run inside the folder of another, nor around it; beside it is free, also where a study has left its rows."""
    study = tmp_path / "study"
    assert glisson.sweep(SCENE, POINTS, study, workers=1).num_rows == 6
    rows = sorted(study.iterdir())
    with held(study) as process:
        with pytest.raises(RuntimeError, match=f"x is inside the folder of another run. {study}: another run is being written there by process {process}"):
            glisson.run(SCENE, out=study / "x")
        assert sorted(study.iterdir()) == rows
        glisson.run(SCENE, out=tmp_path / "beside")
    with held(study / "deep" / "er") as process:
        for write in (lambda: glisson.sweep(SCENE, POINTS, study, workers=1), lambda: glisson.run(SCENE, out=study / "deep")):
            with pytest.raises(RuntimeError, match=f"another run is being written inside it by process {process}"):
                write()
    assert glisson.sweep(SCENE, POINTS, study, workers=1).num_rows == 6


def raising(result):
    return {"largest_N": result["no_such_column"].max()}


def raising_at_4000(result):
    return largest(result) if result.variant.tissue.youngs_modulus != 4000 else {"largest_N": 1 / 0}


def test_a_measure_that_raises_is_tried_on_one_run(tmp_path):
    """The study ends with the measure's error and its line, before a second point is run; a lambda is refused at once."""
    told = []
    with pytest.raises(glisson.SweepError, match=r"the measure raised \w+: .*no_such_column.*test_sweep\.py:\d+") as caught:
        glisson.sweep(SCENE, POINTS, tmp_path, measure=raising, workers=2, progress=lambda *count: told.append(count))
    assert len(caught.value.failures) == 1 and caught.value.left == 5
    assert told == [] and not list(tmp_path.glob("*.parquet"))
    with pytest.raises(ValueError, match="cannot be sent to other processes"):
        glisson.sweep(SCENE, POINTS, tmp_path, measure=lambda result: {}, workers=1)
    with pytest.raises(glisson.SweepError, match="ZeroDivisionError") as some:
        glisson.sweep(SCENE, POINTS, tmp_path, measure=raising_at_4000, workers=1)
    assert len(some.value.failures) == 2 and some.value.left == 0 and len(list(tmp_path.glob("*.parquet"))) == 4


def test_a_study_whose_first_points_fail_stops(tmp_path):
    """A hundred points with a wrong key: three are tried, and the cause is told; once a point has run, all are tried."""
    wrong = {"tissue.youngs_modulus_kPa": list(range(1, 101))}
    with pytest.raises(glisson.SweepError, match="stopped with 97 points left.*\n.*youngs_modulus_kPa") as caught:
        glisson.sweep(SCENE, wrong, tmp_path / "wrong", workers=1)
    assert len(caught.value.failures) == 3 and caught.value.left == 97
    mixed = [{"tissue.poisson_ratio": ratio} for ratio in (0.3, 0.6, 0.7, 0.8, 0.9)]
    with pytest.raises(glisson.SweepError) as all_tried:
        glisson.sweep(SCENE, mixed, tmp_path / "mixed", workers=1)
    assert len(all_tried.value.failures) == 4 and all_tried.value.left == 0
    with pytest.raises(ValueError, match="give_up = 0"):
        glisson.sweep(SCENE, POINTS, tmp_path / "none", give_up=0)


def test_points_that_cannot_be_run_are_named(tmp_path):
    """A wrong value, and a point that kills every worker, are told at the end; the others are written."""
    with pytest.raises(glisson.SweepError, match="poisson_ratio") as caught:
        glisson.sweep(SCENE, {"tissue.poisson_ratio": [0.3, 0.7]}, tmp_path / "wrong", workers=1)
    assert [point for point, _ in caught.value.failures] == [{"tissue.poisson_ratio": 0.7}]
    assert len(list((tmp_path / "wrong").glob("*.parquet"))) == 1
    with pytest.raises(glisson.SweepError, match="lost 2 times"):
        glisson.sweep(SCENE, POINTS, tmp_path / "deadly", measure=always_deadly, workers=1, attempts=2)
    assert len(list((tmp_path / "deadly").glob("*.parquet"))) == 4


def test_a_dask_cluster_of_processes(tmp_path, monkeypatch):
    """The same call on a cluster of three processes, one of which is killed: the same rows."""
    distributed = pytest.importorskip("distributed")
    monkeypatch.setenv("GLISSON_TEST_MARK", str(tmp_path / "mark"))
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(Path(__file__).parent), os.environ.get("PYTHONPATH", "")]))
    with (
        distributed.LocalCluster(n_workers=3, threads_per_worker=1, processes=True, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        table = glisson.sweep(SCENE, POINTS, tmp_path / "dask", measure=deadly, client=client)
    assert (tmp_path / "mark").exists() and table.num_rows == 6
    here = glisson.sweep(SCENE, POINTS, tmp_path / "here", measure=largest, workers=2)
    assert table["largest_N"].to_pylist() == here["largest_N"].to_pylist()
    assert len(set(table["worker"].to_pylist())) > 1
