#include "base/unit_range.h"

#include <algorithm>
#include <array>

namespace glisson::detail {
namespace {

// Single precision ends at 3.4e38, and products of two stresses, or of a mass and a stiffness, are formed in it. Double
// precision keeps 2e-12 m of 1e4 m, which is a hundred-millionth of a fine element's edge.
constexpr std::array kRanges{UnitRange{"-", 1e12},
                             UnitRange{"m", 1e4},
                             UnitRange{"m/s", 1e6},
                             UnitRange{"m/s²", 1e6},
                             UnitRange{"s", 1e9},
                             UnitRange{"1/s", 1e9},
                             UnitRange{"Hz", 1e9},
                             UnitRange{"deg", 1e6},
                             UnitRange{"deg/s", 1e9},
                             UnitRange{"kg", 1e9},
                             UnitRange{"kg/m³", 1e9, 1e-3},
                             UnitRange{"kg/s", 1e9},
                             UnitRange{"N", 1e9},
                             UnitRange{"N m", 1e9},
                             UnitRange{"N/m", 1e12},
                             UnitRange{"N s/m", 1e12},
                             UnitRange{"N s/m²", 1e12},
                             UnitRange{"Pa", 1e12, 1e-6},
                             UnitRange{"Pa·s", 1e12},
                             UnitRange{"Pa/m", 1e15},
                             UnitRange{"Pa s/m", 1e15},
                             UnitRange{"J/m²", 1e9},
                             UnitRange{"m²", 1e8},
                             UnitRange{"rad", 1e5},
                             UnitRange{"°C", 1e6},
                             UnitRange{"K", 1e6, 1e-12},
                             UnitRange{"1/K", 1e6},
                             UnitRange{"V", 1e6},
                             UnitRange{"W", 1e9},
                             UnitRange{"S/m", 1e6},
                             UnitRange{"W/m", 1e9},
                             UnitRange{"W/m²", 1e12},
                             UnitRange{"W/m³", 1e15},
                             UnitRange{"W/(m K)", 1e6, 1e-9},
                             UnitRange{"W/(m² K)", 1e9, 1e-9},
                             UnitRange{"J/kg", 1e12},
                             UnitRange{"J/(kg K)", 1e9, 1e-3},
                             UnitRange{"J/(m³ K)", 1e12, 1e-3},
                             UnitRange{"J/mol", 1e9}};

/// The SI unit of a key's unit and how many of the key's are one of it.
struct InSi {
  std::string_view unit;
  double factor = 1.0;
};
InSi in_si(std::string_view unit) {
  if (unit == "°") return {"deg"};
  if (unit == "mm²") return {"m²", 1e6};
  return unit.starts_with("mm") ? InSi{unit.substr(1), 1e3} : InSi{unit};
}

}  // namespace

std::span<const UnitRange> unit_ranges() { return kRanges; }

Range within_unit(Range range, std::string_view unit) {
  const InSi si = in_si(unit);
  const auto* found = std::ranges::find(kRanges, si.unit, &UnitRange::unit);
  if (found == kRanges.end()) return range;
  const double largest = si.factor * found->largest;
  if (range.min == 0.0 && range.min_open && found->smallest > 0.0) {
    range.min = si.factor * found->smallest, range.min_open = false;
  }
  if (range.min < -largest) range.min = -largest, range.min_open = false;
  if (range.max > largest) range.max = largest, range.max_open = false;
  return range;
}

}  // namespace glisson::detail
