"""NGSolve: the scene's neo-Hookean energy as a formula, which it derives twice, tets of order 1 to 3, Newton with a sparse factor.

On held faces the hierarchical functions of edges and faces stay 0, since tools move as rigid bodies.
"""

from __future__ import annotations

import numpy as np

from programs.experiment import Answer, CannotRun, Case, Stopwatch, load_steps

EFFORTS = {"P1, 1": (1, 1), "P1, 4": (1, 4), "P2, 1": (2, 1), "P2, 4": (2, 4)}  # order, load steps between two stations
MOST_SWEEPS, TOLERANCE = 25, 1e-8


def version() -> str:
    import ngsolve

    return ngsolve.__version__


def mesh_of(case: Case):
    import ngsolve
    from netgen.meshing import FaceDescriptor, Mesh

    mesh = Mesh(dim=3)
    mesh.AddPoints(case.vertices)
    mesh.Add(FaceDescriptor(bc=1, domin=1, surfnr=1))
    mesh.AddElements(dim=3, index=1, data=case.tets.astype(np.int32), base=0)
    return ngsolve.Mesh(mesh)


class Body:
    def __init__(self, case: Case, order: int) -> None:
        from ngsolve import BilinearForm, Det, Grad, GridFunction, Id, Parameter, Trace, Variation, VectorH1, dx

        self.case = case
        self.mesh = mesh_of(case)
        self.space = VectorH1(self.mesh, order=order)
        self.u = GridFunction(self.space)
        self.load = Parameter(0.0)
        form = BilinearForm(self.space, symmetric=True)
        f = Id(3) + Grad(self.space.TrialFunction())
        j = Det(f)
        energy = 0.5 * case.mu * (j ** (-2 / 3) * Trace(f.trans * f) - 3) + 0.5 * case.bulk * (j - 1) ** 2
        form += Variation(energy.Compile() * dx)
        if np.any(case.gravity):
            work = sum(g * w for g, w in zip(case.gravity, self.space.TrialFunction()))
            form += Variation(-self.load * case.density * work * dx)
        self.form = form
        self.per_axis = self.space.ndof // 3
        self.free = self.free_unknowns()

    def free_unknowns(self):
        """All but the vertices that are held or moved, and edges and faces between such."""
        from ngsolve import BitArray

        free = BitArray(self.space.ndof)
        free.Set()
        held = self.case.prescribed
        one = self.space.components[0]
        nodes = [(v, [v.nr]) for v in self.mesh.vertices]
        nodes += [(e, [v.nr for v in e.vertices]) for part in (self.mesh.edges, self.mesh.faces) for e in part]
        for node, corners in nodes:
            for i in np.flatnonzero(held[corners].all(axis=0)):
                for dof in one.GetDofNrs(node):
                    free[int(i) * self.per_axis + dof] = False
        return free

    def at_vertices(self, vector) -> np.ndarray:
        n = len(self.case.vertices)
        values = vector.FV().NumPy()
        return np.stack([values[i * self.per_axis : i * self.per_axis + n] for i in range(3)], axis=1)

    def prescribe(self, given: np.ndarray) -> None:
        """By the tangent, so that the first sweep starts from what follows linearly."""
        held = self.case.prescribed
        step = self.u.vec.CreateVector()
        step[:] = 0.0
        n = len(self.case.vertices)
        change = np.where(held, given - self.at_vertices(self.u.vec), 0.0)
        for i in range(3):
            step.FV().NumPy()[i * self.per_axis : i * self.per_axis + n] = change[:, i]
        self.form.AssembleLinearization(self.u.vec)
        right = self.u.vec.CreateVector()
        right.data = self.form.mat * step
        residual = self.u.vec.CreateVector()
        self.form.Apply(self.u.vec, residual)
        right.data += residual
        self.u.vec.data += step - self.form.mat.Inverse(self.free, inverse="sparsecholesky") * right

    def equilibrium(self, now: float):
        residual = self.u.vec.CreateVector()
        free = np.asarray([self.free[k] for k in range(self.space.ndof)])
        for sweep in range(2, MOST_SWEEPS + 2):
            self.form.Apply(self.u.vec, residual)
            r = residual.FV().NumPy()
            if not np.all(np.isfinite(r)):
                break
            if np.linalg.norm(r[free]) <= TOLERANCE * max(np.linalg.norm(r[~free]), 1e-12):
                return self.at_vertices(residual), sweep - 1
            self.form.AssembleLinearization(self.u.vec)
            self.u.vec.data -= self.form.mat.Inverse(self.free, inverse="sparsecholesky") * residual
        raise CannotRun(f"Newton finds no equilibrium at {now:.3g} s; more load steps help")


def run(case: Case, effort: str) -> Answer:
    order, per_station = EFFORTS[effort]
    watch = Stopwatch()
    body = Body(case, order)
    setup = watch.lap()
    forces, sweeps = [], 0
    for times in load_steps(case, per_station):
        for now in times:
            body.load.Set(min(1.0, now / case.gravity_ramp) if case.gravity_ramp > 0.0 else 1.0)
            body.prescribe(case.given(now))
            residual, spent = body.equilibrium(now)
            sweeps += spent
        forces.append(case.force(-residual, body.at_vertices(body.u.vec)))
    return Answer(np.asarray(forces), body.at_vertices(body.u.vec), setup, watch.lap(), f"{sweeps} sweeps of Newton")
