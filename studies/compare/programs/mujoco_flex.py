"""MuJoCo: a 3D flex, every vertex a body on three slides, steps that are implicit in the flex's stiffness (`integrator="discrete"`).

MuJoCo has St Venant–Kirchhoff tets, and since 4.0, as an experiment, "simplified stable neo-Hookean" ones. It prescribes no displacement:
the slides that the experiment moves are given an inertia of a ton and, before each step, the velocity that takes them where they belong.
The force is what the flex exerts on these slides, `qfrc_passive`.
"""

from __future__ import annotations

import warnings

import numpy as np

from programs.experiment import Answer, CannotRun, Case, Stopwatch, in_steps

# law (mjsFlex.elastic3d), step [s]; its manual advises 1 to 4 ms
EFFORTS = {
    "StVK, 4 ms": (0, 0.004),
    "StVK, 1 ms": (0, 0.001),
    "SNH, 50 ms": (1, 0.05),
    "SNH, 10 ms": (1, 0.01),
    "SNH, 4 ms": (1, 0.004),
    "SNH, 1 ms": (1, 0.001),
}
HEAVY = 1e3  # [kg]


def version() -> str:
    import mujoco

    return mujoco.__version__


def model_of(case: Case, law: int, step: float):
    import mujoco

    spec = mujoco.MjSpec()
    spec.option.timestep = step
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_DISCRETE
    spec.option.solver = mujoco.mjtSolver.mjSOL_CG
    spec.option.tolerance = 1e-8
    spec.option.gravity = [0.0, 0.0, 0.0]
    spec.option.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
    for v, (place, mass, held) in enumerate(zip(case.vertices, case.masses(), case.prescribed)):
        body = spec.worldbody.add_body(name=f"v{v}", pos=place, mass=mass, inertia=[1e-6 * mass] * 3, explicitinertial=True)
        for i in range(3):
            joint = body.add_joint(type=mujoco.mjtJoint.mjJNT_SLIDE, axis=np.eye(3)[i])
            joint.armature = HEAVY if held[i] else 0.0
    flex = spec.add_flex(name="body", dim=3, young=case.young, poisson=case.poisson, elastic3d=law)
    flex.radius = 1e-5
    flex.vertbody = [f"v{v}" for v in range(len(case.vertices))]
    flex.vert = np.zeros(3 * len(case.vertices))
    flex.elem = case.tets.ravel().tolist()
    flex.selfcollide = mujoco.mjtFlexSelf.mjFLEXSELF_NONE
    flex.contype = flex.conaffinity = 0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it finds no passive forces in a flex that has them
        return spec.compile()


def run(case: Case, effort: str) -> Answer:
    import mujoco

    law, step = EFFORTS[effort]
    watch = Stopwatch()
    model = model_of(case, law, step)
    data = mujoco.MjData(model)
    held = case.prescribed
    masses = case.masses()[:, None]
    setup = watch.lap()

    def advance(now: float, given: np.ndarray) -> None:
        q, v = data.qpos.reshape(-1, 3), data.qvel.reshape(-1, 3)
        v[held] = (given[held] - q[held]) / step
        model.opt.gravity[:] = case.gravity_at(now)
        data.qfrc_applied[:] = (-masses * case.damping * v * ~held).ravel()
        mujoco.mj_step(model, data)
        if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number or not np.all(np.isfinite(data.qpos)):
            raise FloatingPointError("an acceleration is no number")

    def read(now: float) -> np.ndarray:
        mujoco.mj_forward(model, data)
        own = data.qfrc_passive.reshape(-1, 3) + masses * case.gravity_at(now)
        return case.force(own, data.qpos.reshape(-1, 3))

    forces = in_steps(case, round(case.stations[-1] / step), advance, read)
    return Answer(np.asarray(forces), data.qpos.reshape(-1, 3).copy(), setup, watch.lap())
