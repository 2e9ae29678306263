// insertion_run.h — the scene's own insertion at given membranes: force and place of the tip over its position.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "fit/insertion/measured_insertion.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {

/// What holds the tip back below the surface.
struct TipProfile {
  double cutting = 0.0;                  ///< from the surface on [N]
  std::vector<InnerMembrane> membranes;  ///< by ascending depth
};

struct InsertionRun {
  ForceCurve curve;           ///< over the measurement's position
  std::vector<double> depth;  ///< of the tip in tissue at rest, per point of the curve [m]
  double contact = 0.0;       ///< position of the tip there [m]
  double puncture = 0.0;      ///< of the surface [m]; infinite where it held
  std::vector<double> inner;  ///< positions of the inner punctures [m]

  /// Where the tip reached a depth in tissue at rest [m]; the end of the run where it did not.
  double reached(double rest_depth) const;
};

/// A needle's insertion in a scene, for many runs.
class InsertionScene {
 public:
  /// @throws std::invalid_argument where the variant has no such needle, or one whose regions hold the tip, too
  InsertionScene(Variant variant, const InsertionSpec& spec, MeshLoader load);

  const NeedleOptions& needle() const { return std::get<NeedleOptions>(variant_.instruments[index_].what); }
  double speed() const;  ///< of the insertion [m/s]
  /// None where `stop` ended it. @throws std::runtime_error where the run does not come to its end by itself
  std::optional<InsertionRun> run(const TipProfile& profile, const std::atomic<bool>& stop) const;

 private:
  Variant variant_;
  MeshLoader load_;
  std::size_t index_ = 0;
  double start_;
};

}  // namespace glisson::fit
