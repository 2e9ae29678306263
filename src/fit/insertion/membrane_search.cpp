#include "fit/insertion/membrane_search.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace glisson::fit {
namespace {

constexpr const char* kTooEarly =
    "interrupted before two runs of the needle were done: nothing is known of its membranes";
constexpr double kNearer = 0.98;  ///< of the least rms so far: a run that comes nearer
constexpr int kMostInVain = 3;
constexpr double kShare = 0.8;  ///< of a force that is missing: the next run's rise is not quite this one's, moved

double rms_of(const InsertionRun& run, const ForceCurve& measured, const std::vector<double>& grid) {
  double squares = 0.0;
  for (const double x : grid) squares += std::pow(simulated_force(run, x) - measured.at(x), 2);
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(grid.size(), 1)));
}

class Search {
 public:
  Search(const MeasuredInsertion& measured, const InsertionSpec& spec, const InsertionScene& scene)
      : measured_(measured), spec_(spec), stations_(stations_of(measured, spec)) {
    const ShaftFriction& f = scene.needle().friction;
    friction_ = f.dynamic_in + f.viscous_in * scene.speed();
  }
  const std::vector<Station>& stations() const { return stations_; }
  void guess(const InsertionRun& bare);
  void correct(const InsertionRun& run, const std::vector<double>& grid);

 private:
  void correct_gap(const InsertionRun& run, const std::vector<double>& grid, std::size_t first, std::size_t last,
                   std::size_t drop);
  void correct_piece(Station& s, const InsertionRun& run, const std::optional<double>& error, double level);
  std::size_t next_drop(std::size_t after) const;
  void round();

  const MeasuredInsertion& measured_;
  const InsertionSpec& spec_;
  std::vector<Station> stations_;
  double friction_;  ///< of the shaft that slips [N/m]
};

std::size_t Search::next_drop(std::size_t after) const {
  std::size_t i = after + 1;
  while (i < stations_.size() && !stations_[i].peak) ++i;
  return i;
}

/// How far the surface had yielded at a force before it broke; beyond, along its last slope.
double yielded(const InsertionRun& bare, double force) {
  const RiseEnd end = rise_end(bare, bare.puncture);
  if (force >= end.force) return bare.puncture - bare.contact + (force - end.force) / end.slope;
  double x = bare.contact;
  while (x < bare.puncture && bare.curve.at(x) < force) x += 1e-5;
  return x - bare.contact;
}

/// To 0.01 mm and 1 mN, as a scene is to have them.
void Search::round() {
  const auto to = [](double x, double unit) { return unit * std::round(x / unit); };
  double before = -1.0;
  for (Station& s : stations_) {
    if (s.cutting) s.cutting = to(*s.cutting, 1e-3);
    s.puncture = to(s.puncture, 1e-3);
    if (!s.peak && !s.cutting) continue;
    s.depth = before = std::max(to(s.depth, 1e-5), before + 1e-5);
  }
}

void Search::guess(const InsertionRun& bare) {
  double before = 0.0;
  for (std::size_t i = next_drop(0); i < stations_.size(); i = next_drop(i)) {
    Station& s = stations_[i];
    s.depth = std::max(before + 1e-4, s.position - bare.contact - yielded(bare, *s.peak));
    s.puncture = *s.peak - friction_ * s.depth;
    before = s.depth;
  }
  round();
}

/// How far the tissue at the tip had yielded below the surface where the force was nearest to a given one [m].
double yielded_inside(const InsertionRun& run, double force) {
  double least = std::numeric_limits<double>::infinity(), way = 0.0;
  for (std::size_t i = 0; i < run.depth.size(); ++i) {
    const double off = std::abs(run.curve.force[i] - force);
    if (!(run.depth[i] > 0.0) || off >= least) continue;
    least = off;
    way = run.curve.position[i] - run.contact - run.depth[i];
  }
  return way;
}

/// A piece that begins to count lies where the tip will be at its position, under its force; then it follows.
void Search::correct_piece(Station& s, const InsertionRun& run, const std::optional<double>& error, double level) {
  if (!error) {
    s.cutting.reset();
    return;
  }
  const double there = std::max(0.0, s.position - run.contact - yielded_inside(run, level));
  if (!s.peak && &s != &stations_.front()) {
    s.depth = s.cutting ? s.depth + s.position - run.reached(s.depth) : there;
  }
  s.cutting = std::max(0.0, s.cutting ? *s.cutting + *error : level - friction_ * there);
}

void Search::correct_gap(const InsertionRun& run, const std::vector<double>& grid, std::size_t first, std::size_t last,
                         std::size_t drop) {
  const GapAim aim = aim_between(stations_, first, last, drop, measured_, grid, run, spec_);
  for (std::size_t p = first; p < last; ++p) correct_piece(stations_[p], run, aim.cut[p - first], aim.level[p - first]);
  if (!aim.peak) return;
  Station& s = stations_[last];
  if (drop > run.inner.size()) {  // it was not reached
    s.depth -= 1e-3;
    return;
  }
  const RiseEnd end = rise_end(run, run.inner[drop - 1]);
  const double more = kShare * (*aim.peak - end.force);
  s.depth += s.position - run.inner[drop - 1] - more / end.slope;
  s.puncture = std::max(0.0, s.puncture + more);
}

void Search::correct(const InsertionRun& run, const std::vector<double>& grid) {
  std::size_t drop = 0;
  for (std::size_t i = 0; i < stations_.size(); i = next_drop(i)) correct_gap(run, grid, i, next_drop(i), ++drop);
  constexpr double kApart = 5e-5;  // [m]
  double before = 0.0;
  for (std::size_t i = next_drop(0); i < stations_.size(); i = next_drop(i))
    before = stations_[i].depth = std::max(stations_[i].depth, before + 1e-4);
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t i = stations_.size(); i-- > 1;) {  // a piece lies before the membrane that follows it
    if (!stations_[i].peak && !stations_[i].cutting) continue;
    if (!stations_[i].peak) stations_[i].depth = std::max(0.0, std::min(stations_[i].depth, limit - kApart));
    limit = stations_[i].depth;
  }
  round();
}

}  // namespace

double simulated_force(const InsertionRun& run, double x) {
  return x < run.curve.position.front() ? 0.0 : run.curve.at(x);
}

MembraneFit fit_membranes(const MeasuredInsertion& measured, const InsertionSpec& spec, const InsertionScene& scene,
                          const std::atomic<bool>& stop, const std::function<void(int, double)>& progress) {
  const std::optional<InsertionRun> first = scene.run({scene.needle().tip.cutting, {}}, stop);
  if (!first) throw std::runtime_error(kTooEarly);
  const InsertionRun& bare = *first;
  if (!std::isfinite(bare.puncture)) throw std::runtime_error("the needle does not pierce the surface in this scene");
  const std::vector<double> grid = measured.grid(spec, bare.curve.position.back());
  MembraneFit best{{}, {}, bare, grid, std::numeric_limits<double>::infinity(), rms_of(bare, measured.curve, grid), 1};
  progress(1, best.rms_before);
  Search search(measured, spec, scene);
  search.guess(bare);
  int in_vain = 0;  // runs that did not come nearer
  while (best.runs < spec.runs && in_vain < kMostInVain && !stop) {
    const TipProfile profile = profile_of(search.stations());
    const std::optional<InsertionRun> run = scene.run(profile, stop);
    if (!run) break;
    const double rms = rms_of(*run, measured.curve, grid);
    progress(++best.runs, rms);
    in_vain = rms < kNearer * best.rms ? 0 : in_vain + 1;
    if (rms < best.rms) best = {search.stations(), profile, *run, grid, rms, best.rms_before, best.runs};
    search.correct(*run, grid);
  }
  if (best.stations.empty()) throw std::runtime_error(kTooEarly);
  return best;
}

}  // namespace glisson::fit
