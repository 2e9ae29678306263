// split_faces.cpp — finds the groups of tets around each vertex of a crack, one vertex after the other.
//
// All groups are found in the numbers before the split. So vertices do not depend on each other, and the order in
// which they are visited shows in nothing but the numbers of the copies.
#include "mesh/cut/split_faces.h"
#include "mesh/topology/faces.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

#include "base/text.h"

namespace glisson::detail {
namespace {

constexpr std::uint32_t kSplit = ~0u;

struct Crack {
  Triangle face;                       // ascending
  std::array<std::uint32_t, 2> sides;  // its tets
  Triangle after;                      // the face in the numbers after the split, while it is closed
  bool open = false;                   // some vertex differs between its sides
};

/// The first two tets that hold a face and how many there are.
struct Sides {
  std::array<std::uint32_t, 2> tets{};
  std::size_t count = 0;
};

Sides sides_of(std::span<const Tet> tets, const VertexStars& stars, const Triangle& face) {
  Sides sides;
  for (const std::uint32_t t : stars.tets_at(face[0])) {
    if (!holds(tets[t], face[1]) || !holds(tets[t], face[2])) continue;
    if (sides.count < 2) sides.tets[sides.count] = t;
    ++sides.count;
  }
  return sides;
}

[[noreturn]] void refuse(const Triangle& face, const std::string& fault) {
  throw std::invalid_argument("split: face (" + index_list(face) + ") " + fault);
}

void require_three_vertices(const Triangle& face, std::size_t vertices) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (face[i] >= vertices) {
      refuse(face, "refers to vertex " + std::to_string(face[i]) + ", but the mesh has " +
                       count_text(vertices, "vertex", "vertices") + ", numbered from 0");
    }
    if (face[i] == face[(i + 1) % 3]) {
      refuse(face, "holds vertex " + std::to_string(face[i]) + " twice; give three different vertices");
    }
  }
}

void require_inner(const Triangle& face, const Sides& sides) {
  if (sides.count == 0) {
    refuse(face, "belongs to no tet; give three vertices of one tet, in the numbers that earlier splits gave them");
  }
  if (sides.count == 1) {
    refuse(face, "belongs to tet " + std::to_string(sides.tets[0]) +
                     " alone: at the boundary there is nothing to split; leave it out");
  }
  if (sides.count > 2) {
    refuse(face, "is shared by " + std::to_string(sides.count) +
                     " tets, but a face has two sides; inspect() counts such faces, repair the mesh before it is cut");
  }
}

Triangle ascending(Triangle face) {
  std::sort(face.begin(), face.end());
  return face;
}

/// All faces that part tets, the new ones and those closed so far, each once and in ascending order.
std::vector<Crack> find_cracks(std::span<const Tet> tets, const VertexStars& stars, std::span<const Triangle> faces,
                               std::span<const Triangle> closed) {
  std::vector<Crack> cracks;
  cracks.reserve(faces.size() + closed.size());
  const auto add = [&](const Triangle& face, const Sides& sides) {
    cracks.push_back({ascending(face), sides.tets, ascending(face)});
  };
  for (const Triangle& face : faces) {
    require_three_vertices(face, stars.vertices());
    const Sides sides = sides_of(tets, stars, face);
    require_inner(face, sides);
    add(face, sides);
  }
  for (const Triangle& face : closed) {
    require_three_vertices(face, stars.vertices());
    if (const Sides sides = sides_of(tets, stars, face); sides.count == 2) add(face, sides);
  }
  std::sort(cracks.begin(), cracks.end(), [](const Crack& a, const Crack& b) { return a.face < b.face; });
  const auto same_face = [](const Crack& a, const Crack& b) { return a.face == b.face; };
  cracks.erase(std::unique(cracks.begin(), cracks.end(), same_face), cracks.end());
  return cracks;
}

/// Two vertices as one number, never 0: around a vertex they tell a face.
std::uint64_t pair_key(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

/// A hash table of faces around a vertex; cleared for the next vertex in less time than sorting its faces takes.
class FaceTable {
 public:
  void clear(std::size_t most_faces) {
    slots_.assign(std::bit_ceil(2 * most_faces + 2), {0, 0});
    shift_ = 64 - std::countr_zero(slots_.size());
  }

  /// The value first given for this key.
  std::uint32_t first(std::uint64_t key, std::uint32_t value) {
    std::size_t i = key * 0x9E3779B97F4A7C15u >> shift_;  // 2⁶⁴ over the golden ratio
    while (slots_[i].key != 0 && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
    if (slots_[i].key == 0) slots_[i] = {key, value};
    return slots_[i].value;
  }

 private:
  struct Slot {
    std::uint64_t key;
    std::uint32_t value;
  };
  std::vector<Slot> slots_;
  int shift_ = 0;
};

/// The tets around a vertex, by position in its star, in groups connected by faces that are not split.
class StarGroups {
 public:
  /// Call clear, split for each split face, then connect.
  void clear(std::size_t star_size) {
    first_.resize(star_size);
    for (std::uint32_t i = 0; i < star_size; ++i) first_[i] = i;
    faces_.clear(3 * star_size);
  }

  void split(std::uint64_t face) { faces_.first(face, kSplit); }

  void connect(std::span<const Tet> tets, std::span<const std::uint32_t> star, std::uint32_t vertex) {
    for (std::uint32_t i = 0; i < star.size(); ++i) {
      const Tet& tet = tets[star[i]];
      const std::size_t c = corner_of(tet, vertex);
      const std::uint32_t x = tet[(c + 1) % 4], y = tet[(c + 2) % 4], z = tet[(c + 3) % 4];
      for (const std::uint64_t face : {pair_key(x, y), pair_key(y, z), pair_key(z, x)}) {
        const std::uint32_t other = faces_.first(face, i);
        if (other != kSplit) unite(other, i);
      }
    }
    for (std::uint32_t& first : first_) first = first_[first];  // ascending: the lower ones are settled
  }

  /// The lowest position in the group of each: positions ascend with tet numbers.
  const std::vector<std::uint32_t>& first() const { return first_; }

 private:
  std::uint32_t root(std::uint32_t i) const {
    while (first_[i] != i) i = first_[i];
    return i;
  }

  void unite(std::uint32_t i, std::uint32_t j) {
    const auto [low, high] = std::minmax({root(i), root(j)});
    first_[high] = low;
  }

  FaceTable faces_;
  std::vector<std::uint32_t> first_;
};

/// One vertex of a split face.
struct Use {
  std::uint32_t vertex, crack;
};

std::vector<Use> uses_of(std::span<const Crack> cracks) {
  std::vector<Use> uses;
  uses.reserve(3 * cracks.size());
  for (std::uint32_t c = 0; c < cracks.size(); ++c) {
    for (const std::uint32_t v : cracks[c].face) uses.push_back({v, c});
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
    return a.vertex < b.vertex || (a.vertex == b.vertex && a.crack < b.crack);
  });
  return uses;
}

class Planner {
 public:
  Planner(std::span<const Tet> tets, const VertexStars& stars, std::uint32_t first_new, std::vector<Crack> cracks)
      : tets_(tets), stars_(stars), first_new_(first_new), cracks_(std::move(cracks)) {}

  SplitPlan plan() {
    const std::vector<Use> uses = uses_of(cracks_);
    for (std::size_t i = 0, end = 0; i < uses.size(); i = end) {
      while (end < uses.size() && uses[end].vertex == uses[i].vertex) ++end;
      visit(uses[i].vertex, std::span(uses).subspan(i, end - i));
    }
    for (const Crack& crack : cracks_) {
      if (!crack.open) plan_.closed.push_back(crack.after);
    }
    return std::move(plan_);
  }

 private:
  /// @param uses  all split faces at this vertex
  void visit(std::uint32_t vertex, std::span<const Use> uses) {
    const auto star = stars_.tets_at(vertex);
    groups_.clear(star.size());
    for (const Use& use : uses) groups_.split(opposite(cracks_[use.crack].face, vertex));
    groups_.connect(tets_, star, vertex);
    number_groups(vertex);
    for (std::size_t i = 0; i < star.size(); ++i) {
      if (number(i) != vertex) plan_.corners.push_back({star[i], corner_of(tets_[star[i]], vertex), number(i)});
    }
    for (const Use& use : uses) follow(star, vertex, cracks_[use.crack]);
  }

  static std::uint64_t opposite(const Triangle& face, std::uint32_t vertex) {
    const auto& [a, b, c] = face;
    return vertex == a ? pair_key(b, c) : vertex == b ? pair_key(c, a) : pair_key(a, b);
  }

  /// The largest group keeps the vertex, each other one gets a new one. Groups go by their lowest position.
  void number_groups(std::uint32_t vertex) {
    const auto& first = groups_.first();
    sizes_.assign(first.size(), 0);
    for (const std::uint32_t f : first) ++sizes_[f];
    const auto kept = std::max_element(sizes_.begin(), sizes_.end()) - sizes_.begin();
    numbers_.assign(first.size(), vertex);
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (sizes_[i] == 0 || static_cast<std::ptrdiff_t>(i) == kept) continue;
      numbers_[i] = first_new_ + static_cast<std::uint32_t>(plan_.origins.size());
      plan_.origins.push_back(vertex);
    }
  }

  /// What the vertex becomes for the tet at this position in its star.
  std::uint32_t number(std::size_t position) const { return numbers_[groups_.first()[position]]; }

  /// Renames the vertex in a split face, which is open once the two sides differ.
  void follow(std::span<const std::uint32_t> star, std::uint32_t vertex, Crack& crack) const {
    const auto number_for = [&](std::uint32_t tet) {
      return number(static_cast<std::size_t>(std::lower_bound(star.begin(), star.end(), tet) - star.begin()));
    };
    const std::uint32_t one = number_for(crack.sides[0]), two = number_for(crack.sides[1]);
    crack.open |= one != two;
    const auto at = std::find(crack.face.begin(), crack.face.end(), vertex) - crack.face.begin();
    crack.after[static_cast<std::size_t>(at)] = one;
  }

  std::span<const Tet> tets_;
  const VertexStars& stars_;
  std::uint32_t first_new_;
  std::vector<Crack> cracks_;
  StarGroups groups_;
  std::vector<std::uint32_t> sizes_, numbers_;
  SplitPlan plan_;
};

}  // namespace

SplitPlan plan_split(std::span<const Tet> tets, const VertexStars& stars, std::span<const Triangle> faces,
                     std::uint32_t first_new, std::span<const Triangle> closed) {
  return Planner(tets, stars, first_new, find_cracks(tets, stars, faces, closed)).plan();
}

void apply_split(const SplitPlan& plan, std::span<Tet> tets, VertexStars& stars) {
  stars.add_vertices(plan.origins.size());
  for (const auto& [tet, corner, vertex] : plan.corners) {
    stars.move(tet, tets[tet][corner], vertex);
    tets[tet][corner] = vertex;
  }
}

}  // namespace glisson::detail
