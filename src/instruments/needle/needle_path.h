// needle_path.h — the path of a needle as the stretches of tissue that it crosses.
//
//            first track                          second track
//   hand ──┤P₀····P₁····P₂····P₃├───────────────┤P₄····P₅····▶ tip          P₀, P₄: where it went in
//                              came out                                     P₃: where it came out
//
// A track is a list of points of the tissue: the one where the needle went in, one every `spacing`, and the one where it came out. They
// move with the tissue, so that a stretch reaches, in the deformed body, from where its first point is to where its last one is, or
// to the tip. All tracks but the last are open at both ends; the tip acts at the end of the last one, as long as that is in tissue.
// `entered` counts the tracks before the tip. Those beyond it are holes, which the tip finds again where it meets their first point.
#pragma once

#include <cstddef>
#include <vector>

#include "contact/shaft_block.h"
#include "glisson/archive.h"
#include "instruments/needle/tissue_zone.h"

namespace glisson {

/// A stretch of tissue on the path: the nodes from `begin` up to those of the next one. The first is where the needle went in.
struct Track {
  std::size_t begin = 0;
  bool through =
      false;  ///< the last node is where it came out; otherwise the tip's row is the end. Of all tracks but the last
  void archive(Archive& ar) { ar(begin, through); }
};

/// The points of a path.
struct NeedlePath {
  std::vector<shaft::Row> nodes;  ///< from the first surface on
  std::vector<char> slips;        ///< per node
  std::vector<double> along;      ///< per node: impulse along the needle in the last step [N s]
  std::vector<Vec3d> bend;        ///< of the needle at each node [m]
  std::vector<Track> tracks;      ///< the stretches of tissue that it crosses, from the hand on

  void add_node(shaft::Row node, const Vec3d& bent);
  std::size_t end_of(std::size_t track) const {
    return track + 1 < tracks.size() ? tracks[track + 1].begin : nodes.size();
  }
  std::size_t track_of(std::size_t node) const;
  void forget_from(std::size_t track);
};

}  // namespace glisson
