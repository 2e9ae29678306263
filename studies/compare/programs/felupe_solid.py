"""FElupe: finite elements in NumPy; its own neo-Hookean law is the scene's, its own Newton's method, scipy's sparse factor."""

from __future__ import annotations

import numpy as np

from programs.experiment import Answer, CannotRun, Case, Stopwatch, load_steps

EFFORTS = {"P1, 1": (1, 1), "P1, 4": (1, 4), "P2, 1": (2, 1), "P2, 4": (2, 4)}  # order, load steps between two stations


def version() -> str:
    import felupe

    return felupe.__version__


class Body:
    def __init__(self, case: Case, order: int) -> None:
        import felupe as fem

        mesh = fem.Mesh(case.vertices, case.tets, "tetra")
        self.count = len(case.vertices)
        self.case, self.middles = case, np.zeros((0, 2), dtype=int)
        if order == 2:
            mesh = mesh.add_midpoints_edges()
            edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
            self.middles = np.zeros((mesh.npoints - self.count, 2), dtype=int)
            for k, (a, b) in enumerate(edges):
                self.middles[mesh.cells[:, 4 + k] - self.count] = mesh.cells[:, [a, b]]
        region = fem.RegionQuadraticTetra(mesh) if order == 2 else fem.RegionTetra(mesh)
        self.rest = mesh.points
        self.field = fem.FieldContainer([fem.Field(region, dim=3)])
        self.items = [fem.SolidBody(fem.NeoHooke(mu=case.mu, bulk=case.bulk), self.field)]
        if np.any(case.gravity):
            self.items.append(fem.SolidBodyForce(self.field, values=[0.0, 0.0, 0.0]))
        held = self.spread(case.prescribed.astype(float)) == 1.0
        self.boundaries = {
            str(i): fem.Boundary(self.field[0], mask=held[:, i], skip=tuple(int(k != i) for k in range(3))) for i in range(3)
        }
        self.held = held

    def spread(self, at_vertices: np.ndarray) -> np.ndarray:
        return np.concatenate([at_vertices, at_vertices[self.middles].mean(axis=1)])

    def move(self, now: float) -> int:
        """Sweeps of Newton to the equilibrium at a time."""
        import felupe as fem

        given = self.spread(self.case.given(now))
        for i in range(3):
            self.boundaries[str(i)].value = given[self.boundaries[str(i)].points, i]
        if len(self.items) > 1:
            self.items[1].update(self.case.density * self.case.gravity_at(now))
        dof0, dof1 = fem.dof.partition(self.field, self.boundaries)
        ext0 = fem.dof.apply(self.field, self.boundaries, dof0)
        try:
            found = fem.newtonrhapson(items=self.items, dof0=dof0, dof1=dof1, ext0=ext0, verbose=0, maxiter=25, tol=1e-8)
        except (ValueError, RuntimeError, np.linalg.LinAlgError) as error:
            raise CannotRun(f"Newton finds no equilibrium at {now:.3g} s; more load steps help") from error
        return found.iterations

    def reaction(self) -> np.ndarray:
        """The force or moment of the tool, from the forces of its points."""
        own = -sum(np.asarray(item.results.force.todense()) for item in self.items).reshape(-1, 3)
        group = (self.case.tools or self.case.supports)[0]
        mine = np.zeros(self.case.vertices.shape)
        mine[group.vertices] = group.axes
        f = np.where(self.spread(mine) == 1.0, -own, 0.0)
        arm = self.rest + self.field[0].values
        return f.sum(axis=0) if self.case.moment_about is None else np.cross(arm - self.case.moment_about, f).sum(axis=0)


def run(case: Case, effort: str) -> Answer:
    order, per_station = EFFORTS[effort]
    watch = Stopwatch()
    body = Body(case, order)
    setup = watch.lap()
    forces, sweeps = [], 0
    for times in load_steps(case, per_station):
        for now in times:
            sweeps += body.move(now)
        forces.append(body.reaction())
    return Answer(np.asarray(forces), body.field[0].values[: body.count].copy(), setup, watch.lap(), f"{sweeps} sweeps of Newton")
