"""The experiment that `glisson compare SCENE --problem FILE` writes, and the errors of an answer to it: numpy alone."""

from __future__ import annotations

import json
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np


class CannotRun(Exception):
    """Why a program has no answer, as its row's note says it."""


@dataclass
class Answer:
    """What a program gives back: as models/rival.h."""

    forces: np.ndarray | None  # of the first tool, or without tools of the first support, at each station [N or N m]
    displacement: np.ndarray  # of every vertex at the end [m]
    setup_s: float
    run_s: float
    note: str = ""


class Stopwatch:
    def __init__(self) -> None:
        self.last = time.perf_counter()

    def lap(self) -> float:
        before, self.last = self.last, time.perf_counter()
        return self.last - before


@dataclass
class Group:
    """Vertices that are held or moved; `path` is [time][vertex][axis], 0 for those held."""

    vertices: np.ndarray
    axes: np.ndarray
    path: np.ndarray


@dataclass
class Case:
    """The experiment on one mesh."""

    scene: str
    vertices: np.ndarray  # (n, 3) [m]
    tets: np.ndarray  # (m, 4)
    stations: np.ndarray  # [s]
    times: np.ndarray  # of the paths, from 0 [s]
    per_station: int
    density: float
    lame_lambda: float
    mu: float
    gravity: np.ndarray
    gravity_ramp: float
    damping: float  # of velocities [1/s]
    moment_about: np.ndarray | None
    surface: np.ndarray
    reference_forces: np.ndarray
    reference_displacement: np.ndarray
    supports: list[Group] = field(default_factory=list)
    tools: list[Group] = field(default_factory=list)

    @property
    def young(self) -> float:
        return self.mu * (3.0 * self.lame_lambda + 2.0 * self.mu) / (self.lame_lambda + self.mu)

    @property
    def poisson(self) -> float:
        return self.lame_lambda / (2.0 * (self.lame_lambda + self.mu))

    @property
    def bulk(self) -> float:
        return self.lame_lambda + 2.0 / 3.0 * self.mu

    @property
    def prescribed(self) -> np.ndarray:
        """(n, 3), true where a component is held or moved."""
        held = np.zeros(self.vertices.shape, dtype=bool)
        for group in self.supports + self.tools:
            held[group.vertices] |= group.axes
        return held

    def wholly_prescribed(self, why: str) -> np.ndarray:
        """Vertices of which every component is. @raises CannotRun with `why` where one has some alone"""
        held = self.prescribed
        if np.any(held.any(axis=1) != held.all(axis=1)):
            raise CannotRun(why)
        return np.flatnonzero(held.all(axis=1))

    def given(self, now: float) -> np.ndarray:
        """(n, 3), the prescribed displacements at a time; 0 elsewhere. Straight between the times of the file."""
        u = np.zeros(self.vertices.shape)
        for group in self.tools:
            k = min(int(np.searchsorted(self.times, now)), len(self.times) - 1)
            a, b = self.times[max(k - 1, 0)], self.times[k]
            share = 1.0 if k == 0 else (now - a) / (b - a)
            moved = (1.0 - share) * group.path[max(k - 1, 0)] + share * group.path[k]
            u[group.vertices] = np.where(group.axes, moved, u[group.vertices])
        return u

    def gravity_at(self, now: float) -> np.ndarray:
        return self.gravity * (min(1.0, now / self.gravity_ramp) if self.gravity_ramp > 0.0 else 1.0)

    def volumes(self) -> np.ndarray:
        x = self.vertices[self.tets]
        return np.linalg.det(x[:, 1:] - x[:, :1]) / 6.0

    def masses(self) -> np.ndarray:
        """A quarter of each tet's mass at each of its vertices [kg]."""
        quarter = np.repeat(self.density * self.volumes() / 4.0, 4)
        return np.bincount(self.tets.ravel(), quarter, len(self.vertices))

    def force(self, own: np.ndarray, displacement: np.ndarray) -> np.ndarray:
        """What the tool or support exerts where the body's own forces on its vertices, weight among them, are `own` (n, 3)."""
        group = (self.tools or self.supports)[0]
        f = np.where(group.axes, -own[group.vertices], 0.0)
        if self.moment_about is None:
            return f.sum(axis=0)
        arm = self.vertices[group.vertices] + displacement[group.vertices] - self.moment_about
        return np.cross(arm, f).sum(axis=0)

    def force_by_law(self, stress, displacement: np.ndarray, now: float) -> np.ndarray:
        """The same from the shape: own forces − V P s of linear tets, P = stress(F), first Piola–Kirchhoff, (m, 3, 3)."""
        x = self.vertices[self.tets]
        inverse = np.linalg.inv(np.swapaxes(x[:, 1:] - x[:, :1], 1, 2))
        slopes = np.concatenate([-inverse.sum(axis=1, keepdims=True), inverse], axis=1)
        f = np.eye(3) + np.einsum("mai,maj->mij", displacement[self.tets], slopes)
        pull = -self.volumes()[:, None, None] * np.einsum("mij,maj->mai", stress(f), slopes)
        own = self.masses()[:, None] * self.gravity_at(now)
        np.add.at(own, self.tets.ravel(), pull.reshape(-1, 3))
        return self.force(own, displacement)

    def errors(self, answer: Answer) -> tuple[float | None, float | None]:
        """Of force and surface, as docs/compare.md defines them; None where there is none."""
        force = None
        if answer.forces is not None:
            off = np.asarray(answer.forces) - self.reference_forces
            scale = np.linalg.norm(self.reference_forces, axis=1).max()
            force = float(np.sqrt((off**2).sum(axis=1).mean()) / scale)
        off = answer.displacement[self.surface] - self.reference_displacement[self.surface]
        scale = np.linalg.norm(self.reference_displacement[self.surface], axis=1).max()
        return force, float(np.sqrt((off**2).sum(axis=1).mean()) / scale)


def stable_neo_hookean(case: Case):
    """P of W = μ/2 (tr FᵀF − 3) + λ'/2 (J − 1 − μ/λ')², λ' = λ + μ: what solvers of games take; λ' keeps λ at rest."""
    stiff = case.lame_lambda + case.mu

    def stress(f: np.ndarray) -> np.ndarray:
        cofactors = np.stack([np.cross(f[:, 1], f[:, 2]), np.cross(f[:, 2], f[:, 0]), np.cross(f[:, 0], f[:, 1])], axis=1)
        return case.mu * f + stiff * (np.linalg.det(f) - 1.0 - case.mu / stiff)[:, None, None] * cofactors

    return stress


def in_steps(case: Case, steps: int, advance, read) -> list[np.ndarray] | None:
    """Calls advance(time at the end of the step, given displacements) `steps` times and read(time) at the stations.

    @raises CannotRun where a step leaves a number that is none, when advance says so by raising FloatingPointError
    """
    forces = []
    h = case.stations[-1] / steps
    for n in range(steps):
        now = h * (n + 1)
        try:
            advance(now, case.given(now))
        except FloatingPointError as error:
            raise CannotRun(f"diverged at {now:.3g} s of {case.stations[-1]:.3g} s: {error}") from error
        if len(forces) < len(case.stations) and case.stations[len(forces)] <= now + 0.5 * h:
            forces.append(read(now))
    return forces if all(f is not None for f in forces) else None


def groups(entries: list[dict], times: int) -> list[Group]:
    made = []
    for entry in entries:
        vertices = np.asarray(entry["vertices"])
        still = np.zeros((1, len(vertices), 3))
        moved = np.asarray(entry["displacements_m"]) if "displacements_m" in entry else np.zeros((times - 1, len(vertices), 3))
        made.append(Group(vertices, np.asarray(entry["axes"], dtype=bool), np.concatenate([still, moved])))
    return made


def load_steps(case: Case, per_station: int) -> list[list[float]]:
    """Times of the equilibria that are solved, a list for each station, which is the last of it [s]."""
    starts = [0.0, *case.stations[:-1]]
    return [
        [start + (station - start) * k / per_station for k in range(1, per_station + 1)]
        for start, station in zip(starts, case.stations)
    ]


def cases(file: Path) -> list[Case]:
    """The experiment on each of its meshes, the coarsest first.

    @raises CannotRun for a body of several tissues, of one that is not neo-Hookean or is viscous, and for one that is cut
    """
    data = json.loads(Path(file).read_text(encoding="utf-8"))
    if data["cut_at_s"] is not None:
        raise CannotRun("programs are given no cut")
    if len(data["tissues"]) != 1:
        raise CannotRun(f"the body has {len(data['tissues'])} tissues; programs are given one")
    tissue = data["tissues"][0]
    if tissue["law"] != "neo_hookean" or tissue["viscous"]:
        raise CannotRun("programs are given neo-Hookean tissue without viscosity; the scene has another")
    times = np.asarray([0.0, *data["times_s"]])
    about = data["moment_about_m"]
    return [
        Case(
            scene=data["scene"],
            vertices=np.asarray(mesh["vertices_m"]),
            tets=np.asarray(mesh["tets"]),
            stations=np.asarray(data["stations_s"]),
            times=times,
            per_station=data["times_per_station"],
            density=tissue["density_kg_m3"],
            lame_lambda=tissue["lambda_Pa"],
            mu=tissue["mu_Pa"],
            gravity=np.asarray(data["gravity_m_s2"]),
            gravity_ramp=data["gravity_ramp_s"],
            damping=data["damping_per_s"],
            moment_about=None if about is None else np.asarray(about),
            surface=np.asarray(data["surface"]),
            reference_forces=np.asarray(data["reference"]["forces"]),
            reference_displacement=np.asarray(data["reference"]["displacement_m"]),
            supports=groups(mesh["supports"], len(times)),
            tools=groups(mesh["tools"], len(times)),
        )
        for mesh in data["meshes"]
    ]
