#include "fit/insertion/insertion_run.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace glisson::fit {
namespace {

class InsertionRecorder final : public RunObserver {
 public:
  InsertionRecorder(InsertionRun& run, std::size_t tool, std::string name, double start)
      : run_(run), tool_(tool), name_(std::move(name)), start_(start) {}
  void on_built(const BuiltVariant& built) override {
    needle_ = dynamic_cast<const Needle*>(built.instruments[tool_].get());
  }
  void on_sample(const Sample&) override {
    const double x = start_ + needle_->force_depth();
    if (!run_.curve.position.empty() && !(x > run_.curve.position.back())) return;  // on its way in alone
    run_.curve.position.push_back(x);
    run_.curve.force.push_back(-dot(needle_->sensor_force(), needle_->direction()));
    run_.depth.push_back(needle_->path_length());
  }
  void on_event(const RunEvent& e) override {
    if (e.instrument != name_) return;
    const double x = start_ + e.what.depth;
    if (e.what.event == "contact" && run_.contact == 0.0) run_.contact = x;
    if (e.what.event == "puncture") run_.puncture = x;
    if (e.what.event == "inner puncture") run_.inner.push_back(x);
  }

 private:
  InsertionRun& run_;
  std::size_t tool_;
  std::string name_;
  double start_;
  const Needle* needle_ = nullptr;
};

std::size_t index_of_needle(const Variant& v, const std::string& name) {
  if (name.empty() && v.instruments.size() != 1)
    throw std::invalid_argument("[insertion] needs a scene with one instrument, or its name: `instrument`");
  for (std::size_t i = 0; i < v.instruments.size(); ++i) {
    const InstrumentSpec& x = v.instruments[i];
    if (!name.empty() && x.name != name) continue;
    if (!std::holds_alternative<NeedleOptions>(x.what)) break;
    const bool other = !x.regions.empty() || std::get<NeedleOptions>(x.what).drawn_membranes;
    if (!other) return i;
    throw std::invalid_argument(
        "the needle \"" + x.name +
        "\" has `regions` or `drawn_membranes`, which would hold the tip in addition to the membranes "
        "that are fitted; remove them");
  }
  throw std::invalid_argument("the scene has no needle" + (name.empty() ? "" : " \"" + name + "\""));
}

}  // namespace

double InsertionRun::reached(double rest_depth) const {
  constexpr double kThere = 1e-6;  // [m]
  const auto at = std::lower_bound(depth.begin(), depth.end(), rest_depth - kThere);
  return at == depth.end() ? curve.position.back() : curve.position[static_cast<std::size_t>(at - depth.begin())];
}

InsertionScene::InsertionScene(Variant variant, const InsertionSpec& spec, MeshLoader load)
    : variant_(std::move(variant)), load_(std::move(load)), index_(index_of_needle(variant_, spec.instrument)),
      start_(spec.start) {
  variant_.output.frames = 0;
  variant_.simulation.track_energies = false;
}

double InsertionScene::speed() const {
  const auto* press = std::get_if<PressMotion>(&variant_.instruments[index_].motion.how);
  if (press == nullptr) throw std::invalid_argument("[insertion] needs a needle whose motion is of the kind \"press\"");
  return press->velocity;
}

std::optional<InsertionRun> InsertionScene::run(const TipProfile& profile, const std::atomic<bool>& stop) const {
  Variant v = variant_;
  auto& options = std::get<NeedleOptions>(v.instruments[index_].what);
  options.tip.cutting = profile.cutting;
  options.membranes = profile.membranes;
  InsertionRun run;
  run.puncture = std::numeric_limits<double>::infinity();
  InsertionRecorder recorder(run, v.tools.size() + index_, v.instruments[index_].name, start_);
  const RunSummary summary = run_variant(v, load_, recorder, stop);
  if (summary.end == RunSummary::End::interrupted) return std::nullopt;
  if (summary.end != RunSummary::End::finished)
    throw std::runtime_error("a run of the needle stopped at " + std::to_string(summary.time_s) +
                             " s: " + summary.trouble);
  return run;
}

}  // namespace glisson::fit
