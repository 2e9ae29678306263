"""Parameter studies: one scene at many points, on the cores of this machine or on a Dask cluster.

    points ──▶ those whose file is not there yet ──▶ workers, a simulation each ──▶ point-<key>.parquet, written whole

An interrupted study resumes where it stopped, because a point is done when its file exists. The point of a killed
worker is given to another. A study that cannot work ends early: a measure is tried on one run before the others are given
out, and a study whose first points all fail stops with their reason.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import pickle
import traceback
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._folder_lock import alone_in
from ._optional import need
from ._version import VERSION
from .running import run
from .scenes import to_toml

if TYPE_CHECKING:
    from concurrent.futures import Future, ProcessPoolExecutor

Point = dict[str, Any]
Row = dict[str, Any]
Measure = Callable[[_core.RunResult], Mapping[str, Any]]


class SweepError(RuntimeError):
    """Raised for points of a study that could not be run; what was done is written. `failures` has them with the reason.

    `left` says how many points were not tried, because the first ones had failed or the measure had.
    """

    def __init__(self, failures: list[tuple[Point, str]], left: int = 0) -> None:
        self.failures = failures
        self.left = left
        lines = [f"{point}: {reason}" for point, reason in failures[:5]]
        more = f"\n… and {len(failures) - 5} more" if len(failures) > 5 else ""
        stopped = f", and none before them; the study stopped with {left} points left" if left else ""
        count = "1 point" if len(failures) == 1 else f"{len(failures)} points"
        super().__init__(f"{count} could not be run{stopped}:\n" + "\n".join(lines) + more)


class _MeasureError(Exception):
    """What a measure raised, with its place; it goes from a worker to the study as text."""


@dataclass(frozen=True)
class _Task:
    key: str
    scene: str  # a file's path, or TOML text
    point: Point
    variants: tuple[str, ...] | None
    measure: Measure | None


def sweep(
    scene: Mapping[str, Any] | str | os.PathLike[str],
    points: Mapping[str, Sequence[Any]] | Sequence[Mapping[str, Any]],
    out: str | os.PathLike[str],
    *,
    variants: Sequence[str] | None = None,
    measure: Measure | None = None,
    workers: int | None = None,
    client: Any = None,
    attempts: int = 3,
    give_up: int | None = 3,
    progress: Callable[[int, int], object] | None = None,
) -> Any:
    """Runs a scene at every point, and returns all rows, including those of earlier calls, as a pyarrow Table.

    A row is a variant at a point: the values of the point, `variant`, `end`, `trouble`, `steps`, `peak_force_N`, and the
    columns of forces.csv as lists; with `measure` what that gives in place of the columns. Rows lie in `out` as Parquet,
    a file a point; points whose file is there are not run again. A measure counts by its name, a scene by its text.

    Local workers are processes that import the calling script: keep the call under `if __name__ == "__main__":`.

    A measure is tried on one run first: where it raises, nothing else is run.

    :param scene: a file, TOML text (with a line end) or a dict
    :param points: values by dotted key, of which all combinations are run; or a list of points
    :param out: folder
    :param measure: makes numbers of a result; a function of a module or script, so that workers can import it
    :param workers: processes on this machine; none: as many as there are cores
    :param client: a `distributed.Client`: its cluster runs the points then; files of the scene must be there
    :param attempts: how often a point is tried whose worker was lost
    :param give_up: stops where so many points have failed and none was run before; none: all points are tried
    :param progress: called with points done and planned
    :raises SweepError: naming the points that could not be run, with the reasons: after all others are done, or at once where
        the measure or the first points failed
    :raises ValueError: for a measure that processes cannot import
    :raises RuntimeError: where another run or study writes into the folder, inside it or around it; nothing is changed then
    """
    parquet = need("pyarrow.parquet", "pyarrow", "sweep")
    if give_up is not None and give_up < 1:
        raise ValueError(f"give_up = {give_up} is outside the allowed range, from 1 on; None tries all points")
    if client is None and measure is not None:
        _require_importable(measure)
    tasks = _tasks(scene, points, variants, measure)
    folder = Path(out)
    with alone_in(folder):
        return _sweep(parquet, folder, tasks, workers, client, attempts, give_up, progress)


def _sweep(
    parquet: Any,
    folder: Path,
    tasks: list[_Task],
    workers: int | None,
    client: Any,
    attempts: int,
    give_up: int | None,
    progress: Callable[[int, int], object] | None,
) -> Any:
    open_tasks = [task for task in tasks if not _file_of(folder, task.key).exists()]
    done = len(tasks) - len(open_tasks)
    failures: list[tuple[Point, str]] = []
    written = done
    for task, rows in _measured_first(open_tasks, workers, client, attempts):
        if isinstance(rows, str):
            failures.append((task.point, rows))
        else:
            _write(parquet, rows, _file_of(folder, task.key))
            written += 1
        done += 1
        if progress is not None:
            progress(done, len(tasks))
        if written == 0 and give_up is not None and len(failures) >= give_up:
            break
    if failures:
        raise SweepError(failures, len(tasks) - done)
    arrow = need("pyarrow", "pyarrow", "sweep")
    tables = [parquet.read_table(_file_of(folder, task.key)) for task in tasks]
    return arrow.concat_tables(tables, promote_options="default") if tables else arrow.table({})


def _tasks(scene: Any, points: Any, variants: Sequence[str] | None, measure: Measure | None) -> list[_Task]:
    if isinstance(points, Mapping):
        keys = list(points)
        listed = [dict(zip(keys, values, strict=True)) for values in itertools.product(*points.values())]
    else:
        listed = [dict(point) for point in points]
    text = to_toml(scene) if isinstance(scene, Mapping) else os.fspath(scene)
    content = text if "\n" in text else Path(text).read_text(encoding="utf-8")
    where = text if "\n" in text else str(Path(text).resolve())
    chosen = tuple(variants) if variants is not None else None
    called = f"{measure.__module__}.{measure.__qualname__}" if measure else ""
    tasks = []
    for point in listed:
        what = json.dumps([content, to_toml(point), chosen, called, VERSION])
        tasks.append(_Task(hashlib.sha256(what.encode()).hexdigest()[:16], where, point, chosen, measure))
    return tasks


def _require_importable(measure: Measure) -> None:
    """Complains of a measure that a process of its own cannot find by its name."""
    try:
        pickle.dumps(measure)
    except Exception as error:
        name = getattr(measure, "__qualname__", repr(measure))
        raise ValueError(
            f"measure {name} cannot be sent to other processes ({error}); make it a function at the top level of a module "
            "or script (no lambda, no function within another)"
        ) from None


def _measured(measure: Measure, result: _core.RunResult) -> Row:
    """What a measure makes of a run; its error as text, since the worker's own may not be sent."""
    try:
        return dict(measure(result))
    except Exception as error:
        frames = traceback.extract_tb(error.__traceback__)
        code = getattr(measure, "__code__", None)
        own = [frame for frame in frames if code is not None and frame.filename == code.co_filename]
        place = (own or list(frames))[-1]
        where = f"{place.filename}:{place.lineno}: {place.line}"
        raise _MeasureError(f"the measure raised {type(error).__name__}: {error} ({where})") from None


def _work(task: _Task) -> list[Row]:
    """What a worker does with a point."""
    results = run(task.scene, variants=task.variants, overrides=task.point, threads=1)
    rows = []
    for name, result in results.items():
        summary = result.summary
        row: Row = {key: _plain(value) for key, value in task.point.items()}
        row |= {"variant": name, "end": result.end, "trouble": result.trouble}
        row |= {"steps": summary["steps"], "peak_force_N": summary["peak_force_N"]}
        row |= _measured(task.measure, result) if task.measure else result.forces.to_dict()
        rows.append(row)
    return rows


def _plain(value: Any) -> Any:
    """A value as a column can hold it: tables as their text."""
    return to_toml(value) if isinstance(value, Mapping) else value


Finished = Iterator[tuple[_Task, list[Row] | str]]


def _measured_first(tasks: list[_Task], workers: int | None, client: Any, attempts: int) -> Finished:
    """Runs tasks; those that are measured one by one until a measure has worked. One that raises ends the study."""

    def run_all(some: list[_Task]) -> Finished:
        return _on_cluster(some, client, attempts) if client is not None else _here(some, workers, attempts)

    left = list(tasks)
    tried = not left or left[0].measure is None
    while left and not tried:
        first = left.pop(0)
        for task, rows in run_all([first]):
            if isinstance(rows, str) and rows.startswith(_MeasureError.__name__):
                raise SweepError([(task.point, rows.removeprefix(f"{_MeasureError.__name__}: "))], len(left))
            tried = not isinstance(rows, str)
            yield task, rows
    yield from run_all(left)


_GUARD = "the call of sweep is not under `if __name__ == \"__main__\":`, and the worker could not import the script"


def _here(tasks: list[_Task], workers: int | None, attempts: int) -> Finished:
    """Runs tasks in processes. One that is killed breaks the pool: what was under way goes to a new one."""
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    tried = dict.fromkeys((task.key for task in tasks), 0)
    left = list(tasks)
    count = workers or os.cpu_count() or 1
    while left:
        lost: list[_Task] = []
        rest: list[_Task] = []
        pool = ProcessPoolExecutor(min(count, len(left)), mp_context=multiprocessing.get_context("spawn"))
        try:
            yield from _through(pool, left, count, lost, rest)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
        left = rest
        for task in lost:
            tried[task.key] += 1
            if tried[task.key] < attempts:
                left.append(task)
            else:
                yield task, f"its worker was lost {attempts} times: killed, or short of memory, or {_GUARD}"


def _through(
    pool: ProcessPoolExecutor, tasks: list[_Task], count: int, lost: list[_Task], rest: list[_Task]
) -> Finished:
    """Hands out tasks, no more at a time than there are workers, so that few are `lost` with a broken pool."""
    from concurrent.futures import FIRST_COMPLETED, wait
    from concurrent.futures.process import BrokenProcessPool

    waiting: dict[Future[list[Row]], _Task] = {}
    ahead = iter(tasks)
    broken = False
    while True:
        while not broken and len(waiting) < count and (task := next(ahead, None)) is not None:
            try:
                waiting[pool.submit(_work, task)] = task
            except BrokenProcessPool:
                lost.append(task)
                broken = True
        if not waiting:
            break
        for future in wait(waiting, return_when=FIRST_COMPLETED).done:
            task = waiting.pop(future)
            try:
                yield task, future.result()
            except BrokenProcessPool:
                lost.append(task)
                broken = True
            except Exception as error:  # the point's own fault: told, and the study goes on
                yield task, f"{type(error).__name__}: {error}"
    rest.extend(ahead)


def _on_cluster(tasks: list[_Task], client: Any, attempts: int) -> Finished:
    """Runs tasks on a Dask cluster, which gives those of a lost worker to another by itself."""
    distributed = need("distributed", "distributed", "cluster")
    futures = {client.submit(_work, task, key=f"glisson-{task.key}", retries=attempts - 1): task for task in tasks}
    try:
        for future in distributed.as_completed(list(futures)):
            task = futures[future]
            try:
                rows: list[Row] | str = future.result()
            except Exception as error:
                rows = f"{type(error).__name__}: {error}"
            yield task, rows
    finally:  # a study that stops early leaves no work behind
        client.cancel(list(futures))


def _file_of(folder: Path, key: str) -> Path:
    return folder / f"point-{key}.parquet"


def _write(parquet: Any, rows: list[Row], file: Path) -> None:
    """Writes a point in one move, so that a file that is there is whole."""
    arrow = need("pyarrow", "pyarrow", "sweep")
    part = file.with_suffix(".part")
    parquet.write_table(arrow.Table.from_pylist(rows), part)
    part.replace(file)
