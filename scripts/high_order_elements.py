"""Reference solutions by elements of high order, independent of Glisson: quadrilaterals and bricks of order p on tensor grids.

A body is a rectangle (plane strain, or about the axis r = 0) or a box. Its grid becomes geometrically finer toward the edges of
supports and tools, where the stress is singular, so that the energy, and with it the force of a driven tool, converges nearly
exponentially with p and the number of layers. Nothing here is shared with the engine: other shape functions, other integration,
tangents in closed form, a direct solver.
"""
import numpy as np
import pypardiso
import scipy.sparse as sp


def graded(length, singular=(), layers=6, ratio=0.2, most=0.5):
    """Breakpoints from 0 to `length` that become finer by `ratio` a layer toward each singular coordinate; the coarsest element is
    `most` of its interval."""
    stops = sorted({0.0, length, *singular})
    near = [most * ratio**k for k in range(layers, -1, -1)]
    points = [0.0]
    for a, b in zip(stops, stops[1:]):
        shares = near * (a in singular) + [1.0 - s for s in near] * (b in singular)
        points += [a + (b - a) * s for s in shares or (1 / 3, 2 / 3)] + [b]
    points.sort()
    return np.array([x for i, x in enumerate(points) if i == 0 or x - points[i - 1] > 1e-12 * length])


def lobatto(p):
    """Nodes of order p on [-1, 1]."""
    inner = np.polynomial.legendre.Legendre.basis(p).deriv().roots()
    return np.concatenate([[-1.0], np.real(inner), [1.0]])


def lagrange(nodes, x):
    """Values and derivatives of the Lagrange polynomials of `nodes` at `x`: two arrays (len(x), len(nodes))."""
    V = np.polynomial.legendre.legvander(nodes, len(nodes) - 1)
    c = np.linalg.inv(V)
    N = np.polynomial.legendre.legvander(x, len(nodes) - 1) @ c
    D = np.stack([np.polynomial.legendre.legval(x, np.polynomial.legendre.legder(c[:, j]))
                  for j in range(len(nodes))], axis=1)
    return N, D


class Linear:
    """Small strain: W = λ/2 tr(ε)² + μ ε:ε."""

    linear = True

    def __init__(self, E, nu):
        self.lam, self.mu = E * nu / ((1 + nu) * (1 - 2 * nu)), E / (2 * (1 + nu))

    def tangent(self):
        I = np.eye(3)
        A = self.lam * np.einsum("ij,kl->ijkl", I, I)
        return A + self.mu * (np.einsum("ik,jl->ijkl", I, I) + np.einsum("il,jk->ijkl", I, I))


class NeoHooke:
    """W = μ/2 (Ī₁ − 3) + κ/2 (J − 1)²."""

    linear = False

    def __init__(self, mu, kappa):
        self.mu, self.kappa = mu, kappa

    def response(self, F):
        """P (n, 3, 3) and dP/dF (n, 3, 3, 3, 3) of F (n, 3, 3); none where an element is inverted."""
        J = np.linalg.det(F)
        if J.min() <= 0.0:
            return None
        G = np.linalg.inv(F).transpose(0, 2, 1)
        I1, s = np.einsum("nij,nij->n", F, F), self.mu * J ** (-2 / 3)
        e = lambda f, X, Y: np.einsum("n,nij,nkl->nijkl", f, X, Y, optimize=True)
        P = s[:, None, None] * (F - (I1 / 3)[:, None, None] * G) + (self.kappa * (J - 1) * J)[:, None, None] * G
        A = np.einsum("n,ik,jl->nijkl", s, np.eye(3), np.eye(3))
        A += e(-2 / 3 * s, F, G) + e(-2 / 3 * s, G, F) + e(2 / 9 * s * I1 + self.kappa * (2 * J - 1) * J, G, G)
        A += np.einsum("n,nil,nkj->nijkl", s * I1 / 3 - self.kappa * (J - 1) * J, G, G, optimize=True)
        return P, A


class Grid:
    """Elements of order p between the breakpoints of each axis. kind: "plane" (x, z), "axial" (r, z) or "box" (x, y, z)."""

    def __init__(self, breaks, p, law, kind="plane"):
        self.breaks, self.p, self.law, self.kind = [np.asarray(b) for b in breaks], p, law, kind
        self.d = len(breaks)
        self.nodes1 = lobatto(p)
        axes = [np.concatenate([b[i] + (b[i + 1] - b[i]) * (self.nodes1[:-1] + 1) / 2 for i in range(len(b) - 1)] + [b[-1:]])
                for b in self.breaks]
        self.shape = [len(a) for a in axes]
        self.x = np.stack([m.ravel() for m in np.meshgrid(*axes, indexing="ij")], axis=1)
        self.u = np.zeros((len(self.x), self.d))
        self._elements()

    def _elements(self):
        index = np.arange(len(self.x)).reshape(self.shape)
        cells = np.stack([m.ravel() for m in np.meshgrid(*[np.arange(len(b) - 1) for b in self.breaks], indexing="ij")], axis=1)
        local = np.stack([m.ravel() for m in np.meshgrid(*[np.arange(self.p + 1)] * self.d, indexing="ij")], axis=1)
        self.connect = index[tuple((cells[:, None, k] * self.p + local[None, :, k]) for k in range(self.d))]
        self.sizes = np.stack([np.diff(b)[cells[:, k]] for k, b in enumerate(self.breaks)], axis=1)
        self.lowest = np.stack([b[:-1][cells[:, k]] for k, b in enumerate(self.breaks)], axis=1)
        g, w = np.polynomial.legendre.leggauss(self.p + 2)
        N, D = lagrange(self.nodes1, g)
        one = lambda k, l: D if k == l else N
        product = lambda parts: parts[0] if len(parts) == 1 else np.einsum("qa,rb->qrab", parts[0], product(parts[1:])).reshape(
            len(parts[0]) * len(product(parts[1:])), -1)
        self.N = product([N] * self.d)
        self.dN = np.stack([product([one(k, l) for l in range(self.d)]) for k in range(self.d)], axis=1)  # q, k, a
        self.w = product([w[:, None]] * self.d).ravel()
        self.points = np.stack([m.ravel() for m in np.meshgrid(*[g] * self.d, indexing="ij")], axis=1)

    def _gradient_map(self, some):
        """B (e, q, m, a·d): displacements of elements to their displacement gradient, and the weights with volume (e, q)."""
        d, nb, nq, ne = self.d, self.connect.shape[1], len(self.w), len(some)
        sizes, m = self.sizes[some], self.d**2 + (self.kind == "axial")
        grad = self.dN[None] * (2 / sizes)[:, None, :, None]
        B = np.zeros((ne, nq, m, nb, d))
        for i in range(d):
            for k in range(d):
                B[:, :, i * d + k, :, i] = grad[:, :, k]
        weight = self.w[None] * np.prod(sizes / 2, axis=1)[:, None]
        if self.kind == "axial":
            r = self.lowest[some, 0, None] + sizes[:, :1] * (self.points[None, :, 0] + 1) / 2
            B[:, :, d * d, :, 0] = self.N[None] / r[:, :, None]
            weight = weight * 2 * np.pi * r
        return B.reshape(ne, nq, m, nb * d), weight

    def _components(self):
        """Which of F's components the m are."""
        at = [0, 2] if self.d == 2 else [0, 1, 2]
        pairs = [(i, k) for i in at for k in at]
        return np.array(pairs + ([(1, 1)] if self.kind == "axial" else [])).T

    def _element_forces(self, some):
        """Tangents and forces of some elements; none where one is inverted."""
        (B, weight), (rows, cols) = self._gradient_map(some), self._components()
        u = self.u[self.connect[some]].reshape(len(some), -1)
        H = np.matmul(B.reshape(len(some), -1, B.shape[3]), u[:, :, None]).reshape(B.shape[:3])
        block = (rows[:, None], cols[:, None], rows, cols)
        if self.law.linear:
            A = np.broadcast_to(self.law.tangent()[block], (*B.shape[:2], len(rows), len(rows)))
            P = np.matmul(A, H[..., None])[..., 0]
        else:
            F = np.tile(np.eye(3), (H.shape[0] * H.shape[1], 1, 1))
            F[:, rows, cols] += H.reshape(-1, len(rows))
            found = self.law.response(F)
            if found is None:
                return None
            P = found[0][:, rows, cols].reshape(H.shape)
            A = found[1][:, block[0], block[1], block[2], block[3]].reshape(*H.shape, -1)
        WB = np.matmul(weight[:, :, None, None] * A, B).reshape(len(some), -1, B.shape[3])
        flat = B.reshape(len(some), -1, B.shape[3]).transpose(0, 2, 1)
        return np.matmul(flat, WB), np.matmul(flat, (weight[:, :, None] * P).reshape(len(some), -1, 1))[..., 0]

    def assemble(self):
        """Tangent, its upper half, and internal forces at the present displacement; none where an element is inverted."""
        dofs = (self.connect[:, :, None] * self.d + np.arange(self.d)).reshape(len(self.connect), -1)
        n, values, forces = self.x.size, [], np.zeros(self.x.size)
        for some in np.array_split(np.arange(len(dofs)), max(1, len(dofs) // 16)):
            found = self._element_forces(some)
            if found is None:
                return None
            values.append(found[0].ravel())
            np.add.at(forces, dofs[some], found[1])
        rows = np.repeat(dofs, dofs.shape[1], axis=1).astype(np.int32).ravel()
        cols = np.tile(dofs, (1, dofs.shape[1])).astype(np.int32).ravel()
        keep = rows <= cols
        return sp.csr_matrix((np.concatenate(values)[keep], (rows[keep], cols[keep])), shape=(n, n)), forces

    def on(self, axis, value, *ranges):
        """Nodes with that coordinate, within (axis, least, most) of each of `ranges`."""
        eps = 1e-9 * np.ptp(self.x[:, axis])
        chosen = np.abs(self.x[:, axis] - value) < eps
        for other, least, most in ranges:
            chosen &= (self.x[:, other] > least - eps) & (self.x[:, other] < most + eps)
        return np.flatnonzero(chosen)

    def press(self, held, tool, direction, depth, steps=1):
        """Moves the nodes `tool` by `depth` along the axis `direction`; `held` is a list of (nodes, axes) kept at 0.

        Returns the tool's force along its motion.
        """
        fixed = np.zeros(self.x.size, bool)
        for nodes, axes in held:
            for axis in axes:
                fixed[np.asarray(nodes) * self.d + axis] = True
        driven = np.asarray(tool) * self.d + direction
        fixed[driven] = True
        free = np.flatnonzero(~fixed)
        solver = pypardiso.PyPardisoSolver(mtype=2 if self.law.linear else -2)
        done, step = 0.0, 1.0 / steps
        while done < 1.0 - 1e-12:
            step = min(step, 1.0 - done)
            before = self.u.copy()
            if self._increment(solver, driven, free, depth * step):
                done += step
                continue
            self.u, step = before, step / 2
            if step < 0.02 / steps:
                raise RuntimeError("no equilibrium found")
        solver.free_memory(everything=True)
        _, forces = self.assemble()
        return float(forces[driven].sum() * np.sign(depth))

    def _increment(self, solver, driven, free, more):
        """Newton's method; the first step moves the driven nodes, with the rest of the body as its tangent has it."""
        first = np.zeros(self.x.size)
        first[driven] = more
        found = self.assemble()
        for iteration in range(30):
            K, forces = found
            if iteration == 0:
                forces = forces + K @ first + sp.triu(K, 1).T @ first
            residual = forces[free]
            if iteration > 0 and np.abs(residual).max() < 1e-9 * np.abs(forces).max():
                return True
            change = np.zeros(self.x.size)
            change[free] = solver.solve(K[free][:, free], -residual)
            if iteration == 0:
                change += first
            found = self._moved(change.reshape(self.u.shape), iteration > 0)
            if found is None:
                return False
            if self.law.linear:
                return True
        return False

    def _moved(self, change, may_shorten):
        """Adds the change, half of it or less where elements would be inverted. What assemble() gives there, or none."""
        for _ in range(8 if may_shorten else 1):
            self.u += change
            found = self.assemble()
            if found is not None:
                return found
            self.u -= change
            change = change / 2
        return None
