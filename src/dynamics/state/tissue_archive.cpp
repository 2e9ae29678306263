// tissue_archive.cpp — laws go by their place in the list of laws and by the fields that each declares of itself.
#include "dynamics/state/tissue_archive.h"

#include <optional>
#include <utility>
#include <variant>

namespace glisson {
namespace {

template <class Variant, std::size_t... I>
Variant law_of_kind(std::size_t kind, std::index_sequence<I...>) {
  Variant law;
  static_cast<void>(((kind == I ? (law.template emplace<I>(), true) : false) || ...));
  return law;
}

template <class... Laws>
void archive_law(Archive& ar, std::variant<Laws...>& law) {
  auto kind = static_cast<std::uint8_t>(law.index());
  ar.below(kind, sizeof...(Laws));
  if (ar.reads()) law = law_of_kind<std::variant<Laws...>>(kind, std::index_sequence_for<Laws...>{});
  std::visit(
      [&](auto& l) {
        for (const auto& field : l.kFields) std::visit([&](auto member) { ar(l.*member); }, field.member);
      },
      law);
}

template <class Law>
void archive_law(Archive& ar, std::optional<Law>& law) {
  bool there = law.has_value();
  ar(there);
  if (ar.reads()) there ? static_cast<void>(law.emplace()) : law.reset();
  if (law) archive_law(ar, *law);
}

}  // namespace

void archive(Archive& ar, Fibres& fibres) { ar(fibres.direction, fibres.stiffness); }
void archive(Archive& ar, MaxwellBranch& branch) { ar(branch.share, branch.time); }

void archive(Archive& ar, Tissue& t) {
  ar(t.name, t.youngs_modulus, t.poisson_ratio, t.density, t.viscosity, t.fibres, t.maxwell);
  ar(t.viscous_tensor, t.measure, t.kinematics, t.law_form, t.maxwell_part, t.volume_change);
  archive_law(ar, t.law), archive_law(ar, t.lambda_law), archive_law(ar, t.mu_law);
  archive_law(ar, t.hyperelastic);
}

}  // namespace glisson
