"""pybullet: Bullet's deformable world, neo-Hookean tets after Smith et al. 2018, explicit in the elastic forces, in float or double as built.

Anchored vertices have no mass; before each step `resetMeshData` puts them where they belong. Its damping of tets takes held vertices for
resting ones and drags at what moves with them, so hardly any is given. It reads out no force of anchors; what the table shows follows
from its shape by its own law, summed here. Every vertex has the same mass, whatever the size of its tets.
"""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from programs.experiment import Answer, Case, Stopwatch, in_steps

EFFORTS = {"1 ms": 0.001, "0.5 ms": 0.0005, "0.2 ms": 0.0002}
DAMPING = 1e-3


def version() -> str:
    from importlib.metadata import version as of

    return of("pybullet")


def write_vtk(case: Case, file: Path) -> None:
    lines = ["# vtk DataFile Version 2.0", "body", "ASCII", "DATASET UNSTRUCTURED_GRID", f"POINTS {len(case.vertices)} double"]
    lines += ["%.17g %.17g %.17g" % tuple(x) for x in case.vertices]
    lines += [f"CELLS {len(case.tets)} {5 * len(case.tets)}", *("4 %d %d %d %d" % tuple(t) for t in case.tets)]
    lines += [f"CELL_TYPES {len(case.tets)}", *["10"] * len(case.tets)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def moduli(case: Case) -> tuple[float, float]:
    """Bullet's μ and λ that give the tissue's at rest: P = μ F (1 − 1/(I₁ + 1)) + (λ (J − 1) − ¾ μ) cof F."""
    return 4.0 / 3.0 * case.mu, case.lame_lambda + 5.0 / 6.0 * case.mu


def law(case: Case):
    mu, stiff = moduli(case)

    def stress(f: np.ndarray) -> np.ndarray:
        cofactors = np.stack([np.cross(f[:, 1], f[:, 2]), np.cross(f[:, 2], f[:, 0]), np.cross(f[:, 0], f[:, 1])], axis=1)
        i1, j = (f**2).sum(axis=(1, 2))[:, None, None], np.linalg.det(f)[:, None, None]
        return mu * (1.0 - 1.0 / (i1 + 1.0)) * f + (stiff * (j - 1.0) - 0.75 * mu) * cofactors

    return stress


def run(case: Case, effort: str) -> Answer:
    import pybullet as bullet

    step = EFFORTS[effort]
    held = case.wholly_prescribed("Bullet anchors whole vertices, the scene single components")
    watch = Stopwatch()
    world = bullet.connect(bullet.DIRECT)
    try:
        bullet.resetSimulation(bullet.RESET_USE_DEFORMABLE_WORLD)
        bullet.setTimeStep(step)
        mu, stiff = moduli(case)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "body.vtk"
            write_vtk(case, file)
            body = bullet.loadSoftBody(
                str(file),
                mass=float(case.masses().sum()),
                useNeoHookean=1,
                NeoHookeanMu=mu,
                NeoHookeanLambda=stiff,
                NeoHookeanDamping=DAMPING,
                collisionMargin=1e-4,
                useSelfCollision=0,
            )
        # else what moves slowly is frozen after 2 s
        bullet.changeDynamics(body, -1, activationState=bullet.ACTIVATION_STATE_DISABLE_SLEEPING)
        for v in held:
            bullet.createSoftBodyAnchor(body, int(v), -1, -1)
        setup = watch.lap()

        def places() -> np.ndarray:
            return np.asarray(bullet.getMeshData(body, -1, flags=bullet.MESH_DATA_SIMULATION_MESH)[1])

        def advance(now: float, given: np.ndarray) -> None:
            x = places()
            if not np.all(np.isfinite(x)) or np.abs(x - case.vertices).max() > 10.0 * np.ptp(case.vertices):
                raise FloatingPointError("vertices have left")
            x[held] = case.vertices[held] + given[held]
            bullet.resetMeshData(body, x.tolist())
            bullet.setGravity(*case.gravity_at(now))
            bullet.stepSimulation()

        def read(now: float) -> np.ndarray:
            return case.force_by_law(law(case), places() - case.vertices, now)

        forces = in_steps(case, round(case.stations[-1] / step), advance, read)
        return Answer(np.asarray(forces), places() - case.vertices, setup, watch.lap())
    finally:
        bullet.disconnect(world)
