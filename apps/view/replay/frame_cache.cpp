// frame_cache.cpp — see frame_cache.h.
#include "view/replay/frame_cache.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "glisson/io.h"

namespace glisson::view {
namespace {

using Array = glisson::Field;  // of a file; a Field of the view is what a viewer sees

const Array* named(const std::vector<Array>& fields, const std::string& name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const Array& f) { return f.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

/// A number each; nothing where there is no such array, 0 where it has none.
std::vector<double> numbers_of(const std::vector<Array>& fields, const std::string& name, std::size_t count) {
  const Array* field = named(fields, name);
  if (field == nullptr || field->components != 1 || field->values.size() != count) return {};
  std::vector<double> values = field->values;
  for (double& x : values) x = std::isfinite(x) ? x : 0.0;
  return values;
}

/// Displacements of a frame, whose vertices are at rest. Those of older versions were displaced: such a frame has its
/// stress in six arrays.
std::vector<Vec3d> displacement_of(const ReadFrame& frame, const std::string& file) {
  const Array* moved = named(frame.vertex_fields, "displacement_m");
  if (moved == nullptr || moved->components != 3)
    throw FileError(file + ": no array displacement_m; this is no frame of glisson run");
  if (named(frame.tet_fields, "stress_xx_Pa") != nullptr)
    throw FileError(file + ": a frame of an older version, whose points are displaced; run its scene again");
  const std::vector<double>& u = moved->values;
  std::vector<Vec3d> displacement(frame.mesh.vertices.size());
  for (std::size_t v = 0; v < displacement.size(); ++v) displacement[v] = {u[3 * v], u[3 * v + 1], u[3 * v + 2]};
  return displacement;
}

bool same_body(const BodyShape& known, const TetMesh& mesh, const std::vector<Triangle>& torn) {
  return known.torn == torn && known.mesh.tets == mesh.tets && known.mesh.vertices == mesh.vertices;
}

/// The outer faces of a run's first frame; none of a mesh that is none, as someone else's may be.
std::shared_ptr<const SkinFaces> skin_of(const TetMesh& mesh) {
  try {
    return std::make_shared<const SkinFaces>(mesh);
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

std::shared_ptr<const BodyShape> shape_of(TetMesh mesh, const RunFolder& run, const std::vector<Triangle>& torn,
                                          std::shared_ptr<const SkinFaces> skin) {
  auto shape = std::make_shared<BodyShape>();
  shape->marks.assign(mesh.vertices.size(), 0);
  const auto mark = [&](const std::vector<std::string>& sets, std::uint8_t value) {
    for (const std::string& name : sets) {
      const auto found = mesh.vertex_sets.find(name);
      if (found == mesh.vertex_sets.end()) continue;
      for (const std::uint32_t v : found->second) shape->marks[v] = value;
    }
  };
  mark(run.held, 1);
  mark(run.driven, 2);
  shape->mesh = std::move(mesh);
  shape->torn = torn;
  shape->skin = std::move(skin);
  return shape;
}

std::size_t bytes_of(const LoadedFrame& frame, bool own_shape) {
  const TetMesh& mesh = frame.shape->mesh;
  const std::size_t shape = sizeof(Vec3d) * mesh.vertices.size() + sizeof(Tet) * mesh.tets.size();
  const std::size_t fields = frame.pressure.size() + frame.von_mises.size() + frame.contact_pressure.size();
  return sizeof(Vec3d) * frame.displacement.size() + sizeof(double) * fields + (own_shape ? shape : 0);
}

}  // namespace

bool FrameCache::has(std::size_t number) const {
  return std::any_of(kept_.begin(), kept_.end(), [number](const Kept& x) { return x.number == number; });
}

std::shared_ptr<const LoadedFrame> FrameCache::read(std::size_t number, bool fields) {
  static const std::array<std::string, 5> kColumns{"displacement_m", "stress_xx_Pa", "pressure_Pa", "von_mises_Pa",
                                                   "contact_pressure_Pa"};
  const std::string file = run_.frames[number].file.string();
  ReadFrame frame = read_frame(file, std::span(kColumns).first(fields ? kColumns.size() : 2));
  auto loaded = std::make_shared<LoadedFrame>();
  loaded->displacement = displacement_of(frame, file);
  loaded->has_fields = fields;
  loaded->pressure = numbers_of(frame.tet_fields, "pressure_Pa", frame.mesh.tets.size());
  loaded->von_mises = numbers_of(frame.tet_fields, "von_mises_Pa", frame.mesh.tets.size());
  loaded->contact_pressure = numbers_of(frame.vertex_fields, "contact_pressure_Pa", frame.mesh.vertices.size());
  if (number == 0 && !skin_) skin_ = skin_of(frame.mesh);
  static const std::vector<Triangle> kNone;
  const std::vector<Triangle>& torn = run_.frames[number].torn ? *run_.frames[number].torn : kNone;
  if (!shape_ || !same_body(*shape_, frame.mesh, torn)) {
    const auto known = std::find_if(kept_.begin(), kept_.end(),
                                    [&](const Kept& x) { return same_body(*x.frame->shape, frame.mesh, torn); });
    shape_ = known != kept_.end() ? known->frame->shape : shape_of(std::move(frame.mesh), run_, torn, skin_);
  }
  loaded->shape = shape_;
  ++reads_;
  return loaded;
}

std::shared_ptr<const LoadedFrame> FrameCache::read_once(std::size_t number, bool fields) {
  if (const auto known = unreadable_.find(number); known != unreadable_.end()) throw FileError(known->second);
  try {
    return read(number, fields);
  } catch (const FileError& error) {
    unreadable_[number] = error.what();
    throw;
  }
}

std::shared_ptr<const LoadedFrame> FrameCache::at(std::size_t number, bool fields) {
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& x) { return x.number == number; });
  if (found != kept_.end() && (!fields || found->frame->has_fields)) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().frame;
  }
  const std::shared_ptr<const BodyShape> before = shape_;
  std::shared_ptr<const LoadedFrame> frame = read_once(number, fields);
  if (found != kept_.end()) {  // without its fields
    bytes_ -= found->bytes;
    kept_.erase(found);
  }
  const std::size_t bytes = bytes_of(*frame, frame->shape != before);
  kept_.push_front({number, bytes, frame});
  bytes_ += bytes;
  while (bytes_ > most_ && kept_.size() > 2) {
    bytes_ -= kept_.back().bytes;
    kept_.pop_back();
  }
  return frame;
}

}  // namespace glisson::view
