// record_fuzz.cpp — any bytes as a file that a scene names: a recorded path, poses, a measured curve, a tissue.
//
// An input holds files (support.h, files_in): path.csv, poses.csv, measured.csv, tissue.toml, each in place of a sound one.
#include <array>
#include <cmath>

#include "glisson/scene/scene.h"
#include "support.h"

namespace {

using namespace glisson;
using fuzz::require;

constexpr std::string_view kScene = R"([mesh]
kind = "box"
cells = [1, 1, 1]
size_m = [0.01, 0.01, 0.01]
[tissue]
file = "tissue.toml"
[[fixed]]
set = "z_min"
[[tool]]
set = "z_max"
direction = [0, 0, -1]
record.path = "path.csv"
[[instrument]]
kind = "ball"
name = "ball"
tip_m = [0, 0, 0.02]
radius_mm = 2
motion = { kind = "record", path = "path.csv" }
[[instrument]]
kind = "block"
name = "block"
tip_m = [0, 0, 0.02]
size_mm = [2, 2, 2]
motion = { kind = "poses", path = "poses.csv" }
[[chart]]
title = "force"
x = "depth_m"
x_label = "depth [m]"
y = "force_N"
y_label = "force [N]"
measured = [{ path = "measured.csv", x = "depth_mm", y = "force_N" }]
)";

constexpr std::array<std::array<std::string_view, 2>, 4> kSound{
    {{"path.csv", "time_s,depth_m\n0,0\n0.1,0.001\n0.2,0\n"},
     {"poses.csv", "time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n1,0.01,0,0,0,0,0,-1\n"},
     {"measured.csv", "depth_mm,force_N\n0,0\n1,0.5\n"},
     {"tissue.toml", "[tissue]\nyoungs_modulus_Pa = 3600\npoisson_ratio = 0.4\n"}}};

void lay_out(std::string_view input) {
  for (const auto& [name, text] : kSound) fuzz::write_file(fuzz::scratch() / name, text);
  for (const auto& [name, bytes] : fuzz::files_in(input)) {
    for (const auto& file : kSound) {
      if (name == file[0]) fuzz::write_file(fuzz::scratch() / name, bytes);
    }
  }
}

bool finite(const Vec3d& x) { return std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z); }

void require_sound(const Variant& v) {
  const RecordedMotion& record = v.tools.at(0).record->motion;
  require(record.times.size() >= 2 && record.times.size() == record.positions.size(), "a path has two times or more");
  for (std::size_t i = 0; i < record.times.size(); ++i) {
    require(std::isfinite(record.times[i]) && finite(record.positions[i]), "a path is finite");
    require(i == 0 || record.times[i] > record.times[i - 1], "times rise");
  }
  const ToolPath path = tool_path(v.tools.at(0));
  require(path.end.has_value() && std::isfinite(*path.end), "a path ends");
  for (const double share : {0.0, 0.4, 1.0, 2.0})
    require(finite(path.displacement(share * *path.end)), "a tool is somewhere");
  const auto driver = make_driver(v.instruments.at(0));
  for (const double time : {0.0, 0.07, 1e3}) require(finite(driver->advance(time, 1e-3, {}).position), "so is a ball");
  const auto turning = make_driver(v.instruments.at(1));
  for (const double time : {0.0, 0.4, 1e3}) require(turning->advance(time, 1e-3, {}).is_sound(), "a block has a pose");
  require_valid(v.tissue);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool sound_is_read = [] {
    lay_out({});
    parse_scene(kScene, "fuzz.toml", fuzz::scratch());
    return true;
  }();
  require(sound_is_read, "the scene and its sound files are read");
  lay_out({reinterpret_cast<const char*>(data), size});
  try {
    const Scene scene = parse_scene(kScene, "fuzz.toml", fuzz::scratch());
    require_sound(scene.variants.at(0));
    for (const double x : scene.charts.at(0).measured.at(0).xs) require(std::isfinite(x), "a measured curve is finite");
  } catch (const SceneError& error) {
    require(std::string_view(error.what()).substr(0, 9) == "fuzz.toml", "a message begins with the scene");
  }
  return 0;
}
