"""Whole runs of scenes, simulations made from them, and advice before a run."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._core import Advice, RunResult, Scene, Simulation, StopFlag, TetMesh, Variant
from ._folder_lock import alone_in
from .scenes import Overrides, as_scene

if TYPE_CHECKING:
    from concurrent.futures import Future

AnyScene = Scene | Mapping[str, Any] | str | os.PathLike[str]


def run(
    scene: AnyScene,
    *,
    variants: Sequence[str] | None = None,
    overrides: Overrides | None = None,
    mesh: TetMesh | None = None,
    threads: int | None = None,
    on_sample: Callable[[str, dict[str, float]], object] | None = None,
    frames: bool = False,
    out: str | os.PathLike[str] | None = None,
) -> dict[str, RunResult]:
    """Runs the variants of a scene and returns their results by name, in the order of the scene.

    The columns are those of forces.csv, to the last bit. Ctrl-C, or an exception in `on_sample`, ends all runs. A run that
    stops early keeps what it has, and a RuntimeWarning says why it stopped and what to do (`RunResult.trouble`).

    :param scene: a Scene, a dict, TOML text, or a file
    :param mesh: used in place of the scene's
    :param threads: variants in parallel; none: as many as there are cores. Results do not depend on it
    :param on_sample: called with the variant's name and a line of forces.csv at each sample
    :param frames: whether to keep the displacement of every frame
    :param out: folder to write <variant>/forces.csv to, with the bytes that `glisson run` writes
    :raises RuntimeError: where another run or study writes into `out`, inside it or around it; nothing is written then

    >>> import glisson
    >>> curves = glisson.run(glisson.scenes_folder() / "paper" / "figure2.toml", variants=["linear"],
    ...                      overrides={"motion.duration_s": 0.1})
    >>> sorted(curves), curves["linear"].end, f"{curves['linear']['depth_m'][-1]:.3f}"
    (['linear'], 'finished', '0.001')
    """
    chosen = _chosen(as_scene(scene, overrides), variants)
    at_a_time = max(1, min(threads or os.cpu_count() or 1, len(chosen)))
    stop = StopFlag()

    def one(variant: Variant) -> RunResult:
        told = None if on_sample is None else (lambda row, name=variant.name: on_sample(name, row))
        return _core.run_variant(variant, mesh, told, frames, stop)

    results = [one(v) for v in chosen] if at_a_time == 1 else _side_by_side(one, chosen, at_a_time, stop)
    by_name = {result.name: result for result in results}
    for result in results:
        if result.trouble:
            warnings.warn(f"{result.name}: {result.trouble}", RuntimeWarning, stacklevel=2)
    if out is not None:
        with alone_in(out):
            _write(by_name, Path(out))
    return by_name


def check(scene: AnyScene, variant: str | None = None, *, overrides: Overrides | None = None) -> list[Advice]:
    """What `glisson check` says of a scene, as a list.

    Meshes that are too coarse, tissues that lock, paths that miss the body, steps that could be longer: each has the `rule`
    that gives it, its `kind` (a "remark", or a "warning" where results may be wrong), and the `text` with the numbers and
    the way out.

    Variants are built, some several times, without a limit of time; none is run.

    :param variant: its name; none: all of them
    :raises SceneError: where a variant cannot be built

    >>> import glisson
    >>> scene = {"mesh": {"kind": "box"}, "tissue": {"poisson_ratio": 0.49}, "fixed": [{"set": "z_min"}],
    ...          "motion": {"max_steps": 1}}
    >>> [(advice.kind, advice.rule) for advice in glisson.check(scene)]
    [('warning', 'locking')]
    """
    read = as_scene(scene, overrides)
    return _core.check_variants(_chosen(read, None if variant is None else [variant]))


def simulation(
    scene: AnyScene, variant: str | None = None, *, overrides: Overrides | None = None, mesh: TetMesh | None = None
) -> Simulation:
    """The body of a scene's variant with its supports, tools and instruments, at rest, to be stepped by hand.

    :param variant: its name; none: the first

    >>> import glisson
    >>> body = glisson.simulation(glisson.scenes_folder() / "paper" / "figure2.toml", "tissue2")
    >>> sorted(body.constraints), sorted(body.instruments)
    (['z_min'], ['tool'])
    """
    read = as_scene(scene, overrides)
    return Simulation.of_variant(read.variants[0] if variant is None else read[variant], mesh)


def _chosen(scene: Scene, names: Sequence[str] | None) -> list[Variant]:
    return list(scene.variants) if names is None else [scene[name] for name in names]


def _side_by_side(
    one: Callable[[Variant], RunResult], variants: list[Variant], threads: int, stop: StopFlag
) -> list[RunResult]:
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(threads) as pool:
        futures = [pool.submit(one, variant) for variant in variants]
        try:
            _wait_for(futures)
        except BaseException:
            stop.stop()
            for future in futures:
                future.cancel()
            raise
    return [future.result() for future in futures]


def _wait_for(futures: list[Future[RunResult]]) -> None:
    from concurrent.futures import FIRST_COMPLETED, wait

    waiting = set(futures)
    while waiting:
        done, waiting = wait(waiting, timeout=0.1, return_when=FIRST_COMPLETED)
        for future in done:
            future.result()


def _write(results: dict[str, RunResult], folder: Path) -> None:
    for name, result in results.items():
        (folder / name).mkdir(parents=True, exist_ok=True)
        tables = {"forces": result.forces} | {f"forces_{key}": table for key, table in result.further.items()}
        if result.probes.columns:
            tables["probes"] = result.probes
        for file, table in tables.items():
            (folder / name / f"{file}.csv").write_text(table.to_csv(), encoding="utf-8")
