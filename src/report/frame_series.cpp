// frame_series.cpp — see frame_series.h.
#include "report/frame_series.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <exception>
#include <new>
#include <span>

#include "glisson/io.h"
#include "report/output_file.h"

namespace glisson {
namespace {

Field vector_field(std::string name, std::span<const Vec3d> vectors) {
  Field field{.name = std::move(name), .components = 3, .values = {}};
  field.values.reserve(3 * vectors.size());
  for (const Vec3d& v : vectors) field.values.insert(field.values.end(), {v.x, v.y, v.z});
  return field;
}

/// √(½ [(σx−σy)² + (σy−σz)² + (σz−σx)²] + 3 (τxy² + τyz² + τxz²)) [Pa].
double von_mises(std::span<const double, 6> s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

std::vector<Field> stress_fields(const std::vector<double>& stress) {
  static constexpr std::array<const char*, 6> kNames{"stress_xx_Pa", "stress_yy_Pa", "stress_zz_Pa",
                                                     "stress_xy_Pa", "stress_yz_Pa", "stress_xz_Pa"};
  std::vector<Field> fields;
  for (const char* name : kNames) fields.push_back({.name = name, .components = 1, .values = {}});
  Field mises{.name = "von_mises_Pa", .components = 1, .values = {}};
  Field pressure{.name = "pressure_Pa", .components = 1, .values = {}};
  for (std::size_t i = 0; i + 6 <= stress.size(); i += 6) {
    const std::span<const double, 6> s(stress.data() + i, 6);
    for (std::size_t k = 0; k < 6; ++k) fields[k].values.push_back(s[k]);
    mises.values.push_back(von_mises(s));
    pressure.values.push_back(-(s[0] + s[1] + s[2]) / 3.0);
  }
  fields.push_back(std::move(mises));
  fields.push_back(std::move(pressure));
  return fields;
}

}  // namespace

FrameSeries::FrameSeries(std::filesystem::path folder) : folder_(std::move(folder)) { make_folder(folder_ / "frames"); }

void FrameSeries::add(const Simulation& simulation, const TetFields& fields) {
  const std::filesystem::path file = std::filesystem::path("frames") / fmt::format("frame_{:04}.vtu", frames_.size());
  const std::vector<Field> at_vertices{vector_field("displacement_m", simulation.displacement()),
                                       vector_field("velocity_m_s", simulation.velocity())};
  std::vector<Field> at_tets = stress_fields(fields.stress);
  at_tets.push_back({.name = "q", .components = 1, .values = fields.q});
  at_tets.push_back({.name = "s", .components = 1, .values = fields.s});
  at_tets.push_back({.name = "jacobian", .components = 1, .values = fields.jacobian});
  if (simulation.mesh().regions.empty()) {  // write_vtu has those that are given
    at_tets.push_back({.name = "region", .components = 1, .values = std::vector<double>(fields.q.size(), 0.0)});
  }
  try {
    write_vtu(folder_ / file, simulation.mesh(), simulation.positions(), at_vertices, at_tets);
    frames_.emplace_back(simulation.time(), file);
    write_pvd(folder_ / "frames.pvd", frames_);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    throw OutputError(error.what());
  }
}

}  // namespace glisson
