"""The wheel alone, with NumPy and nothing else: it simulates, and says what the optional parts need."""

import sys
import time

start = time.perf_counter()
import glisson  # noqa: E402

loaded = time.perf_counter() - start
body = glisson.Simulation(glisson.box_mesh(), glisson.Tissue())
body.fix("z_min")
tool = body.drive([207, 211, 212], glisson.PressMotion(depth=0.002))
assert body.advance(0.1) == "ok" and -body.force(tool).total[2] > 0.04
results = glisson.run(glisson.scenes_folder() / "paper" / "figure2.toml", overrides={"motion.duration_s": 0.02})
assert len(results) == 7
for call in (glisson.figures, lambda: glisson.plot.forces(results), lambda: glisson.to_pyvista(glisson.box_mesh())):
    try:
        call()
    except ImportError as error:
        assert f"{sys.executable} -m pip install '" in str(error), error  # the wheel alone is on no index
    else:
        raise AssertionError("an optional package is installed here")
print(f"glisson {glisson.__version__} in a clean environment: imported in {1e3 * loaded:.0f} ms")
