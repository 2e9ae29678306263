// capsule_on_block.h — a capsule on the top of a block, moved by hand: its sheet is brought to rest without the tissue.
#pragma once

#include <memory>
#include <vector>

#include "glisson/instruments/capsule.h"
#include "instruments/capsule_sheets.h"

namespace glisson {

class CapsuleOnBlock {
 public:
  /// A block of n × n × 1 cells, `width` wide. @param options  covers its top whatever they say
  CapsuleOnBlock(int n, double width, CapsuleOptions options)
      : mesh(box_mesh({.cells = {n, n, 1},
                       .size = {width, width, width / n},
                       .origin = {0, 0, -width / n},
                       .split = BoxSplit::alternating})),
        width_(width), masses_(mesh.vertices.size(), 1e-6), displacement_(mesh.vertices.size()),
        watched_(mesh.vertices.size()), place_of_(mesh.vertices.size()) {
    options.vertices = mesh.vertex_sets.at("z_max");
    capsule = std::make_unique<Capsule>(options);
    capsule->attached({mesh, {}, masses_, displacement_}, 0.0);
    for (std::uint32_t v = 0; v < watched_.size(); ++v) watched_[v].vertex = v, place_of_[v] = v;
  }

  bool is_rim(std::size_t v) const {
    const Vec3d& x = mesh.vertices[v];
    return std::min(x.x, x.y) < 1e-9 || std::max(x.x, x.y) > width_ - 1e-9;
  }

  /// Brings the sheet to rest from x on, with what is open. @return forces of the sheet [N]
  std::vector<Vec3d> rest_at(std::vector<Vec3d> x, const std::vector<Vec3d>& loads, const std::vector<Vec3d>& free) {
    const CapsuleOptions& o = capsule->options();
    Membrane sheet(capsule->triangles(), mesh.vertices,
                   {o.youngs_modulus * o.thickness, o.poisson_ratio, o.stiffening, o.prestretch});
    for (std::size_t t = 0; t < sheet.size(); ++t) {
      const double open = capsule->open_share()[t];
      sheet.keep(t, (1.0 - open) / (1.0 + 2.0 * open));
    }
    bring_to_rest(sheet, x, loads, free, 1e-4);
    move_to(x);
    return forces_of(sheet, x);
  }

  /// Shows the capsule its vertices in other places. @return its forces [N]
  std::vector<Vec3d> move_to(const std::vector<Vec3d>& x) {
    for (std::size_t v = 0; v < x.size(); ++v) {
      watched_[v].displacement = x[v] - mesh.vertices[v];
      watched_[v].elastic = {};
    }
    InteractionStep step;
    step.vertices = watched_;
    step.place_of = place_of_;
    step.rest = mesh.vertices;
    capsule->add_forces(step);
    std::vector<Vec3d> f;
    for (const ActiveVertex& w : watched_) f.push_back(w.elastic);
    return f;
  }

  /// Stretches the rim of the sheet evenly both ways. @return force across an end [N]
  double stretch(double by) {
    std::vector<Vec3d> x = mesh.vertices, free(x.size(), Vec3d{1, 1, 0});
    for (std::size_t v = 0; v < x.size(); ++v) {
      x[v] = {x[v].x * by, x[v].y * by, x[v].z};
      if (is_rim(v)) free[v] = {};
    }
    double force = 0.0;
    const std::vector<Vec3d> f = rest_at(x, std::vector<Vec3d>(x.size()), free);
    for (std::size_t v = 0; v < x.size(); ++v) force += mesh.vertices[v].x < 1e-9 ? f[v].x : 0.0;
    return force;
  }

  const TetMesh mesh;
  std::unique_ptr<Capsule> capsule;

 private:
  double width_;
  std::vector<double> masses_;
  std::vector<Vec3d> displacement_;
  std::vector<ActiveVertex> watched_;
  std::vector<std::uint32_t> place_of_;
};

}  // namespace glisson
