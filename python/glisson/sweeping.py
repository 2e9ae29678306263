"""Parameter studies: one scene at many points, on the cores of this machine or on a Dask cluster.

    points ──▶ those whose file is not there yet ──▶ workers, a simulation each ──▶ point-<key>.parquet, written whole

An interrupted study resumes where it stopped, because a point is done when its file exists. The point of a killed
worker is given to another.
"""

from __future__ import annotations

import hashlib
import itertools
import json
import os
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
    """Raised for points of a study that could not be run; the others are written. `failures` has them with the reason."""

    def __init__(self, failures: list[tuple[Point, str]]) -> None:
        self.failures = failures
        lines = [f"{point}: {reason}" for point, reason in failures[:5]]
        more = f"\n… and {len(failures) - 5} more" if len(failures) > 5 else ""
        super().__init__(f"{len(failures)} points could not be run:\n" + "\n".join(lines) + more)


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
    progress: Callable[[int, int], object] | None = None,
) -> Any:
    """Runs a scene at every point, and returns all rows, including those of earlier calls, as a pyarrow Table.

    A row is a variant at a point: the values of the point, `variant`, `end`, `trouble`, `steps`, `peak_force_N`, and the
    columns of forces.csv as lists; with `measure` what that gives in place of the columns. Rows lie in `out` as Parquet,
    a file a point; points whose file is there are not run again. A measure counts by its name, a scene by its text.

    Local workers are processes that import the calling script: keep the call under `if __name__ == "__main__":`.

    :param scene: a file, TOML text (with a line end) or a dict
    :param points: values by dotted key, of which all combinations are run; or a list of points
    :param out: folder
    :param measure: makes numbers of a result; a function of a module or script, so that workers can import it
    :param workers: processes on this machine; none: as many as there are cores
    :param client: a `distributed.Client`: its cluster runs the points then; files of the scene must be there
    :param attempts: how often a point is tried whose worker was lost
    :param progress: called with points done and planned
    :raises SweepError: after all other points are done, naming those that could not be run
    :raises RuntimeError: where another study writes into the folder; nothing is changed then
    """
    parquet = need("pyarrow.parquet", "pyarrow", "sweep")
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    with alone_in(folder):
        return _sweep(parquet, folder, _tasks(scene, points, variants, measure), workers, client, attempts, progress)


def _sweep(
    parquet: Any,
    folder: Path,
    tasks: list[_Task],
    workers: int | None,
    client: Any,
    attempts: int,
    progress: Callable[[int, int], object] | None,
) -> Any:
    open_tasks = [task for task in tasks if not _file_of(folder, task.key).exists()]
    done = len(tasks) - len(open_tasks)
    failures: list[tuple[Point, str]] = []
    finished = _on_cluster(open_tasks, client, attempts) if client is not None else _here(open_tasks, workers, attempts)
    for task, rows in finished:
        if isinstance(rows, str):
            failures.append((task.point, rows))
        else:
            _write(parquet, rows, _file_of(folder, task.key))
        done += 1
        if progress is not None:
            progress(done, len(tasks))
    if failures:
        raise SweepError(failures)
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


def _work(task: _Task) -> list[Row]:
    """What a worker does with a point."""
    results = run(task.scene, variants=task.variants, overrides=task.point, threads=1)
    rows = []
    for name, result in results.items():
        summary = result.summary
        row: Row = {key: _plain(value) for key, value in task.point.items()}
        row |= {"variant": name, "end": result.end, "trouble": result.trouble}
        row |= {"steps": summary["steps"], "peak_force_N": summary["peak_force_N"]}
        row |= dict(task.measure(result)) if task.measure else result.forces.to_dict()
        rows.append(row)
    return rows


def _plain(value: Any) -> Any:
    """A value as a column can hold it: tables as their text."""
    return to_toml(value) if isinstance(value, Mapping) else value


Finished = Iterator[tuple[_Task, list[Row] | str]]


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
                yield task, f"its worker was lost {attempts} times"


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
    for future in distributed.as_completed(list(futures)):
        task = futures[future]
        try:
            yield task, future.result()
        except Exception as error:
            yield task, f"{type(error).__name__}: {error}"


def _file_of(folder: Path, key: str) -> Path:
    return folder / f"point-{key}.parquet"


def _write(parquet: Any, rows: list[Row], file: Path) -> None:
    """Writes a point in one move, so that a file that is there is whole."""
    arrow = need("pyarrow", "pyarrow", "sweep")
    part = file.with_suffix(".part")
    parquet.write_table(arrow.Table.from_pylist(rows), part)
    part.replace(file)
