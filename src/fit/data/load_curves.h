// load_curves.h — the curves of [[data]] sections, with one decision about contact for all sections of a test.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fit/data/data_spec.h"
#include "fit/data/prepare.h"
#include "fit/data/raw_test.h"

namespace glisson::fit {

/// Reads, checks and prepares all files of a section.
/// @param size  of the specimens, where the section says none @param base  relative files start here
/// @return one for each file, in their order
/// @throws SceneError with what is wrong with any of the files, all of it, a line for each
std::vector<PreparedCurve> load_curves(const DataSpec& spec, const SpecimenSize& size,
                                       const std::filesystem::path& base);

/// Whether sections are of one test, fitted or held out: alike in what is done and measured, and in what is asked of contact.
bool of_one_test(const DataSpec& a, const DataSpec& b);

/// The files of sections of one test, read once, however often their curves are prepared.
class TestFiles {
 public:
  /// What is wrong with any of the files is said by curves(). @param size, base  as of load_curves
  TestFiles(std::span<const DataSpec> tables, const SpecimenSize& size, const std::filesystem::path& base);

  /// The curves. Where a curve's baseline has a slope, all of them are placed on one; where one begins in contact, all are
  /// carried to zero alike. @param kind  of contact, in place of the sections' @return one list for each section
  /// @throws SceneError as load_curves
  std::vector<std::vector<PreparedCurve>> curves(std::optional<ContactKind> kind = {}) const;

 private:
  struct Table {
    DataSpec spec;
    SpecimenSize size;
    std::vector<RawTest> tests;
  };
  std::vector<Table> tables_;
  std::string faults_;
};

}  // namespace glisson::fit
