// bind.cpp — see bind.h.
#include "bind.h"

#include <algorithm>
#include <cstring>

#include "base/unit_range.h"
#include "docstrings.h"

namespace glisson::python {

const char* doc(const std::string& name) {
  const auto* found = std::find_if(std::begin(kDocstrings), std::end(kDocstrings),
                                   [&](const auto& entry) { return name == entry.first; });
  return found == std::end(kDocstrings) ? "" : found->second;
}

void require_main_interpreter() {
  if (PyInterpreterState_GetID(PyInterpreterState_Get()) == 0) return;
  throw nb::import_error(
      "glisson runs in the main interpreter of a process, not in a subinterpreter; start a process in its place, as "
      "multiprocessing and glisson.sweep do");
}

std::string docstring(const std::string& comment, const FieldText& field) {
  const std::string unit = field.si_unit();
  std::string text = !comment.empty() ? comment : std::string(field.help) + (unit.empty() ? "" : " [" + unit + "]");
  Range range = detail::allowed(field);
  range.min *= field.scale(), range.max *= field.scale();
  return range.bounded() ? text + "; allowed: " + range.text() : text;
}

void set_field(nb::handle self, const std::string& field, nb::handle value) {
  try {
    nb::setattr(self, field.c_str(), value);
  } catch (nb::python_error& error) {
    if (!error.matches(PyExc_TypeError)) throw;
    const std::string text = error.what();  // "… 1. (self, arg: float, /) -> None …"
    const std::size_t from = text.find("arg: "), to = text.find(", /)");
    if (from == std::string::npos || to == std::string::npos) throw;
    const std::string wanted = text.substr(from + 5, to - from - 5);
    throw nb::type_error(
        (field + " = " + nb::cast<std::string>(nb::repr(value)) + " does not fit; expected " + wanted).c_str());
  }
}

std::string members_text(nb::handle self, const char* list) {
  const nb::object shown = nb::module_::import_("reprlib").attr("repr");  // a long list by its first numbers
  std::string text = nb::cast<std::string>(self.type().attr("__name__")) + "(";
  const char* comma = "";
  for (nb::handle name : self.type().attr(list)) {
    const nb::object value = self.attr(name);
    const bool is_long = nb::isinstance<nb::list>(value) && nb::len(value) > 20;
    const nb::object words = is_long ? shown(value) : nb::object(nb::repr(value));
    text += comma + nb::cast<std::string>(name) + "=" + nb::cast<std::string>(words);
    comma = ", ";
  }
  return text + ")";
}

void add_member(nb::handle type, const char* list, const char* name) {
  type.attr(list) = nb::object(type.attr(list)) + nb::make_tuple(name);
}

Doubles vectors(std::vector<Vec3d> values) {
  const std::size_t n = values.size();
  return owned<Doubles>(std::move(values), {n, 3});
}
Doubles scalars(std::vector<double> values) {
  const std::size_t n = values.size();
  return owned<Doubles>(std::move(values), {n});
}
Numbers indices(std::vector<std::uint32_t> values) {
  const std::size_t n = values.size();
  return owned<Numbers>(std::move(values), {n});
}

namespace {

/// A NumPy array of one kind of number, laid out row by row.
nb::object numpy_array(nb::handle given, const char* type) {
  return nb::module_::import_("numpy").attr("ascontiguousarray")(given, type);
}

std::string shape_text(nb::handle array) { return nb::cast<std::string>(nb::str(nb::object(array.attr("shape")))); }

}  // namespace

std::vector<Vec3d> to_vectors(const ArrayLike& given, const char* name) {
  const nb::object array = numpy_array(given, "float64");
  const auto numbers = nb::cast<nb::ndarray<const double, nb::c_contig, nb::device::cpu>>(array);
  if (numbers.ndim() != 2 || numbers.shape(1) != 3) {
    throw nb::value_error((std::string(name) + " has the shape " + shape_text(array) + "; expected (n, 3)").c_str());
  }
  std::vector<Vec3d> values(numbers.shape(0));
  if (!values.empty()) std::memcpy(values.data(), numbers.data(), values.size() * sizeof(Vec3d));
  return values;
}

std::vector<std::uint32_t> to_indices(nb::handle given, std::size_t columns, const char* name) {
  nb::object array = nb::module_::import_("numpy").attr("asarray")(given);
  const std::string kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  const bool empty = nb::cast<std::size_t>(array.attr("size")) == 0;
  if (kind == "b" && columns == 1) array = nb::module_::import_("numpy").attr("flatnonzero")(array);
  if (kind != "b" && kind != "i" && kind != "u" && !empty) {
    throw nb::type_error((std::string(name) + " holds no whole numbers").c_str());
  }
  array = numpy_array(array, "int64");
  const auto numbers = nb::cast<nb::ndarray<const std::int64_t, nb::c_contig, nb::device::cpu>>(array);
  const bool fits = columns == 1 ? numbers.ndim() == 1 : numbers.ndim() == 2 && numbers.shape(1) == columns;
  if (!fits && !empty) {
    const std::string wanted = columns == 1 ? "(n,)" : "(n, " + std::to_string(columns) + ")";
    throw nb::value_error((std::string(name) + " has the shape " + shape_text(array) + "; expected " + wanted).c_str());
  }
  std::vector<std::uint32_t> values(numbers.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::int64_t v = numbers.data()[i];
    if (v < 0 || v > std::int64_t{UINT32_MAX}) {
      throw nb::value_error((std::string(name) + " holds " + std::to_string(v) + "; allowed: 0 or more").c_str());
    }
    values[i] = static_cast<std::uint32_t>(v);
  }
  return values;
}

}  // namespace glisson::python
