#include "contact/island.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson {
namespace {

constexpr double kThin = 1e-6;         ///< of the thinnest solid: rows that move by less have been solved …
constexpr double kEnoughAlone = 1e-9;  ///< … or so much, where all are half-spaces or there are no points [m]
constexpr double kSoftness = 0.05;     ///< compliance by which rows yield that cannot all be met, over a point's own

}  // namespace

double Island::enough() const {
  double thinnest = std::numeric_limits<double>::infinity();  // half-spaces have no thickness
  for (const ContactRow* row : points) thinnest = std::min(thinnest, row->solid->traits.thickness);
  return std::isfinite(thinnest) ? kThin * thinnest : kEnoughAlone;
}

void Island::soften() {
  for (ContactRow* row : points) row->softness = kSoftness, row->solved_at = 0;
  for (HoldRow* row : holds) row->softness = kSoftness, row->solved_at = 0;
}

}  // namespace glisson
