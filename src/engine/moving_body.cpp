#include "engine/moving_body.h"

namespace glisson {

void MovingBody::archive_state(Archive& ar, std::size_t vertices) {
  std::vector<Vec3d> u(vertices), v(vertices);
  if (!ar.reads()) read_state(u, v);
  ar.same_size(u), ar.same_size(v);
  if (ar.reads()) set_state(u, v);
  archive_past(ar);
}

}  // namespace glisson
