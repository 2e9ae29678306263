// curve_kinds.h — whether curves are of one kind of test, and the unit in which their errors are added.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "glisson/fit.h"

namespace glisson::fit {

/// Of the absolute values [the curve's unit]; 0 for an empty curve.
double largest_force(const Curve& curve);

/// Whether two curves are of the same deformation, in the same measure and unit.
bool same_kind(const Curve& a, const Curve& b);
/// Whether the curves are of a scene of heat; those of a fit all are, or none is.
bool are_of_heat(std::span<const Curve> curves);
/// Whether all are.
bool of_one_kind(const std::vector<Curve>& curves);
/// The unit of all curves' forces; empty where they differ: errors are then parts of each curve's largest number.
std::string common_unit(const std::vector<Curve>& curves);
/// What turns a curve's forces into that unit.
double size_in(const std::string& unit, const Curve& curve);

}  // namespace glisson::fit
