"""Newton, on NVIDIA Warp, on the CPU: vertex block descent with stable neo-Hookean tets, its solver of soft bodies.

Vertices of supports and tools have no mass, which Newton takes for "moved by the caller"; they are put where they belong before each
step. It reads out no force; what the table shows follows from its shape by its own law, summed here. It computes in float.
"""

from __future__ import annotations

import numpy as np

from programs.experiment import Answer, Case, Stopwatch, in_steps, stable_neo_hookean

EFFORTS = {"20 ms, 5": (0.02, 5), "10 ms, 10": (0.01, 10), "10 ms, 100": (0.01, 100), "2 ms, 10": (0.002, 10)}  # step [s], iterations


def version() -> str:
    import newton
    import warp

    return f"{newton.__version__}, warp {warp.__version__}"


def model_of(case: Case):
    import newton
    import warp as wp

    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    builder.add_soft_mesh(
        pos=wp.vec3(0.0, 0.0, 0.0),
        rot=wp.quat_identity(),
        scale=1.0,
        vel=wp.vec3(0.0, 0.0, 0.0),
        vertices=[wp.vec3(*x) for x in case.vertices],
        indices=case.tets.ravel().tolist(),
        density=case.density,
        k_mu=case.mu,
        k_lambda=case.lame_lambda,
        k_damp=0.0,
        add_surface_mesh_edges=False,
        particle_radius=1e-4,
    )
    held = case.wholly_prescribed("Newton holds whole vertices, the scene single components")
    for v in held:
        builder.particle_mass[v] = 0.0
    builder.color()
    return builder.finalize(device="cpu"), held


def run(case: Case, effort: str) -> Answer:
    import newton
    import warp as wp

    wp.config.log_level = wp.LOG_WARNING if hasattr(wp, "LOG_WARNING") else None
    step, iterations = EFFORTS[effort]
    watch = Stopwatch()
    with wp.ScopedDevice("cpu"):
        model, held = model_of(case)
        solver = newton.solvers.SolverVBD(model=model, iterations=iterations, particle_enable_tile_solve=False)
        states = [model.state(), model.state()]
        control = model.control()
        setup = watch.lap()
        masses = case.masses()[:, None]
        places = case.vertices.copy()

        def advance(now: float, given: np.ndarray) -> None:
            q, v, f = (a.numpy() for a in (states[0].particle_q, states[0].particle_qd, states[0].particle_f))
            q[held] = case.vertices[held] + given[held]
            v[held] = 0.0
            f[:] = masses * (case.gravity_at(now) - case.damping * v)
            solver.step(states[0], states[1], control, None, step)
            states.reverse()
            places[:] = states[0].particle_q.numpy()
            if not np.all(np.isfinite(places)):
                raise FloatingPointError("a place is no number")

        law = stable_neo_hookean(case)
        forces = in_steps(
            case, round(case.stations[-1] / step), advance, lambda now: case.force_by_law(law, places - case.vertices, now)
        )
    return Answer(np.asarray(forces), places - case.vertices, setup, watch.lap())
