// reference.cpp — docs/fit_file.md, written from the description the reader itself uses.
#include "scene/describe/reference_sections.h"

#include "fit/data/section_data.h"
#include "fit/forward/section_forward.h"
#include "fit/spec/fit_spec.h"
#include "fit/spec/section_fit.h"

namespace glisson::fit {
namespace {

constexpr const char* kIntroduction =
    "# FIT.toml\n"
    "\n"
    "<!-- Written by `glisson schema fit > docs/fit_file.md` from the description the reader itself uses. Do not edit. "
    "-->\n"
    "\n"
    "A fit is a TOML file that describes the test, the measured curves, and the free parameters of the tissue.\n"
    "`glisson fit FIT.toml` runs it; [fit.md](fit.md) describes the results. Every key is checked, and all errors are\n"
    "reported together, each with its line.\n"
    "\n"
    "Units are in the keys' names, SI where there is none. Bounds and starts of parameters are in the unit of their "
    "key.\n"
    "\n"
    "Keys of parameters are those of the scene as for `--set` (`tissue.law.slope_Pa`, `capsule.0.stiffening`); append\n"
    "`[i]` for an element of a list of numbers (`tissue.hyperelastic.mu_Pa[0]`). Four more belong to the\n"
    "measurement, not to the tissue: `curve.contact_mm`, `curve.force_offset_N`, `curve.NAME.contact_mm` and\n"
    "`curve.NAME.force_offset_N`, for all curves or for the one called NAME.\n"
    "\n"
    "## Sections\n"
    "\n";

}  // namespace

std::string fit_reference_markdown() {
  using scene::section_text;
  std::string text = kIntroduction;
  text += section_text(fit_section(), "The top of the file");
  text += section_text(specimen_section(), "`[specimen]`");
  text += section_text(parameter_section(), "`[[parameter]]`");
  text += section_text(data_section(), "`[[data]]`");
  text += section_text(columns_section(), "`[data.columns]`");
  text += section_text(column_section(), "`[data.columns.NAME]`");
  text += section_text(text_section(), "`[data.text]`");
  text += section_text(contact_section(), "`[data.contact]`");
  text += section_text(indenter_section(), "`[data.indenter]`");
  text += section_text(cycle_section(), "`[data.cycle]`");
  text += section_text(crop_section(), "`[data.crop]`");
  text += section_text(filter_section(), "`[data.filter]`");
  text += section_text(resample_section(), "`[data.resample]`");
  text += section_text(forward_section(), "`[forward]`");
  text += section_text(search_section(), "`[search]`");
  text += section_text(proof_section(), "`[proof]`");
  text += section_text(insertion_section(), "`[insertion]`");
  text += section_text(fit_law_section(), "`[[law]]`");
  text += section_text(experiment_section(), "`[[experiment]]`");
  text.pop_back();  // one end of the last paragraph is enough
  return text;
}

}  // namespace glisson::fit
