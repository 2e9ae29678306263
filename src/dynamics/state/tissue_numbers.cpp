// tissue_numbers.cpp — laws go by their place in the list of laws and by the fields that each declares of itself.
#include "dynamics/state/tissue_numbers.h"

#include <optional>
#include <utility>

namespace glisson {
namespace {

template <class... Laws>
void put_law(CheckpointWriter& out, const std::variant<Laws...>& law) {
  out.put(static_cast<std::uint32_t>(law.index()));
  std::visit(
      [&](const auto& l) {
        for (const auto& field : l.kFields) std::visit([&](auto member) { out.put(l.*member); }, field.member);
      },
      law);
}

template <class Variant, std::size_t... I>
Variant law_of_kind(std::uint32_t kind, std::index_sequence<I...>) {
  Variant law;
  const bool known = ((kind == I ? (law.template emplace<I>(), true) : false) || ...);
  if (!known) CheckpointReader::fail();
  return law;
}

template <class Variant>
Variant get_law(CheckpointReader& in) {
  auto law = law_of_kind<Variant>(in.get<std::uint32_t>(), std::make_index_sequence<std::variant_size_v<Variant>>{});
  std::visit(
      [&](auto& l) {
        for (const auto& field : l.kFields) std::visit([&](auto member) { in.get(l.*member); }, field.member);
      },
      law);
  return law;
}

template <class Law>
void put_optional(CheckpointWriter& out, const std::optional<Law>& law) {
  out.put(law.has_value());
  if (law) put_law(out, *law);
}
template <class Law>
std::optional<Law> get_optional(CheckpointReader& in) {
  if (!in.get<bool>()) return std::nullopt;
  return get_law<Law>(in);
}

template <class Word>
void put_word(CheckpointWriter& out, Word word) {
  out.put(static_cast<std::uint32_t>(word));
}
template <class Word>
Word get_word(CheckpointReader& in, Word last) {
  const auto number = in.get<std::uint32_t>();
  if (number > static_cast<std::uint32_t>(last)) CheckpointReader::fail();
  return static_cast<Word>(number);
}

}  // namespace

void put(CheckpointWriter& out, const Tissue& t) {
  out.put(std::vector<char>(t.name.begin(), t.name.end()));
  for (const double number : {t.youngs_modulus, t.poisson_ratio, t.density, t.viscosity}) out.put(number);
  put_word(out, t.viscous_tensor), put_word(out, t.measure), put_word(out, t.kinematics), put_word(out, t.law_form);
  put_law(out, t.law), put_optional(out, t.lambda_law), put_optional(out, t.mu_law);
  put_optional(out, t.hyperelastic);
  out.put(t.fibres.has_value());
  if (t.fibres) out.put(t.fibres->direction), out.put(t.fibres->stiffness);
  out.put(static_cast<std::uint32_t>(t.maxwell.size()));
  for (const MaxwellBranch& branch : t.maxwell) out.put(branch.share), out.put(branch.time);
  put_word(out, t.maxwell_part), put_word(out, t.volume_change);
}

Tissue get_tissue(CheckpointReader& in) {
  Tissue t;
  std::vector<char> name;
  in.get(name);
  t.name.assign(name.begin(), name.end());
  for (double* number : {&t.youngs_modulus, &t.poisson_ratio, &t.density, &t.viscosity}) in.get(*number);
  t.viscous_tensor = get_word(in, ViscousTensor::pioletti);
  t.measure = get_word(in, DeformationMeasure::solid_angle);
  t.kinematics = get_word(in, Kinematics::green);
  t.law_form = get_word(in, LawForm::energy);
  t.law = get_law<StiffnessLaw>(in);
  t.lambda_law = get_optional<StiffnessLaw>(in), t.mu_law = get_optional<StiffnessLaw>(in);
  t.hyperelastic = get_optional<HyperelasticLaw>(in);
  if (in.get<bool>()) {
    t.fibres.emplace();
    in.get(t.fibres->direction), in.get(t.fibres->stiffness);
  }
  const auto branches = in.get<std::uint32_t>();
  if (branches > in.left()) CheckpointReader::fail();
  t.maxwell.resize(branches);
  for (MaxwellBranch& branch : t.maxwell) in.get(branch.share), in.get(branch.time);
  t.maxwell_part = get_word(in, MaxwellPart::all);
  t.volume_change = get_word(in, VolumeChange::nodal);
  return t;
}

}  // namespace glisson
