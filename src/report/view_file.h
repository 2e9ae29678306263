// view_file.h — view.jsonl: what it takes beside frames and forces to show a run again (`glisson view DIR`).
//
//   {"format":1,"scene":…,"label":…,"tools":[{"name","instrument","direction"}],"held":[…],"driven":[…],"container":vessel,"instruments":[form]}
//   {"time_s":…,"instruments":[place],"torn":[vertices]}                                            a line for each frame
//
// `torn`, three vertices for each triangle of a capsule that is torn or open, stands where it has become another since the line before.
// Lines are whole whatever ends the run. Forms and places are those of web/src/report_data.ts.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "glisson/instruments/capsule.h"
#include "glisson/scene/scene.h"
#include "report/output_file.h"

namespace glisson {

class ViewFile {
 public:
  /// Writes the first line. @param scene  name of the scene @throws OutputError
  ViewFile(const std::filesystem::path& folder, const std::string& scene, const Variant& variant,
           std::vector<std::shared_ptr<Instrument>> instruments);
  /// Capsules whose tears lines tell.
  void set_capsules(std::vector<std::shared_ptr<Capsule>> capsules) { capsules_ = std::move(capsules); }
  /// The frame of a time [s]. @throws OutputError
  void add(double time);

 private:
  LineFile file_;
  std::vector<std::shared_ptr<Instrument>> instruments_;
  std::vector<std::shared_ptr<Capsule>> capsules_;
  std::vector<Triangle> torn_;  ///< that was told last
};

}  // namespace glisson
