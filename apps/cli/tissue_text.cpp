#include "cli/tissue_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson::app {
namespace {

std::string value_text(double x) { return fmt::format("{:g}", x); }
std::string value_text(const std::vector<double>& list) {
  std::string text;
  for (const double x : list) text += (text.empty() ? "" : ", ") + value_text(x);
  return "[" + text + "]";
}

/// The law's word and its keys as a scene has them.
template <class Laws>
std::string law_keys(const Laws& laws) {
  return std::visit(
      []<class Law>(const Law& l) {
        std::string text;
        each_field<Law>([&](const auto& field) {
          text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", field.key(), value_text(l.*field.member));
        });
        return fmt::format("{}: {}", Law::kName, text);
      },
      laws);
}

std::string linear_text(const Tissue& t) {
  std::string law(law_name(t.law));
  if (t.lambda_law || t.mu_law) {
    law = fmt::format("λ {}, μ {}", t.lambda_law ? law_name(*t.lambda_law) : "constant",
                      t.mu_law ? law_name(*t.mu_law) : "constant");
  }
  return fmt::format("E = {:.6g} Pa, ν = {:.4g}, law: {}", t.youngs_modulus, t.poisson_ratio, law);
}

std::string kinematics_text(const Tissue& t) {
  std::string text;
  if (t.kinematics == Kinematics::corotational) text += ", corotational";
  if (t.kinematics == Kinematics::green) text += ", green";
  if (t.law_form == LawForm::energy) text += ", of an energy";
  return text;
}

/// Whether a line of a scene opens the section `mesh`, sets a key of it or sets it whole.
bool has_mesh(std::string_view text) {
  constexpr std::string_view kBlanks = " \t", kKey = "mesh";
  const auto skip = [&text](std::string_view blanks) {
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  };
  const auto is_of_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  while (!text.empty()) {
    skip(kBlanks);
    if (text.starts_with('[')) text.remove_prefix(1);
    skip(kBlanks);
    if (text.starts_with(kKey) && (text.size() == kKey.size() || !is_of_word(text[kKey.size()]))) return true;
    const std::size_t end = text.find('\n');
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return false;
}

}  // namespace

std::string law_text(const Tissue& t) {
  std::string text = t.hyperelastic ? law_keys(*t.hyperelastic) : linear_text(t) + kinematics_text(t);
  if (t.volume_change == VolumeChange::average_nodal) text += ", average nodal volume changes";
  if (t.viscosity > 0.0) text += fmt::format(", η = {:.6g} Pa·s", t.viscosity);
  if (t.fibres) text += fmt::format(", fibres of {:.6g} Pa", t.fibres->stiffness);
  const char* part = t.maxwell_part == MaxwellPart::all ? "all" : "the deviator";
  for (const MaxwellBranch& b : t.maxwell) {
    text += fmt::format(", {:g} of {} relaxes in {:g} s", b.share, part, b.time);
    if (b.time_law) text += " × " + law_keys(*b.time_law);
  }
  return text;
}

Tissue tissue_of_toml(std::string text, const std::string& name, const std::filesystem::path& folder) {
  if (!has_mesh(text)) text += "\n[mesh]\nkind = \"box\"\n[motion]\nmax_steps = 1\n";
  return parse_scene(text, name, folder).variants.front().tissue;
}

}  // namespace glisson::app
