#include "dynamics/schemes/scheme.h"

#include <stdexcept>
#include <string>

#include "dynamics/step/mass_scaling.h"
#include "element/tet_fields.h"

namespace glisson {
namespace {

std::vector<double> nodal_damping(const Body& body, const SimulationOptions& o) {
  std::vector<double> gamma;
  for (const double m : body.masses) gamma.push_back(o.damping_rate * m + o.nodal_damping);
  return gamma;
}

}  // namespace

Scheme::Scheme(Body body, const SimulationOptions& options)
    : options_(options), body_(std::move(body)), mass_scaling_(scaled_masses(body_, options)),
      gamma_(nodal_damping(body_, options)), constraints_(body_.vertex_count), loads_(body_.vertex_count) {}

BodyChanger& Scheme::changer() {
  if (changer_ == nullptr) changer_ = std::make_unique<BodyChanger>(body_);
  return *changer_;
}

ConstraintId Scheme::add_constraint(Constraint constraint) {
  const ConstraintId id = constraints_.add(std::move(constraint));
  base_.emplace_back();
  acts_on(constraints_.at(id).vertices);
  if (constraints_.at(id).from <= time_) rebase(id.index);
  return id;
}

void Scheme::add_load(std::span<const std::uint32_t> vertices, Vec3d force, std::function<double(double)> scale) {
  loads_.add(vertices, force, std::move(scale));
  acts_on(vertices);
}

void Scheme::require_tissues(const BlockTissues& tissues) const {
  for (const auto& [b, tissue] : tissues) {
    require_valid(tissue);
    require_fibres(body_, body_.blocks[b], tissue);
  }
}

void Scheme::attach(std::shared_ptr<Interaction>, const BodyView&) { refuse_interactions(); }

std::string Scheme::not_finite_at(double time) {
  return "a force is not finite at " + std::to_string(time) +
         " s: the tissue has been deformed beyond what its law or its precision can carry, or a motion, load or "
         "interaction gave a number that is not finite. Ways out: look at the last frame, press less deep or more "
         "slowly, soften the law, precision = \"double\", or integrator = \"implicit\"";
}

void Scheme::refuse_interactions() {
  throw std::invalid_argument(
      "attach: instruments, needles and membranes need integrator = explicit, or semi_implicit for tissue without "
      "viscosity; this simulation has another. Relaxation can be modelled by maxwell branches, which explicit steps "
      "bear");
}

bool Scheme::take_hold(double h) {
  bool any = false;
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (holds(c) || constraints_.all()[c].from > time_ + 0.5 * h) continue;
    rebase(c);
    any = true;
  }
  return any;
}

/// Lets a constraint's motion count from where its vertices are now.
void Scheme::rebase(std::size_t constraint) {
  const Constraint& c = constraints_.all()[constraint];
  const Vec3d moved = c.motion ? c.motion(time_) : Vec3d{};
  base_[constraint].clear();
  for (const std::uint32_t v : c.vertices) base_[constraint].push_back(displacement_of(v) - moved);
}

void Scheme::set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) {
  if (displacement.size() != body_.vertex_count || velocity.size() != body_.vertex_count) {
    throw std::invalid_argument("set_state: " + std::to_string(displacement.size()) + " displacements and " +
                                std::to_string(velocity.size()) + " velocities given, the mesh has " +
                                std::to_string(body_.vertex_count) + " vertices");
  }
  take_state(displacement, velocity);
  for (std::size_t c = 0; c < base_.size(); ++c) {
    if (holds(c)) rebase(c);
  }
}

Vec3d Scheme::gravity_at(double time) const {
  return options_.gravity * (time < options_.gravity_ramp ? time / options_.gravity_ramp : 1.0);
}

/// Kinetic and elastic energy of elements with their shares of mass [J].
std::array<double, 2> Scheme::energy_of(std::span<const std::uint32_t> elements) const {
  std::array<double, 2> sum{};
  for (const std::uint32_t e : elements) {
    const TissueBlock& block = body_.block_of(e);
    const double quarter = body_.quarter_mass(block, e);
    std::array<Vec3d, 4> u;
    for (std::size_t a = 0; a < 4; ++a) {
      const std::uint32_t vertex = body_.elements[e][a];
      const Vec3d v = velocity_of(vertex);
      u[a] = displacement_of(vertex);
      sum[0] += 0.5 * quarter * dot(v, v);
    }
    sum[1] += element_energy(body_, block, e, u);
  }
  return sum;
}

/// Mass, momentum and energy of elements that are about to go.
void Scheme::weigh_energy(std::span<const std::uint32_t> elements, RemovalReport& report) {
  for (const std::uint32_t e : elements) {
    const double quarter = body_.quarter_mass(body_.block_of(e), e);
    for (const std::uint32_t vertex : body_.elements[e]) {
      report.mass += quarter;
      report.momentum += velocity_of(vertex) * quarter;
    }
  }
  const auto [kinetic, elastic] = energy_of(elements);
  report.tets += elements.size();
  report.energy = kinetic + elastic;
  if (options_.track_energies) take_out(kinetic, elastic);
}

/// Of what is held and of the body as it is now.
std::uint64_t Scheme::fingerprint() const {
  std::uint64_t hash = hash_numbers(std::span<const double>(body_.masses));
  for (const Tet& t : body_.elements) hash = hash_numbers(std::span<const std::uint32_t>(t), hash);
  for (const Constraint& c : constraints_.all()) {
    hash = hash_numbers(std::span<const std::uint32_t>(c.vertices), hash);
    const std::array<double, 4> how{c.axes.x ? 1.0 : 0.0, c.axes.y ? 1.0 : 0.0, c.axes.z ? 1.0 : 0.0, c.from};
    hash = hash_numbers(std::span<const double>(how), hash);
  }
  return hash;
}

void Scheme::save(CheckpointWriter& out) const {
  out.put(fingerprint());
  out.put(time_);
  out.put(steps_);
  for (const std::vector<Vec3d>& base : base_) out.put(base);
}

void Scheme::load(CheckpointReader& in) {
  if (in.get<std::uint64_t>() != fingerprint()) CheckpointReader::fail();
  in.get(time_);
  in.get(steps_);
  for (std::size_t c = 0; c < base_.size(); ++c) {
    in.get(base_[c]);
    if (!base_[c].empty() && base_[c].size() != constraints_.all()[c].vertices.size()) CheckpointReader::fail();
  }
}

void Scheme::change(const BodyChange& change) {
  if (change.touched.empty()) return;
  gamma_.resize(body_.vertex_count);
  for (const std::uint32_t v : change.touched) {
    gamma_[v] = options_.damping_rate * body_.masses[v] + options_.nodal_damping;
  }
  take_over(change);
}

RemovalReport Scheme::remove(std::span<const std::uint32_t> tets) {
  RemovalReport report;
  const std::vector<std::uint32_t> elements = changer().living_elements(tets);
  weigh_energy(elements, report);
  const BodyChange removal = changer_->remove(elements);
  change(removal);
  for (const std::uint32_t v : removal.touched) {
    if (changer_->stars().tets_at(v).empty()) report.loose_vertices.push_back(v);
  }
  return report;
}

/// Lets motions that hold moved vertices count from where these are now.
void Scheme::move_bases(std::span<const MovedVertex> moved) {
  for (const MovedVertex& m : moved) {
    for (std::size_t c = 0; c < base_.size(); ++c) {
      if (!holds(c)) continue;
      const std::vector<std::uint32_t>& held = constraints_.all()[c].vertices;
      const auto at = std::find(held.begin(), held.end(), m.vertex) - held.begin();
      if (at < std::ssize(held)) base_[c][static_cast<std::size_t>(at)] += m.displacement - displacement_of(m.vertex);
    }
  }
}

SplitReport Scheme::split(std::span<const Triangle> faces, std::span<const VertexMove> moves) {
  SplitReport report{.first_new = static_cast<std::uint32_t>(body_.vertex_count), .origins = {}, .closed_faces = 0};
  const StateOf state = [this](std::uint32_t v) { return std::pair{displacement_of(v), velocity_of(v)}; };
  const bool booked = options_.track_energies && !moves.empty();
  const std::vector<std::uint32_t> around = booked ? changer().elements_around(moves) : std::vector<std::uint32_t>{};
  const std::array<double, 2> before = energy_of(around);
  BodyChange opening = changer().cut(faces, moves, state);
  move_bases(opening.moved);
  change(opening);
  const std::array<double, 2> after = energy_of(around);
  if (booked) take_out(before[0] - after[0], before[1] - after[1]);
  copies_.insert(copies_.end(), opening.origins.begin(), opening.origins.end());
  const std::vector<std::vector<std::size_t>> copied = constraints_.add_copies(opening.origins);
  loads_.add_copies(opening.origins);
  for (std::size_t c = 0; c < copied.size(); ++c) {
    for (const std::size_t k : copied[c]) {
      if (holds(c)) base_[c].push_back(Vec3d(base_[c][k]));
    }
  }
  if (!opening.origins.empty()) follow(opening.origins, report.first_new);
  last_changed_.clear();
  for (const detail::CornerChange& c : opening.corners) last_changed_.push_back(c.tet);
  report.closed_faces = changer_->closed_faces();
  report.origins = std::move(opening.origins);
  return report;
}

}  // namespace glisson
