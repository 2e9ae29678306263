// read_frames.cpp — frames of a run come back: the collection that names them, and each with its fields.
#include <vtkNew.h>
#include <vtkXMLDataElement.h>

#include <cmath>
#include <sstream>

#include "io/raw_mesh.h"
#include "io/shallow_xml.h"
#include "io/vtk_log.h"
#include "io/vtk_start.h"

namespace glisson {
namespace {

/// Beside or below the collection: a name that leads elsewhere is none that a run wrote.
bool stays_below(const std::filesystem::path& file) {
  if (file.empty() || file.is_absolute()) return false;
  for (const auto& part : file) {
    if (part == "..") return false;
  }
  return true;
}

void require_size(const Field& field, std::size_t items, const std::string& name) {
  if (field.values.size() == items * static_cast<std::size_t>(field.components)) return;
  detail::fail(name, "the array \"" + field.name + "\" has another number of values than the mesh");
}

}  // namespace

std::vector<std::pair<double, std::filesystem::path>> read_pvd(const std::filesystem::path& file) {
  std::istringstream stream(detail::read_bytes(file));
  detail::start_vtk();
  vtkNew<detail::VtkErrorLog> log;
  vtkNew<detail::ShallowXml> parser;
  log->observe(*parser);
  parser->SetStream(&stream);
  if (parser->Parse() == 0 || parser->GetRootElement() == nullptr)
    detail::fail(file.string(), parser->trouble(*log.Get()));
  vtkXMLDataElement* list = parser->GetRootElement()->FindNestedElementWithName("Collection");
  if (list == nullptr) detail::fail(file.string(), "no <Collection> element: this is no collection of frames");
  std::vector<std::pair<double, std::filesystem::path>> frames;
  for (int i = 0; i < list->GetNumberOfNestedElements(); ++i) {
    vtkXMLDataElement& element = *list->GetNestedElement(i);
    const char* name = element.GetAttribute("file");
    double time = 0.0;
    if (name == nullptr || element.GetScalarAttribute("timestep", time) != 1 || !std::isfinite(time)) break;
    if (!stays_below(name)) break;
    frames.emplace_back(time, name);
  }
  return frames;
}

ReadFrame read_frame(const std::filesystem::path& file, std::span<const std::string> fields) {
  const std::string name = file.string();
  detail::RawMesh raw = detail::read_vtu_with(detail::read_bytes(file), name, fields);
  if (!raw.skipped.empty() || raw.mesh.tets.empty()) detail::fail(name, "a frame holds tetrahedra, and nothing else");
  for (const Field& field : raw.vertex_fields) require_size(field, raw.mesh.vertices.size(), name);
  for (const Field& field : raw.tet_fields) require_size(field, raw.mesh.tets.size(), name);
  return {std::move(raw.mesh), std::move(raw.vertex_fields), std::move(raw.tet_fields), std::move(raw.arrays)};
}

}  // namespace glisson
