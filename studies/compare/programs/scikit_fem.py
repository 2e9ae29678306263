"""scikit-fem: assembly in Python, the scene's neo-Hookean law as a form, Newton's method, scipy's sparse factor.

The law, W = μ/2 (Ī₁ − 3) + κ/2 (J − 1)², and its tangent are written here, as the program's own tutorials do. With quadratic tets the
same mesh has more unknowns; both are tried, with few and with many load steps.
"""

from __future__ import annotations

import numpy as np

from programs.experiment import Answer, CannotRun, Case, Stopwatch, load_steps

# order of the tets, load steps between two stations; order 0: linear elasticity
EFFORTS = {"linear": (0, 1), "P1, 1": (1, 1), "P1, 4": (1, 4), "P2, 1": (2, 1), "P2, 4": (2, 4)}
MOST_SWEEPS, TOLERANCE = 25, 1e-8  # of Newton; the residual over the reaction


def version() -> str:
    from importlib.metadata import version as of

    return of("scikit-fem")


def forms(case: Case):
    from skfem import BilinearForm, LinearForm
    from skfem.helpers import ddot, det, grad, identity, inv, mul, sym_grad, trace, transpose

    mu, kappa = case.mu, case.bulk

    def law(displacement):
        """P and ∂P/∂F = a I ⊗ I + b T ⊗ T − c (F ⊗ T + T ⊗ F) + e T·T, T = F⁻ᵀ, once for all pairs of unknowns."""
        h = displacement.grad
        f = h + identity(h)
        t, j = transpose(inv(f)), det(f)
        a, i1 = mu * j ** (-2 / 3), ddot(f, f)
        stress = a * (f - i1 / 3 * t) + kappa * (j - 1) * j * t
        b, e = 2 / 9 * a * i1 + kappa * (2 * j - 1) * j, a * i1 / 3 - kappa * (j - 1) * j
        return {"stress": stress, "f": f, "t": t, "a": a, "b": b, "c": 2 / 3 * a, "e": e}

    @LinearForm
    def forces(v, w):
        return ddot(w["stress"], grad(v))

    @BilinearForm
    def tangent(u, v, w):
        d, g, f, t = grad(u), grad(v), w["f"], w["t"]
        td, tg = ddot(t, d), ddot(t, g)
        turned = ddot(mul(transpose(d), t), mul(transpose(t), g))
        return w["a"] * ddot(d, g) + (w["b"] * td - w["c"] * ddot(f, d)) * tg - w["c"] * td * ddot(f, g) + w["e"] * turned

    @BilinearForm
    def linear(u, v, w):
        e = sym_grad(u)
        return 2 * mu * ddot(e, sym_grad(v)) + case.lame_lambda * trace(e) * trace(sym_grad(v))

    @LinearForm
    def weight(v, w):
        return case.density * sum(g * v[i] for i, g in enumerate(case.gravity))

    return law, forces, tangent, linear, weight


class Body:
    def __init__(self, case: Case, order: int) -> None:
        from skfem import Basis, ElementTetP1, ElementTetP2, ElementVector, MeshTet

        self.case = case
        self.mesh = MeshTet(case.vertices.T, case.tets.T, sort_t=False, validate=False)
        # four points in a quadratic tet, as finite-element codes for solids take
        self.basis = Basis(self.mesh, ElementVector(ElementTetP2() if order == 2 else ElementTetP1()), intorder=order)
        self.x = np.zeros(self.basis.N)
        held = self.spread(case.prescribed.astype(float))
        self.held = np.flatnonzero(held == 1.0)  # of an edge between two that are held, the middle too
        self.rest = self.spread(case.vertices)

    def spread(self, at_vertices: np.ndarray) -> np.ndarray:
        """Values at the vertices, and in the middle of edges their mean, as a vector of unknowns."""
        x = np.zeros(self.basis.N)
        x[self.basis.nodal_dofs] = at_vertices.T
        if len(self.basis.edge_dofs):
            x[self.basis.edge_dofs] = at_vertices[self.mesh.edges].mean(axis=0).T
        return x

    def reaction(self, residual: np.ndarray) -> np.ndarray:
        """The force or moment of the tool, from the forces that it takes to hold its unknowns."""
        group = (self.case.tools or self.case.supports)[0]
        mine = np.zeros(self.case.vertices.shape)
        mine[group.vertices] = group.axes
        f = np.where(self.spread(mine) == 1.0, residual, 0.0)
        places = [self.basis.nodal_dofs, *([self.basis.edge_dofs] if len(self.basis.edge_dofs) else [])]
        dofs = np.concatenate(places, axis=1)
        f, at = f[dofs].T, (self.rest + self.x)[dofs].T
        return f.sum(axis=0) if self.case.moment_about is None else np.cross(at - self.case.moment_about, f).sum(axis=0)

    def displacement(self) -> np.ndarray:
        return self.x[self.basis.nodal_dofs].T


def run(case: Case, effort: str) -> Answer:
    from skfem import condense, solve

    order, per_station = EFFORTS[effort]
    watch = Stopwatch()
    body = Body(case, order)
    law, forces_of, tangent_of, linear_of, weight_of = forms(case)
    weight = weight_of.assemble(body.basis)
    stiffness = linear_of.assemble(body.basis) if order == 0 else None
    setup = watch.lap()
    forces, sweeps = [], 0
    for times in load_steps(case, per_station):
        for now in times:
            load = weight * (case.gravity_at(now) @ case.gravity / max(case.gravity @ case.gravity, 1e-300))
            given = body.spread(case.given(now))
            if order == 0:
                body.x = solve(*condense(stiffness, load, x=given, D=body.held))
                residual = stiffness @ body.x - load
                continue
            residual, spent = equilibrium(body, law, forces_of, tangent_of, load, given, now)
            sweeps += spent
        forces.append(body.reaction(residual))
    note = "" if order == 0 else f"{sweeps} sweeps of Newton"
    return Answer(np.asarray(forces), body.displacement(), setup, watch.lap(), note)


def equilibrium(body: Body, law, forces_of, tangent_of, load, given, now):
    from skfem import condense, solve

    free = np.ones(body.basis.N, dtype=bool)
    free[body.held] = False

    def residual_at():
        fields = law(body.basis.interpolate(body.x))
        return forces_of.assemble(body.basis, stress=fields.pop("stress")) - load, fields

    residual, fields = residual_at()
    for sweep in range(1, MOST_SWEEPS + 1):
        step = np.where(free, 0.0, given - body.x)
        body.x = body.x + solve(*condense(tangent_of.assemble(body.basis, **fields), -residual, x=step, D=body.held))
        residual, fields = residual_at()
        if not np.all(np.isfinite(residual)):
            break
        if np.linalg.norm(residual[free]) <= TOLERANCE * max(np.linalg.norm(residual[body.held]), 1e-12):
            return residual, sweep
    raise CannotRun(f"Newton finds no equilibrium at {now:.3g} s; more load steps help")
