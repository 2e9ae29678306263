// curves_fuzz.cpp — any bytes as a file of measurements: a curve in order, or a message that names the file.
//
// The first byte chooses what is made of the rows (contact, cycle, crop, filter, resampling) and which test it is, so that one corpus covers the
// preparation as well as the reader.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fit/data/prepare.h"
#include "glisson/scene/scene.h"

namespace {

using namespace glisson::fit;

/// Stops the fuzzer unless reading keeps what it promises.
void require(bool kept, const char* promise) {
  if (kept) return;
  std::fprintf(stderr, "the reader of curves broke its promise: %s\n", promise);
  std::abort();
}

/// With the three highest bits the lower ones choose a test of a point, whose columns have customary names.
bool of_point(std::uint8_t choice) { return choice >= 0xe0; }

DataSpec test_of_point(std::uint8_t choice) {
  DataSpec spec;
  const auto& tests = glisson::kWords<LabTest>;
  spec.test = tests[static_cast<std::size_t>(choice & 0x0f) % std::size(tests)].value;
  spec.unlikely = (choice & 0x10) != 0;
  return spec;
}

DataSpec spec_of(std::uint8_t choice) {
  if (of_point(choice)) return test_of_point(choice);
  DataSpec spec;
  const auto bit = [&](int i) { return (choice >> i & 1) != 0; };
  spec.skip_bad_rows = bit(0);
  spec.unlikely = bit(1);
  if (bit(2)) spec.contact.kind = ContactKind::detect;
  if (bit(3)) spec.cycle.part = CyclePart::loading;
  if (bit(4)) spec.crop.until = CropUntil::drop;
  if (bit(5)) spec.filter.kind = bit(6) ? FilterKind::median : FilterKind::savitzky_golay;
  if (bit(6)) spec.speed = 1e-3;
  if (bit(7)) spec.resample = {ResampleOver::displacement, ResampleHow::pick, 5};
  for (ColumnSpec* column : {&spec.columns.displacement, &spec.columns.force}) {
    if (!bit(6)) continue;
    column->given = true;
    column->number = column == &spec.columns.force ? 2 : 1;
    column->unit = column == &spec.columns.force ? "N" : "mm";
  }
  return spec;
}

void require_sound(const Curve& c) {
  require(c.size() >= 5 && c.displacement.size() == c.size() && c.force.size() == c.size(), "a curve has points");
  for (std::size_t i = 0; i < c.size(); ++i) {
    require(std::isfinite(c.time[i]) && std::isfinite(c.displacement[i]) && std::isfinite(c.force[i]),
            "points are finite");
    require(i == 0 || c.time[i] >= c.time[i - 1], "time does not fall");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const DataSpec spec = spec_of(data[0]);
  const bool point = of_point(data[0]);
  const SpecimenSize specimen{.area = point ? 1.0 : 1e-4, .height = point ? 1.0 : 1e-2, .radius = {}, .point = point};
  try {
    const CurveFile file = parse_curve_file({reinterpret_cast<const char*>(data) + 1, size - 1}, "fuzz.csv");
    glisson::scene::Problems problems("fuzz.csv");
    const RawTest test = raw_test(file, spec, specimen, problems);
    if (problems.count() == 0) check_units(test, spec, specimen, problems);
    problems.throw_if_any();
    const auto prepared = prepare(test, spec, specimen, problems);
    problems.throw_if_any();
    require(prepared.has_value(), "without a complaint there is a curve");
    require_sound(prepared->curve);
  } catch (const glisson::SceneError& error) {
    require(std::string_view(error.what()).substr(0, 8) == "fuzz.csv", "a message begins with the file");
  }
  return 0;
}
