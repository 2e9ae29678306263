#include "scene/describe/reference_text.h"

namespace glisson::scene {

const std::string_view kReferenceIntroduction = R"(# Scenes

<!-- Written by `glisson schema > docs/scene.md` from the description the reader itself uses. Do not edit. -->

A scene is a TOML file that describes an experiment: a body, its material, its supports, the tools that press it, and
the output. Every key is checked. An unknown key is an error that names the line and the nearest valid key. A value of
the wrong type, a number out of range, a missing key and contradictory keys are errors too. `glisson check SCENE`
reports them all without running the scene. Its exit status is 0 where the scene can be run, 2 where it cannot, 3 where its numbers end a run early,
and 4 where ten seconds were not enough to look at every variant.

**Units.** Values are in SI unless their key says otherwise: the unit ends the key's name (`density_kg_m3`,
`depth_mm`). Ranges and defaults below are in that unit; `-` is a pure number.

**Axes.** Right-handed x, y, z in metres. Generated boxes and cylinders have z upwards, and a tool presses along
`direction`, by default downwards.

)";

const std::string_view kReferenceVariants = R"(## Variants

Each `[[variant]]` is one complete experiment: the scene with some keys changed. It has a `name`, optionally a
`label`, and any section above, which is merged into that of the scene:

- Tables are merged key by key; the variant's value wins.
- A table with a `kind` is replaced as a whole if the variant's kind differs, so that no key of the old law or mesh
  remains.
- A key removes the keys it excludes: a variant's `mu_law` replaces the scene's `law`, its `sphere_m` the scene's
  `box_m`.
- Lists of numbers are replaced.
- Lists of tables (`tool`, `instrument`, `fixed`, `load`, `region`, `stiffness`, `capsule`, `probe`) are replaced by a list,
  `[[variant.tool]]`. To change some keys of one element, write a table with its name or number instead:
  `tool.press.velocity_mm_s = 2`, `instrument.needle.motion.velocity_mm_s = 2`, or `fixed.0.axes = "z"`. Tools,
  instruments, regions and probes are found by their `name`, loads and fixed sets by their `set`; numbers count from 0.

Without any `[[variant]]` the scene is one experiment called `main`. Regions inherit from the `[tissue]` of their
variant.

```toml pattern
[[variant]]
name = "slow"
label = "2 mm/s"
tool.press.velocity_mm_s = 2

[[variant]]
name = "stiffening"
tissue.law = { kind = "linear", slope_Pa = 20000 }
```

)";

const std::string_view kReferenceOverrides = R"(## Overrides

`glisson run SCENE --set KEY=VALUE` changes a scene without editing it. KEY is the dotted path of a key, with names or
numbers for elements of lists, or `*` for each of them (`'heat.probe.*.radius_mm=1'`); VALUE is TOML, otherwise plain text:

```text
glisson run scene.toml --set tissue.density_kg_m3=1060
glisson run scene.toml --set tool.press.velocity_mm_s=2 --set tissue.law.kind=linear --set tissue.law.slope_Pa=2e4
glisson run scene.toml --set 'mesh={kind="file", path="/data/liver.vtu"}'
glisson run scene.toml --set variant.slow.motion.precision=double
```

An override applies to every variant, `variant.NAME.…` to one, and takes precedence over the variant. Several are
applied in order, by the rules of variants above, and checked like the file; messages about them show `--set KEY` in
place of a line. Put a name that contains a dot in quotes: `'variant."v1.5".…'`.

)";

const std::string_view kReferenceRun = R"(## What a run does

1. The mesh is generated or read, vertex sets are selected at rest, and tets are assigned to regions by their
   centroids.
2. Fixed sets are held, tools are attached, loads are added. Only one of them can hold a component of a vertex.
   Capsules, the container and instruments act on the body in this order.
3. Time runs to `duration_s`, or to the end of the last motion of a tool or instrument; `max_steps` may end it
   earlier. The last step is the one that ends nearest to that time. Automatic steps of `implicit` and `quasi_static`
   end there, at frames, and at corners of motions, loads and records, where a speed jumps or an oscillation turns.
4. Each line of forces.csv belongs to the start of a step, the one nearest to each multiple of 1/`sample_rate_hz`; the
   last line belongs to the last step. Under `implicit` and `quasi_static` lines are at these multiples, and their
   numbers on the line between the ends of the step before and after. Depth, forces and energies on a line belong to the same instant. Without a
   [[tool]] the first columns are those of the first instrument: pressing (`normal_N`), `friction_N` and `cutting_N`
   add up to `force_N`. Every further tool and instrument has a forces_NAME.csv. Names of variants, tools and
   instruments must therefore differ from the output files (`scene.toml`, `forces.csv` …), contain no `/`, and differ
   in more than upper and lower case.
5. events.csv has a line for each event of an instrument: contact, puncture, drop (the end of the sudden fall of the
   force), inner puncture, exit, withdrawal, release. Both files are complete up to the last sample, however a run ends.
6. Probes are read with every sample into probes.csv, whose lines belong to those of forces.csv.
7. Frames are evenly spaced, the first at rest and the last at the end.

)";

const std::string_view kReferenceExample = R"(title = "A block pressed by a small punch"
description = "Three tissues under the same press."
notes = ["Density is that of water; the source gives none."]

[mesh]
kind = "box"
cells = [4, 4, 8]
size_m = [0.04, 0.04, 0.08]

[sets.contact]
nearest_m = { point = [0.0167, 0.0167, 0.08], count = 3 }

[tissue]
name = "soft tissue"
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
density_kg_m3 = 1000

[[region]]
name = "nodule"
sphere_m = { center = [0.02, 0.02, 0.04], radius = 0.012 }
tissue.youngs_modulus_Pa = 20000

[motion]
step_s = "auto"
damping_rate_per_s = 20

[[fixed]]
set = "z_min"

[[tool]]
name = "press"
set = "contact"
direction = [0, 0, -1]
velocity_mm_s = 10
depth_mm = 8

[output]
sample_rate_hz = 500
frames = 30

[[variant]]
name = "linear"

[[variant]]
name = "step"
label = "stiffer above 5 %"
tissue.law = { kind = "step", threshold = 0.05, above_Pa = 7200 }

[[variant]]
name = "growing"
label = "stiffness grows with deformation"
tissue.law = { kind = "linear", slope_Pa = 20000 }

[[chart]]
title = "Force against depth"
x = "depth_m"
x_scale = 1000
x_label = "depth [mm]"
y = "force_N"
y_label = "force of the tool [N]"
)";

}  // namespace glisson::scene
