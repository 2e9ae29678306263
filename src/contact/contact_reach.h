// contact_reach.h — which part of the surface solids may touch.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "contact/contact_surface.h"
#include "contact/point_rows.h"
#include "glisson/archive.h"

namespace glisson {

/// Lets vertices that are copies, the last ones of a body, have what their origins have, by vertex.
template <class Value>
void give_to_copies(std::map<std::uint32_t, Value>& of_vertex, std::size_t vertices,
                    std::span<const std::uint32_t> origins) {
  const std::size_t first = vertices - origins.size();
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const auto found = of_vertex.find(origins[i]);
    if (found != of_vertex.end()) of_vertex[static_cast<std::uint32_t>(first + i)] = Value(found->second);
  }
}

/// The part of the surface that solids may touch: patches come in as one draws near and go when all are well away.
class ContactReach {
 public:
  void attach(const BodyView& body);
  /// Vertices to bring to hand, the sentinels of all patches at first. @param solids  their way in the coming step
  std::span<const std::uint32_t> ask(std::span<const ContactSolid> solids, double h);
  /// Whether the last ask() let some go.
  bool has_left() const { return gone_; }
  /// All that has been asked for and not been let go.
  std::span<const std::uint32_t> kept();
  /// The same, where the last ask() let some go.
  std::optional<std::span<const std::uint32_t>> keeps();
  /// Where the sentinels are after a step.
  void look(const InteractionStep& step);

  const ContactSurface& surface() const { return surface_; }
  std::span<const std::uint32_t> vertices() const { return mine_; }
  /// Triangles with all corners among vertices(), and these as places there.
  std::span<const Triangle> triangles() const { return my_triangles_; }

  /// Of a patch.
  struct Sentinel {
    Vec3d position, velocity;
    bool asked = false;
    void archive(Archive& ar) { ar(position, velocity, asked); }
  };
  /// What has been asked for, and what was seen of it: all but the surface.
  struct Seen {
    std::vector<Sentinel> sentinels;
    bool sentinels_asked = false;
  };
  const Seen& seen() const { return seen_; }
  /// @param seen  of this surface
  void set_seen(const Seen& seen);
  /// Goes to the surface of another body; set_seen() comes next.
  void set_body(const BodyView& body) { surface_.build(body); }
  void archive(Archive& ar);

 private:
  bool may_reach(const ContactSolid& solid, double margin, const Sentinel& s, double h) const;
  void gather();

  ContactSurface surface_;
  Seen seen_;
  std::vector<std::uint32_t> mine_, asking_, kept_;
  std::vector<Triangle> my_triangles_;
  bool gone_ = false;
};

}  // namespace glisson
