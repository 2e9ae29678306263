#include "fit/forward/section_forward.h"

#include <cmath>
#include <numbers>

#include "scene/parse/section.h"

namespace glisson::fit {

using namespace scene;

const SectionSpec& forward_section() {
  static const SectionSpec section = [] {
    using F = ForwardSpec;
    std::vector<Choice<std::optional<Integrator>>> choices;
    for (const Word<Integrator>& w : kWords<Integrator>)
      choices.push_back({std::string(w.word), w.value, "", is_alias(w)});
    Section<F> s("forward", "Forward model: how the forces of a fit are computed.");
    s.choice<ForwardKind>(
        "kind", &F::kind,
        {{"auto", ForwardKind::automatic, "the cheapest model that stays within `tolerance` of the scene"},
         {"uniaxial", ForwardKind::uniaxial, "a homogeneous specimen between smooth plates"},
         {"scene", ForwardKind::scene, "the scene as written"}},
        "forward model");
    s.choice<std::optional<Integrator>>("integrator", &F::integrator, choices,
                                        "integrator of the scene that the others are compared with")
        .otherwise("the scene's");
    s.key("tolerance", &F::tolerance, "largest rms difference from the scene, over the noise of a curve")
        .in("-")
        .within(above(0));
    s.key("points", &F::points, "points within the bounds, besides the start, where models are compared")
        .within(between(0, 100));
    s.key("tool", &F::tool, "name of the tool or instrument that follows the curves").otherwise("the only one");
    s.key("force", &F::force,
          "source of the measured force: a tool, an instrument, or `bottom` or `side` of the container")
        .otherwise("that tool's");
    s.key<Milli>("approach_mm", &F::approach, "travel of an instrument in the scene before it touches the tissue")
        .in("mm")
        .within(at_least(0));
    return s.spec();
  }();
  return section;
}

namespace {

SectionSpec cylinder_kind() {
  Section<SpecimenSpec> s("cylinder", "Round.");
  s.key<Milli>("diameter_mm", &SpecimenSpec::diameter, "diameter").in("mm").within(above(0)).must();
  s.key<Milli>("height_mm", &SpecimenSpec::height, "height at rest").in("mm").within(above(0)).must();
  s.choice<lab::Faces>("faces", &SpecimenSpec::faces,
                       {{"smooth", lab::Faces::smooth, "they slide freely: the specimen deforms alike all over"},
                        {"friction", lab::Faces::friction,
                         "they slide against adhesion and Coulomb's friction, and the specimen bulges"},
                        {"bonded", lab::Faces::bonded, "they do not slide"}},
                       "how its faces meet the plates");
  s.key(
       "friction", [](SpecimenSpec & x) -> auto& { return x.grip.friction; },
       "coefficient of friction of faces = \"friction\"; `specimen.friction` may be a parameter")
      .in("-")
      .within(at_least(0));
  s.key(
       "adhesion_Pa", [](SpecimenSpec & x) -> auto& { return x.grip.adhesion; },
       "shear stress that they carry without pressure, on the area at rest; `specimen.adhesion_Pa` may be a parameter")
      .in("Pa")
      .within(at_least(0));
  return s.spec();
}

SectionSpec block_kind() {
  Section<SpecimenSpec> s("block", "Rectangular.");
  s.key<Milli>("width_mm", &SpecimenSpec::width, "width").in("mm").within(above(0)).must();
  s.key<Milli>("depth_mm", &SpecimenSpec::depth, "depth").in("mm").within(above(0)).must();
  s.key<Milli>("height_mm", &SpecimenSpec::height, "height at rest").in("mm").within(above(0)).must();
  return s.spec();
}

SectionSpec point_kind() {
  return Section<SpecimenSpec>("point", "Stress over strain: no size is needed, and none is known.").spec();
}

SectionSpec layer_kind() {
  using S = SpecimenSpec;
  Section<S> s("layer", "On a rigid floor, under an indenter: of test = \"indentation\".");
  s.key<OptionalMilli>("thickness_mm", &S::thickness, "thickness at rest")
      .in("mm")
      .within(above(0))
      .otherwise("a half-space");
  s.key<OptionalMilli>("diameter_mm", &S::layer_diameter, "diameter, the indenter in its middle and its side free")
      .in("mm")
      .within(above(0))
      .otherwise("wide");
  s.choice<bool>("floor", &S::bonded_floor,
                 {{"bonded", true, "it does not slide on the floor"}, {"smooth", false, "it slides freely"}},
                 "how it meets the floor");
  return s.spec();
}

KindSpec kind_of(SectionSpec section, SpecimenShape shape) {
  return {std::move(section), [shape](void* target) -> void* {
            static_cast<SpecimenSpec*>(target)->shape = shape;
            return target;
          }};
}

}  // namespace

const SectionSpec& specimen_section() {
  static const SectionSpec section = [] {
    Section<SpecimenSpec> s("specimen", "A specimen of a laboratory, in place of a scene.");
    s.key("cells", &SpecimenSpec::cells,
          "cubes along x, y and z of the body that the homogeneous specimen is compared with")
        .within(between(1, 100));
    s.spec().kinds = {kind_of(cylinder_kind(), SpecimenShape::cylinder), kind_of(block_kind(), SpecimenShape::block),
                      kind_of(point_kind(), SpecimenShape::point), kind_of(layer_kind(), SpecimenShape::layer)};
    return s.spec();
  }();
  return section;
}

Specimen specimen_of(const SpecimenSpec& spec) {
  if (spec.shape == SpecimenShape::point || spec.shape == SpecimenShape::layer) return {.area = 1.0, .height = 1.0};
  if (spec.shape == SpecimenShape::block) return {.area = spec.width * spec.depth, .height = spec.height};
  return {.area = 0.25 * std::numbers::pi * spec.diameter * spec.diameter,
          .height = spec.height,
          .radius = 0.5 * spec.diameter};
}

std::optional<Plates> plates_of(const SpecimenSpec& spec) {
  if (spec.shape != SpecimenShape::cylinder || spec.faces == lab::Faces::smooth) return {};
  return Plates{0.5 * spec.diameter, spec.height, spec.faces, spec.grip};
}

std::optional<Layer> layer_of(const SpecimenSpec& spec) {
  if (spec.shape != SpecimenShape::layer) return {};
  return Layer{.thickness = spec.thickness.value_or(Layer::kNone),
               .radius = spec.layer_diameter ? 0.5 * *spec.layer_diameter : Layer::kNone,
               .bonded_floor = spec.bonded_floor};
}

std::string specimen_scene(const SpecimenSpec& spec) {
  const Specimen size = specimen_of(spec);
  const double area = size.area, width = spec.shape == SpecimenShape::block ? spec.width : std::sqrt(area);
  std::string text = "title = \"A specimen between smooth plates\"\n\n[mesh]\nkind = \"box\"\n";
  text += "cells = " + Codec<std::array<int, 3>>::show(spec.cells) + "\n";
  text += "size_m = " + Codec<Vec3d>::show({width, area / width, size.height}) + "\n\n";
  for (const char* axis : {"x", "y", "z"})
    text += "[[fixed]]\nset = \"" + std::string(axis) + "_min\"\naxes = \"" + axis + "\"\n\n";
  return text +
         "[[tool]]\nname = \"plate\"\nset = \"z_max\"\nsideways = \"free\"\n\n[motion]\nintegrator = \"implicit\"\n";
}

}  // namespace glisson::fit
