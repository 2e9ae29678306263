#include "dynamics/state/body_state.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dynamics/step/mass_scaling.h"
#include "glisson/archive.h"

namespace glisson {
namespace {

std::vector<std::uint32_t> gone_elements(const Body& body) {
  std::vector<std::uint32_t> gone;
  for (std::uint32_t e = 0; e < body.rest.size(); ++e) {
    if (body.rest[e].volume == 0.0) gone.push_back(e);
  }
  return gone;
}

}  // namespace

BodyState::BodyState(Body made, const SimulationOptions& o)
    : options(o), body(std::move(made)), mass_scaling(scaled_masses(body, o)), gamma(body.vertex_count),
      constraints(body.vertex_count), loads(body.vertex_count) {
  masses_changed();
}

BodyChanger& BodyState::changer() {
  if (changer_ == nullptr) changer_ = std::make_shared<BodyChanger>(body);
  return *changer_;
}

double BodyState::damping_of(std::size_t vertex) const {
  return options.damping_rate * body.masses[vertex] + options.nodal_damping;
}

void BodyState::damp(std::span<const std::uint32_t> vertices) {
  gamma.resize(body.vertex_count);
  for (const std::uint32_t v : vertices) gamma[v] = damping_of(v);
}

void BodyState::masses_changed() {
  gamma.resize(body.vertex_count);
  for (std::size_t v = 0; v < gamma.size(); ++v) gamma[v] = damping_of(v);
  if (changer_ != nullptr) changer_->masses_changed();
}

BodyVersion BodyState::version() const {
  BodyVersion version{body, mass_scaling, gamma, constraints, loads, copies, changes, {}};
  if (changer_ != nullptr) version.closed = changer_->closed();
  return version;
}

void BodyState::go_to(const BodyVersion& version) {
  body = version.body, mass_scaling = version.mass_scaling, gamma = version.gamma;
  constraints = version.constraints, loads = version.loads;
  copies = version.copies, changes = version.changes;
  ++editions;
  changer_.reset();
  if (version.closed) changer().set_closed(*version.closed);
}

Vec3d BodyState::gravity_at(double t) const {
  return options.gravity * (t < options.gravity_ramp ? t / options.gravity_ramp : 1.0);
}

std::vector<char> BodyState::held_components() const {
  std::vector<char> held(3 * body.vertex_count, 0);
  for (std::size_t i = 0; i < body.vertex_count; ++i) {
    if (!(body.masses[i] > 0.0)) held[3 * i] = held[3 * i + 1] = held[3 * i + 2] = 1;
  }
  for (std::size_t c = 0; c < base.size(); ++c) {
    if (!holds(c)) continue;
    for (const std::uint32_t v : constraints.all()[c].vertices) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (has_axis(constraints.all()[c].axes, axis)) held[3 * v + axis] = 1;
      }
    }
  }
  return held;
}

/// Tissues of a change that was made elsewhere; as valid as those of set_tissues.
void BodyState::archive_tissues(Archive& ar) {
  for (TissueBlock& block : body.blocks) {
    Tissue tissue = block.tissue;
    ar(tissue);
    if (!ar.reads() || tissue == block.tissue) continue;
    try {
      require_fibres(body, block, tissue);
      block = make_block(tissue, block.begin, block.end);
    } catch (const std::invalid_argument&) {
      Archive::refuse();
    }
  }
}

/// Tets hold the vertices that they held before, or copies of these.
void BodyState::check_corners(const Archive& ar, const std::vector<Tet>& before) const {
  const std::size_t first = body.vertex_count - copies.size();
  std::vector<std::uint32_t> root(body.vertex_count);
  for (std::uint32_t v = 0; v < root.size(); ++v) {
    if (v >= first) ar.check(copies[v - first] < v);
    root[v] = v < first ? v : root[copies[v - first]];
  }
  for (std::size_t e = 0; e < before.size(); ++e) {
    for (std::size_t a = 0; a < 4; ++a) {
      const std::uint32_t v = body.elements[e][a];
      ar.check(v < root.size() && root[v] == root[before[e][a]]);
    }
  }
}

/// Shapes at rest of the elements that are there.
void BodyState::measure(const Archive& ar, const std::vector<std::uint32_t>& gone) {
  const std::vector<Vec3d>& x = body.rest_positions;
  std::vector<char> is_gone(body.elements.size(), 0);
  for (const std::uint32_t e : gone) is_gone[e] = 1;
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    const Tet& t = body.elements[e];
    ar.check(is_gone[e] != 0 || body.rest[e].volume != 0.0);  // none that has gone comes back
    body.rest[e] = is_gone[e] != 0 ? ElementRest{} : element_rest({x[t[0]], x[t[1]], x[t[2]], x[t[3]]});
    ar.check(is_gone[e] != 0 || (body.rest[e].volume > 0.0 && std::isfinite(body.rest[e].volume)));
  }
}

/// @param as_here  there are as many changes here: they have to be the same
void BodyState::archive_changes(Archive& ar, bool as_here) {
  const Body before = ar.reads() ? body : Body{};
  const std::vector<std::uint32_t> known = copies;
  std::vector<std::uint32_t> gone = gone_elements(body);
  archive_tissues(ar);
  ar.same_size(body.elements);
  ar.all_below(gone, body.elements.size());
  ar(body.rest_positions, body.masses, copies);
  ar.same_size(body.mass_factor);
  ar(mass_scaling.added, mass_scaling.share, mass_scaling.tets);
  if (ar.reads()) {
    ar.check(body.rest_positions.size() + known.size() == before.vertex_count + copies.size());
    ar.check(body.masses.size() == body.rest_positions.size() && known.size() <= copies.size());
    ar.check(std::equal(known.begin(), known.end(), copies.begin()));
    body.vertex_count = body.rest_positions.size();
    check_corners(ar, before.elements);
    measure(ar, gone);
    ar.check(!as_here || (body.elements == before.elements && body.masses == before.masses &&
                          body.rest_positions == before.rest_positions));
  }
  bool cut = changer_ != nullptr;
  ar(cut);
  if (ar.reads()) changer_ = cut ? std::make_shared<BodyChanger>(body) : nullptr;
  if (cut) ar(*changer_);
  if (ar.reads()) masses_changed();
}

void BodyState::archive(Archive& ar) {
  const std::uint64_t here = changes;
  ar(time, steps, changes);
  ar.check(changes >= here);
  if (!ar.in_memory()) {
    if (changes > 0) archive_changes(ar, changes == here);
    if (ar.reads()) ++editions;
    constraints.archive(ar, body.vertex_count);
    loads.archive(ar, body);
  }
  for (std::size_t c = 0; c < base.size(); ++c) {
    ar(base[c]);
    ar.check(!holds(c) || base[c].size() == constraints.all()[c].vertices.size());
  }
}

}  // namespace glisson
