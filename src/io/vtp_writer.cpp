// vtp_writer.cpp — .vtp files: triangles in space.
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataWriter.h>

#include "glisson/io.h"
#include "io/atomic_file.h"
#include "io/quick_zlib.h"
#include "io/raw_mesh.h"
#include "io/vtk_log.h"
#include "io/vtk_start.h"

namespace glisson {

void write_vtp(const std::filesystem::path& file, std::span<const Vec3d> points, std::span<const Triangle> triangles) {
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) {
      if (v < points.size()) continue;
      throw std::invalid_argument("write_vtp: a triangle has point " + std::to_string(v) + "; there are " +
                                  std::to_string(points.size()) + ", counted from 0");
    }
  }
  detail::start_vtk();
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (const Vec3d& x : points) places->InsertNextPoint(x.x, x.y, x.z);
  vtkNew<vtkCellArray> cells;
  for (const Triangle& t : triangles) cells->InsertNextCell({vtkIdType(t[0]), vtkIdType(t[1]), vtkIdType(t[2])});
  vtkNew<vtkPolyData> surface;
  surface->SetPoints(places);
  surface->SetPolys(cells);
  vtkNew<detail::VtkErrorLog> log;
  vtkNew<vtkXMLPolyDataWriter> writer;
  log->observe_pipeline(*writer);
  writer->WriteToOutputStringOn();
  writer->SetInputData(surface);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOn();
  writer->SetCompressor(vtkNew<detail::QuickZlib>());
  writer->SetHeaderTypeToUInt64();
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 || !log->first().empty()) {
    detail::fail(file.string(), "VTK cannot put it together: " + log->first());
  }
  detail::replace_file(file, writer->GetOutputString());
}

}  // namespace glisson
