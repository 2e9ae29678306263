#include "mesh/cut/star_moves.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "mesh/topology/buckets.h"

namespace glisson::detail {
namespace {

constexpr int kSweeps = 8;  // 20 save one or two copies in a thousand more

/// What a move brings; compared in this order.
struct Gain {
  std::int64_t copies = 0;   // vertex copies saved
  std::int64_t compact = 0;  // half the growth of Σ (tets of a part at a vertex)²
  bool operator>(const Gain& other) const {
    return copies > other.copies || (copies == other.copies && compact > other.compact);
  }
};

class StarMover {
 public:
  StarMover(std::span<const Tet> tets, std::size_t vertices, std::size_t parts, double slack,
            std::vector<std::uint32_t>& part)
      : tets_(tets), part_(part), size_(parts, 0) {
    stars_ = make_buckets<std::uint32_t>(vertices, [&](const auto& sink) {
      for (std::uint32_t t = 0; t < tets.size(); ++t) {
        for (const std::uint32_t v : tets[t]) sink(v, t);
      }
    });
    for (const std::uint32_t p : part) ++size_[p];
    const double mean = static_cast<double>(tets.size()) / static_cast<double>(parts);
    least_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::floor(mean * (1.0 - slack))));
    most_ = static_cast<std::size_t>(std::floor(mean * (1.0 + slack))) + 1;
  }

  /// Tries every star once; returns how many moved.
  std::size_t sweep() {
    std::size_t moved = 0;
    for (std::size_t v = 0; v + 1 < stars_.begin.size(); ++v) {
      find_parts_at(v);
      if (here_.size() < 2) continue;
      for (const std::uint32_t from : here_) moved += try_move(v, from);
    }
    return moved;
  }

 private:
  void find_parts_at(std::size_t v) {
    here_.clear();
    for (const std::uint32_t t : stars_.bucket(v)) {
      if (std::find(here_.begin(), here_.end(), part_[t]) == here_.end()) here_.push_back(part_[t]);
    }
  }

  /// A part that has most of the tets at a vertex keeps them: moving them away hardly ever gains.
  bool is_minority(std::size_t v, std::uint32_t part) {
    return 2 * tets_of(part, v) <= static_cast<std::int64_t>(stars_.bucket(v).size());
  }

  /// The tets of `from` at v, and how many of them are at each of their vertices.
  void collect_star(std::size_t v, std::uint32_t from) {
    star_.clear();
    corners_.clear();
    for (const std::uint32_t t : stars_.bucket(v)) {
      if (part_[t] != from) continue;
      star_.push_back(t);
      for (const std::uint32_t u : tets_[t]) {
        const auto known =
            std::find_if(corners_.begin(), corners_.end(), [&](const Corner& c) { return c.vertex == u; });
        if (known == corners_.end()) {
          corners_.push_back({u, 1, tets_of(from, u)});
        } else {
          ++known->moving;
        }
      }
    }
  }

  std::int64_t tets_of(std::uint32_t part, std::size_t vertex) {
    const auto star = stars_.bucket(vertex);
    return std::count_if(star.begin(), star.end(), [&](std::uint32_t t) { return part_[t] == part; });
  }

  Gain gain_of_move_to(std::uint32_t part) {
    Gain gain;
    for (const Corner& c : corners_) {
      const std::int64_t there = tets_of(part, c.vertex);
      gain.copies += (c.moving == c.of_part) - (there == 0);
      gain.compact += c.moving * (there - (c.of_part - c.moving));
    }
    return gain;
  }

  bool try_move(std::size_t v, std::uint32_t from) {
    if (!is_minority(v, from)) return false;
    collect_star(v, from);
    if (star_.empty() || size_[from] < least_ + star_.size()) return false;
    Gain best;  // a move must beat none
    std::optional<std::uint32_t> target;
    for (const std::uint32_t part : here_) {
      if (part == from || size_[part] + star_.size() > most_) continue;
      const Gain gain = gain_of_move_to(part);
      if (gain > best) best = gain, target = part;
    }
    if (!target) return false;
    for (const std::uint32_t t : star_) part_[t] = *target;
    size_[from] -= star_.size();
    size_[*target] += star_.size();
    return true;
  }

  struct Corner {
    std::uint32_t vertex;
    std::int64_t moving, of_part;  // tets of the star at the vertex; all tets of its part there
  };

  std::span<const Tet> tets_;
  std::vector<std::uint32_t>& part_;
  std::vector<std::size_t> size_;
  std::size_t least_ = 0, most_ = 0;
  Buckets<std::uint32_t> stars_;
  std::vector<std::uint32_t> here_, star_;  // parts at a vertex; tets that would move
  std::vector<Corner> corners_;
};

}  // namespace

void move_stars(std::span<const Tet> tets, std::size_t vertices, std::size_t parts, double slack,
                std::vector<std::uint32_t>& part) {
  if (parts < 2) return;
  StarMover mover(tets, vertices, parts, slack, part);
  for (int sweep = 0; sweep < kSweeps && mover.sweep() > 0; ++sweep) {
  }
}

}  // namespace glisson::detail
