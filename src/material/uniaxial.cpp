#include "material/uniaxial.h"

#include <cmath>

namespace glisson {
namespace {

Mat3<Dual> stretched(Dual lateral, double stretch) {
  Mat3<Dual> H;
  H(0, 0) = H(1, 1) = lateral - Dual(1.0);
  H(2, 2) = stretch - 1.0;
  return H;
}

}  // namespace

UniaxialState uniaxial_state(const Response& response, double stretch) {
  constexpr int kSteps = 60;
  const ElementShape shape;
  double low = 0.05, high = 20.0, lateral = 1.0 / std::sqrt(stretch);
  UniaxialState state;
  // Newton, kept between the bounds that the sign of the lateral stress gives
  for (int i = 0; i < kSteps; ++i) {
    const Mat3<Dual> P = response.elastic(stretched(Dual(lateral, 1.0), stretch), shape);
    const Dual side = P(0, 0);
    state = {P(2, 2).v, lateral, std::isfinite(side.v)};
    (side.v > 0.0 ? high : low) = lateral;
    const double next = lateral - side.v / side.d;
    const double move = (next > low && next < high ? next : 0.5 * (low + high)) - lateral;
    lateral += move;
    if (std::abs(move) < 1e-13 * lateral) return state;
  }
  state.converged = high - low < 1e-6;
  return state;
}

}  // namespace glisson
