// section_probe.cpp — [[probe]]: what is read at some place of the body with every sample.
#include "scene/parse/result_names.h"
#include "scene/parse/section.h"
#include "scene/parse/sections.h"

namespace glisson::scene {
namespace {

/// The place of a probe as one of its kinds, made where it is another.
template <class Where>
Where& where_as(ProbeSpec& probe) {
  return probe.options.where.emplace<Where>();
}

}  // namespace

const SectionSpec& probe_plane_section() {
  static const SectionSpec section = described<ProbePlane>("plane_m", "A section through the whole body at rest.");
  return section;
}

const SectionSpec& probe_section() {
  static const SectionSpec section = [] {
    Section<ProbeSpec> s("probe",
                         "Reads a place of the body with every sample, into probes.csv and curves of the report; the "
                         "columns are in output.md. The place is given at rest and follows the material.");
    s.fields([](ProbeSpec & x) -> auto& { return x.options; });
    s.fields([](ProbeSpec & x) -> auto& { return where_as<ProbePoint>(x); });
    s.at("point_m").otherwise("");
    s.fields([](ProbeSpec & x) -> auto& { return where_as<ProbeSet>(x); });
    s.fields([](ProbeSpec & x) -> auto& { return where_as<ProbeRegion>(x); });
    s.table(
        "plane_m", probe_plane_section(), [](ProbeSpec & x) -> auto& { return where_as<ProbePlane>(x); },
        "a section: force, moment and mean traction that the part in front exerts on the part behind");
    s.key("tip", &ProbeSpec::tip,
          "name of an `[[instrument]]`: adds the distance of its tip to the place, positive ahead along the "
          "instrument's "
          "direction, and across it; of a region to the middle of its volume")
        .otherwise("none");
    s.spec().exclusions = {{{{"point_m"}, {"set"}, {"region"}, {"plane_m"}}, true}};
    s.finish([](ProbeSpec& x, const Node& table, const Place& place) {
      x.origin = place.text();
      const std::string unfit = unfit_as_table(x.options.name);
      if (const Node* name = table.find("name"); name && !unfit.empty()) place.complain(*name, "name", unfit);
      if (const Node* tip = table.find("tip"); tip && table.find("plane_m"))
        place.complain(*tip, "tip",
                       "a plane is no place that a tip can be at a distance from; give `point_m`, `set` or `region`");
    });
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::scene
