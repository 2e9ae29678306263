// write_pvd.cpp — the collection of frames that ParaView plays as an animation.
#include <charconv>

#include "io/atomic_file.h"
#include "io/raw_mesh.h"

namespace glisson {
namespace {

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// The shortest text that reads back as the same number.
std::string exact(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

void write_pvd(const std::filesystem::path& file, std::span<const std::pair<double, std::filesystem::path>> frames) {
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n";
  for (const auto& [time, frame] : frames) {
    text +=
        "    <DataSet timestep=\"" + exact(time) + "\" part=\"0\" file=\"" + escaped(frame.generic_string()) + "\"/>\n";
  }
  text += "  </Collection>\n</VTKFile>\n";
  detail::replace_file(file, text);
}

}  // namespace glisson
