// hand_cut.cpp — see hand_cut.h.
#include "view/engine/hand_cut.h"

#include <algorithm>

namespace glisson::view {
namespace {

constexpr std::size_t kMostPieces = 256;  // that wait: four seconds of a page's strokes

}  // namespace

void HandCut::begin(const BladeEdge& edge) {
  lost_ = pieces_.size() >= kMostPieces;
  if (!lost_) pieces_.push_back({edge, true});
}

void HandCut::draw(const BladeEdge& edge) {
  if (lost_) return;
  if (pieces_.size() >= kMostPieces && !pieces_.back().begins) {
    pieces_.back().edge = edge;
  } else {
    pieces_.push_back({edge, false});
  }
}

void HandCut::go_back(const Kept& kept) {
  cutter_.load_state(kept.cutter);
  area_ = kept.area;
  pieces_.clear();
  lost_ = true;
}

bool HandCut::work(Clock::time_point now) {
  if (pieces_.empty() || now < next_) return false;
  const Piece piece = pieces_.front();
  pieces_.pop_front();
  CutReport report;
  if (piece.begins) {
    cutter_.place(piece.edge);
  } else {
    report = cutter_.advance(piece.edge);
  }
  area_ += report.area;
  const Clock::time_point end = Clock::now();
  longest_ = std::max(longest_, std::chrono::duration<double>(end - now).count());
  next_ = end + (end - now);
  return report.faces > 0;
}

}  // namespace glisson::view
