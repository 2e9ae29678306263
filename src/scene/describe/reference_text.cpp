#include "scene/describe/reference_text.h"

namespace glisson::scene {

const std::string_view kReferenceIntroduction = R"(# Scenes

<!-- Written by `glisson schema > docs/scene.md` from the description the reader itself uses. Do not edit. -->

A scene is a TOML file that describes an experiment: a body, what it is made of, what holds it, what presses it, and
what is kept of the run. Every key is checked. A key that does not exist is an error that names the line and the
nearest key that does; so are a value of the wrong type, a number out of its range, a missing key, and keys that
contradict each other. `glisson check SCENE` reports all of them without running anything.

**Units.** Values are in SI unless their key says otherwise: the unit is the end of the key's name (`density_kg_m3`,
`depth_mm`). Ranges and defaults below are in that unit; `-` is a pure number.

**Axes.** Right-handed x, y, z in metres. Generated boxes and cylinders have z upwards, and a tool presses along
`direction`, downwards unless told otherwise.

)";

const std::string_view kReferenceVariants = R"(## Variants

Each `[[variant]]` is one complete experiment: the scene with some keys changed. It has a `name`, perhaps a `label`,
and any section above, laid over that of the scene:

- Tables are joined key by key; what the variant gives wins.
- A table that has a `kind` is replaced as a whole when the variant's kind is another one, so that no key of the old law
  or mesh is left behind.
- A key removes the keys it excludes: a variant's `mu_law` takes the place of the scene's `law`, its `sphere_m` that of
  `box_m`.
- Lists of numbers are replaced.
- Lists of tables (`tool`, `instrument`, `fixed`, `load`, `region`, `capsule`) are replaced by a list,
  `[[variant.tool]]`. To change some keys of one element, write a table with its name or number instead:
  `tool.press.velocity_mm_s = 2`, `instrument.needle.motion.velocity_mm_s = 2`, or `fixed.0.axes = "z"`. Tools,
  instruments and regions go by their `name`, loads and fixed sets by their `set`; numbers count from 0.

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
numbers for elements of lists; VALUE is TOML, or plain text where it is not:

```text
glisson run scene.toml --set tissue.density_kg_m3=1060
glisson run scene.toml --set tool.press.velocity_mm_s=2 --set tissue.law.kind=linear --set tissue.law.slope_Pa=2e4
glisson run scene.toml --set 'mesh={kind="file", path="/data/liver.vtu"}'
glisson run scene.toml --set variant.slow.motion.precision=double
```

An override applies to every variant, `variant.NAME.…` to one, and wins over what the variant says. Several are
applied in their order, by the rules of variants above, and checked like the file; messages about them say
`--set KEY` in place of a line. A name with a dot in it goes in quotes: `'variant."v1.5".…'`.

)";

const std::string_view kReferenceRun = R"(## What a run does

1. The mesh is made or read, vertex sets are picked at rest, and regions are marked by the centroids of their tets.
2. Fixed sets are held, tools are attached, loads are added. A component of a vertex can be held by one of them only.
   Capsules, the container and instruments act on the body in this order.
3. Time runs to `duration_s`, or to the end of the last motion of a tool or instrument; `max_steps` ends it earlier. The last step is the
   one that ends nearest to that time.
4. Each line of forces.csv is of the instant at which a step starts, the one nearest to each multiple of
   1/`sample_rate_hz`; the last line is of the last step. Depth, forces and energies on a line are of the same instant.
   Without a [[tool]] its first columns are of the first instrument: pressing (`normal_N`), `friction_N` and `cutting_N`
   add up to `force_N`. Every further tool and instrument has a forces_NAME.csv.
   So names of variants, tools and instruments are none of the files' own (`scene.toml`, `forces.csv` …), hold no `/`,
   and differ in more than upper and lower case.
5. events.csv has a line for what instruments meet: contact, puncture, drop (the end of the sudden fall of the force),
   inner puncture, withdrawal, release. Both files are whole up to the last sample, however a run ends.
6. Frames are evenly spaced, the first at rest and the last at the end.

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
