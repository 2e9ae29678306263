// implicit_body.cpp — from named shapes to the regions of a body.
#include <map>
#include <stdexcept>

#include "base/nearest.h"
#include "base/text.h"
#include "mesher/implicit/shape_node.h"

namespace glisson {
namespace {

using Names = std::vector<std::string>;

template <class S>
concept Combines = requires(const S& s) {
  s.of.front();
  s.blend;
};

Names references(const NamedShape& shape) {
  return std::visit(
      [](const auto& s) -> Names {
        using S = std::remove_cvref_t<decltype(s)>;
        if constexpr (std::is_same_v<S, PlacedShape>)
          return {s.of};
        else if constexpr (Combines<S>)
          return s.of;
        else
          return {};
      },
      shape.what);
}

std::string unknown_shape(const std::string& name, const Names& known) {
  const std::string meant = scene::nearest(name, known);
  std::string text = "there is no shape \"" + name + "\" before";
  if (!meant.empty()) return text + "; did you mean \"" + meant + "\"?";
  return text + (known.empty() ? "; it is the first" : "; there are: " + scene::listed(known));
}

/// What is wrong with the shapes that one refers to.
std::string reference_fault(const NamedShape& shape, const Names& known) {
  const Names of = references(shape);
  if (const auto* d = std::get_if<DifferenceShape>(&shape.what); d && d->of.size() < 2)
    return "names the shape and at least one that is taken out of it";
  if ((std::holds_alternative<UnionShape>(shape.what) || std::holds_alternative<IntersectionShape>(shape.what)) &&
      of.empty())
    return "is empty; name at least one shape";
  for (const std::string& name : of) {
    if (std::find(known.begin(), known.end(), name) == known.end()) return unknown_shape(name, known);
  }
  return {};
}

BodyFault shape_fault(const ImplicitBody& body, Names& known) {
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    const NamedShape& s = body.shapes[i];
    if (s.name.empty()) return {"is empty; give the shape a name", "shape", i, "name"};
    if (std::find(known.begin(), known.end(), s.name) != known.end())
      return {"\"" + s.name + "\" is the name of an earlier shape; give another", "shape", i, "name"};
    if (std::string fault = reference_fault(s, known); !fault.empty()) return {std::move(fault), "shape", i, "of"};
    known.push_back(s.name);
  }
  return {};
}

const std::string& shape_name(const ShapeRegion& region) { return region.shape.empty() ? region.name : region.shape; }

Solid build(const NamedShape& shape, const std::map<std::string, Solid>& known) {
  const auto called = [&](const std::string& name) { return known.at(name); };
  const auto all_of = [&](const Names& names) {
    std::vector<Solid> shapes;
    for (const std::string& name : names) shapes.push_back(called(name));
    return shapes;
  };
  return std::visit(
      [&](const auto& s) -> Solid {
        using S = std::remove_cvref_t<decltype(s)>;
        if constexpr (std::is_same_v<S, UnionShape>)
          return unite(all_of(s.of), s.blend);
        else if constexpr (std::is_same_v<S, IntersectionShape>)
          return intersect(all_of(s.of), s.blend);
        else if constexpr (std::is_same_v<S, DifferenceShape>) {
          std::vector<Solid> shapes = all_of(s.of);
          const Solid first = shapes.front();
          shapes.erase(shapes.begin());
          return subtract(first, shapes, s.blend);
        } else if constexpr (std::is_same_v<S, PlacedShape>)
          return called(s.of).placed(s);
        else if constexpr (std::is_same_v<S, SurfaceShape>) {
          if (!s.solid)
            throw std::invalid_argument("its surface has not been read; take load_surface or surface_solid");
          return *s.solid;
        } else
          return Solid(s);
      },
      shape.what);
}

}  // namespace

BodyFault check_names(const ImplicitBody& body) {
  Names known, regions;
  if (BodyFault fault = shape_fault(body, known); !fault.what.empty()) return fault;
  for (std::size_t i = 0; i < body.regions.size(); ++i) {
    const ShapeRegion& r = body.regions[i];
    if (r.name.empty()) return {"is empty; give the region a name", "region", i, "name"};
    if (std::find(regions.begin(), regions.end(), r.name) != regions.end())
      return {"\"" + r.name + "\" is the name of an earlier region; give another", "region", i, "name"};
    if (std::find(known.begin(), known.end(), shape_name(r)) == known.end())
      return {unknown_shape(shape_name(r), known), "region", i, r.shape.empty() ? "name" : "shape"};
    regions.push_back(r.name);
  }
  SizeFault fault = check_sizes(body.sizes, body.edge, regions);
  return {std::move(fault.what), "size", fault.index, std::move(fault.key)};
}

BodyRegion region_of(const std::string& name, const Solid& shape, bool hole) {
  if (!detail::is_finite(shape.bounds())) {
    throw std::invalid_argument("region \"" + name + "\" reaches to infinity; intersect its shape with a bounded one");
  }
  return {name, [shape](const Vec3d& p) { return shape.distance(p); }, shape.bounds(), hole};
}

std::vector<BodyRegion> regions_of(const ImplicitBody& body) {
  if (const BodyFault fault = check_names(body); !fault.what.empty()) {
    throw std::invalid_argument(std::string(fault.list) + " " + std::to_string(fault.index) + ": " + fault.key + " " +
                                fault.what);
  }
  std::map<std::string, Solid> shapes;
  for (const NamedShape& s : body.shapes) {
    try {
      shapes.emplace(s.name, build(s, shapes));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("shape \"" + s.name + "\": " + error.what());
    }
  }
  std::vector<BodyRegion> regions;
  for (const ShapeRegion& r : body.regions) regions.push_back(region_of(r.name, shapes.at(shape_name(r)), r.hole));
  return regions;
}

RegionMesh implicit_mesh(const ImplicitBody& body, std::function<bool(double)> progress) {
  return mesh_regions(regions_of(body), {body.edge, body.max_tets, std::move(progress), body.sizes, body.growth});
}

std::vector<double> edges_asked(const TetMesh& mesh, const ImplicitBody& body) {
  return edges_asked(mesh, regions_of(body), {.edge = body.edge, .sizes = body.sizes, .growth = body.growth});
}

}  // namespace glisson
