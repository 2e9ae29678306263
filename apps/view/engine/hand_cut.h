// hand_cut.h — a blade led by hand: a stroke over the picture, swept through the tissue piece by piece.
//
//   eye ────────────── edge: along a line of sight, from before the surface to the chosen depth
//       ╲
//        ╲  stroke     begin ─▶ draw ─▶ draw …   one piece at a time, then as long again for frames
//         ╲
// A piece may take longer than a frame of 1 ms (docs/cutting.md). After each the body is left alone for as long as it took,
// so that cutting takes half of the time at most; what comes in between waits, and what does not find room makes the
// stroke straighter, not longer.
#pragma once

#include <chrono>
#include <deque>
#include <memory>

#include "glisson/instruments/cutting.h"

namespace glisson::view {

class HandCut {
 public:
  using Clock = std::chrono::steady_clock;
  /// @param simulation  must outlive this @throws std::invalid_argument where it cannot be cut
  explicit HandCut(Simulation& simulation) : cutter_(simulation) {}

  void begin(const BladeEdge& edge);  ///< of another stroke: the blade is there, nothing is cut yet
  void draw(const BladeEdge& edge);   ///< on from where the last one ended
  bool waits() const { return !pieces_.empty(); }
  /// Makes the next piece of the stroke, where it is due.
  /// @return whether the body is another @throws std::invalid_argument where the library refuses; nothing is changed then
  bool work(Clock::time_point now);

  /// What goes with the body where that goes back in time; what waits does not.
  struct Kept {
    std::shared_ptr<const void> cutter;
    double area = 0.0;
  };
  Kept keep() const { return {cutter_.save_state(), area_}; }
  void go_back(const Kept& kept);

  double area() const { return area_; }        ///< cut so far, at rest [m²]
  double longest() const { return longest_; }  ///< that a piece has taken [s]

 private:
  struct Piece {
    BladeEdge edge;
    bool begins = false;
  };
  Cutter cutter_;
  std::deque<Piece> pieces_;
  bool lost_ = true;  ///< no stroke has begun that a piece could belong to
  Clock::time_point next_{};
  double area_ = 0.0, longest_ = 0.0;
};

}  // namespace glisson::view
