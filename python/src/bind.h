// bind.h — what the rooms of the Python module share: docstrings, words for enumerators, vectors, option structs.
//
//   enumerators  ⇄  their words (glisson/words.h), as a scene has them: "implicit", "corotational"
//   Vec3d, Mat3d ⇄  any three numbers in, a NumPy array out
//   structs      ⇄  classes whose constructor takes every field by name
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/words.h"

namespace glisson::python {

namespace nb = nanobind;
using namespace nb::literals;

/// The docstring of a declaration of the public headers, by its name without namespace; "" where it has none.
const char* doc(const std::string& name);

/// What NumPy takes for an array.
struct ArrayLike : nb::object {
  NB_OBJECT_DEFAULT(ArrayLike, object, "numpy.typing.ArrayLike", check_any)
  static bool check_any(nb::handle) { return true; }
};
/// Vertices: the name of a set of the mesh, numbers, or a mask.
struct VertexChoice : nb::object {
  NB_OBJECT_DEFAULT(VertexChoice, object, "str | numpy.typing.ArrayLike", check_any)
  static bool check_any(nb::handle) { return true; }
};

/// NumPy arrays that are made here.
struct Doubles : nb::object {
  NB_OBJECT_DEFAULT(Doubles, object, "numpy.typing.NDArray[numpy.float64]", ArrayLike::check_any)
  using Scalar = double;
};
struct Numbers : nb::object {
  NB_OBJECT_DEFAULT(Numbers, object, "numpy.typing.NDArray[numpy.uint32]", ArrayLike::check_any)
  using Scalar = std::uint32_t;
};

/// Numbers that an array takes over.
template <class Array, class Value>
Array owned(std::vector<Value>&& values, std::initializer_list<std::size_t> shape) {
  using Scalar = typename Array::Scalar;
  auto* kept = new std::vector<Value>(std::move(values));
  nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Value>*>(p); });
  nb::ndarray<nb::numpy, Scalar, nb::c_contig> array(reinterpret_cast<Scalar*>(kept->data()), shape, owner);
  return nb::steal<Array>(array.cast(nb::rv_policy::reference).release());
}
Doubles vectors(std::vector<Vec3d> values);     ///< (n, 3)
Doubles scalars(std::vector<double> values);    ///< (n,)
Numbers indices(std::vector<std::uint32_t> v);  ///< (n,)

/// (n, 3) numbers as vectors. @throws nb::value_error naming what they are
std::vector<Vec3d> to_vectors(const ArrayLike& array, const char* name);
/// (n, columns) whole numbers from 0 on, or for one column (n,) or a mask. @throws nb::value_error
std::vector<std::uint32_t> to_indices(nb::handle array, std::size_t columns, const char* name);

/// Gives an option class's field a value. @throws nb::type_error naming field, value and what is expected
void set_field(nb::handle self, const std::string& field, nb::handle value);

/// Refuses a field that a class of options has not, naming the nearest that it has. @throws nb::type_error
[[noreturn]] void no_such_field(nb::handle type, const std::string& field);

/// Docstring of a field: the comment at its member, else its meaning and unit; then its range.
std::string docstring(const std::string& comment, const FieldText& field);

/// What a function of the caller's returned, as a value. @throws nb::type_error naming the function, what it returned and what is
/// expected
template <class T>
T returned(const char* function, nb::handle given, const char* expected) {
  T value{};
  if (nb::try_cast(given, value)) return value;
  throw nb::type_error(
      (std::string(function) + " returned " + nb::cast<std::string>(nb::repr(given)) + "; expected " + expected)
          .c_str());
}

/// @throws nb::import_error in a subinterpreter: the functions that the engine calls would wait for the main one for ever
void require_main_interpreter();

/// Fills an object that pickle makes, by what `read` makes of its state. @param parts  of the state
/// @throws nb::value_error, nb::type_error for a state that is not one of such an object
template <class T, class Read>
void set_pickled(T& self, const nb::tuple& state, const char* type, std::size_t parts, const Read& read) {
  const std::string where = std::string(type) + ".__setstate__: ";
  if (nb::len(state) != parts) {
    throw nb::value_error((where + "the state has " + std::to_string(nb::len(state)) + " parts; expected the " +
                           std::to_string(parts) + " that __getstate__ returns")
                              .c_str());
  }
  try {
    new (&self) T(read());
  } catch (const nb::cast_error&) {
    throw nb::type_error((where + "a part of the state has another type than __getstate__ returns").c_str());
  }
}

/// Signatures of what pickle calls.
inline constexpr const char* kGetState = "def __getstate__(self) -> tuple[typing.Any, ...]";
inline constexpr const char* kSetState = "def __setstate__(self, state: tuple[typing.Any, ...], /) -> None";

/// A field's name; one that is a word of Python has an underscore behind it, as the language's style asks.
inline const char* python_name(const char* name) { return std::string_view(name) == "from" ? "from_" : name; }

/// repr() of an object whose class lists members: "Name(field=value, …)". @param list  the attribute with their names
std::string members_text(nb::handle self, const char* list);
/// Appends to that list of a class.
void add_member(nb::handle type, const char* list, const char* name);

/// A class of options: every field by name in its constructor, readable and writable, shown by repr(). Those of a
/// described struct (glisson/field.h) are all there. It pickles.
template <class T>
class Options : public nb::class_<T> {
 public:
  Options(nb::handle scope, const char* name) : nb::class_<T>(scope, name, doc(name)), of_(name) {
    this->def("__init__", [](nb::pointer_and_handle<T> self, const nb::kwargs& fields) {
      new (self.p) T();
      nb::inst_mark_ready(self.h);
      for (const auto& [key, value] : fields) {
        const auto name = nb::cast<std::string>(key);
        if (!nb::hasattr(self.h, key)) no_such_field(self.h.type(), name);
        set_field(self.h, name, value);
      }
    });
    this->def("__repr__", [](nb::handle self) { return members_text(self, "_fields"); });
    this->attr("_fields") = nb::tuple();
    const auto reduce = [](nb::handle self) {  // pickles by the fields, through the constructor
      nb::dict fields;
      for (nb::handle field : self.type().attr("_fields")) fields[field] = self.attr(field);
      return nb::make_tuple(nb::module_::import_("functools").attr("partial")(self.type(), **fields), nb::tuple());
    };
    this->def("__reduce__", reduce, nb::sig("def __reduce__(self) -> tuple[typing.Any, ...]"));
    this->def("__copy__", [](const T& self) { return T(self); });
    this->def("__deepcopy__", [](const T& self, nb::handle) { return T(self); });
    this->def("__eq__", [](nb::handle a, nb::handle b) {
      if (!nb::isinstance<T>(b)) return false;
      if constexpr (std::equality_comparable<T>) {
        return nb::cast<const T&>(a) == nb::cast<const T&>(b);
      } else {
        const nb::object same = nb::module_::import_("numpy").attr("array_equal");
        for (nb::handle field : a.type().attr("_fields")) {
          const nb::object x = nb::getattr(a, field), y = nb::getattr(b, field);
          if (nb::hasattr(x, "shape") ? !nb::cast<bool>(same(x, y)) : !x.equal(y)) return false;
        }
        return true;
      }
    });
    if constexpr (Described<T>) {
      each_field<T>([&](const auto& f) { add(f.name.data(), f.member, f); });
    }
  }
  template <class M>
  Options& field(const char* name, M member) {
    add(name, member, {});
    return *this;
  }

 private:
  template <class M>
  void add(const char* name, M member, const FieldText& field) {
    const std::string text = docstring(doc(of_ + "::" + name), field);
    name = python_name(name);
    if constexpr (requires(T options) { (options.*member).use_count(); })  // a shared object, or none
      this->def_rw(name, member, nb::for_setter(nb::arg().none()), text.c_str());
    else
      this->def_rw(name, member, text.c_str());
    add_member(*this, "_fields", name);
  }

  std::string of_;
};

/// A class of results: its members are read, and shown by repr().
template <class T>
class Results : public nb::class_<T> {
 public:
  Results(nb::handle scope, const char* name) : nb::class_<T>(scope, name, doc(name)), of_(name) {
    this->def("__repr__", [](nb::handle self) { return members_text(self, "_members"); });
    this->attr("_members") = nb::tuple();
  }
  template <class M>
  Results& read(const char* name, M member) {
    this->def_ro(name, member, doc(of_ + "::" + name));
    add_member(*this, "_members", name);
    return *this;
  }

 private:
  std::string of_;
};

/// "typing.Literal['kuhn', 'alternating']" of an enumeration with words.
template <class E>
constexpr auto literal_of_words() {
  constexpr std::string_view kHead = "typing.Literal[";
  constexpr std::size_t kSize = [](std::size_t size) {
    for (const Word<E>& w : kWords<E>) size += w.word.size() + std::string_view("'', ").size();
    return size - 1;  // the last has "]" in place of ", "
  }(kHead.size());
  nb::detail::descr<kSize> literal;
  char* at = std::copy(kHead.begin(), kHead.end(), literal.text);
  for (const Word<E>& w : kWords<E>) {
    if (&w != kWords<E>) *at++ = ',', *at++ = ' ';
    *at++ = '\'';
    at = std::copy(w.word.begin(), w.word.end(), at);
    *at++ = '\'';
  }
  *at = ']';
  return literal;
}

}  // namespace glisson::python

namespace nanobind::detail {

/// An enumeration is known by its words (glisson/words.h); the constraint prefers this to nanobind's caster of enumerations.
template <glisson::HasWords E>
struct type_caster<E, enable_if_t<std::is_enum_v<E>>> {
  NB_TYPE_CASTER(E, glisson::python::literal_of_words<E>())
  bool from_python(handle src, std::uint8_t, cleanup_list*) noexcept {
    if (!PyUnicode_Check(src.ptr())) return false;
    for (const glisson::Word<E>& w : glisson::kWords<E>) {
      if (PyUnicode_CompareWithASCIIString(src.ptr(), w.word.data()) != 0) continue;
      value = w.value;
      return true;
    }
    return false;
  }
  static handle from_cpp(E value, rv_policy, cleanup_list*) noexcept {
    const std::string_view word = glisson::word_of(value);
    return nanobind::str(word.data(), word.size()).release();
  }
};

template <>
struct type_caster<glisson::Vec3d> {
  NB_TYPE_CASTER(glisson::Vec3d, io_name("collections.abc.Sequence[float] | numpy.typing.NDArray[typing.Any]",
                                         "numpy.typing.NDArray[numpy.float64]"))
  bool from_python(handle src, std::uint8_t, cleanup_list*) noexcept {
    object fast = steal(PySequence_Fast(src.ptr(), ""));
    if (!fast.is_valid() || PySequence_Fast_GET_SIZE(fast.ptr()) != 3) {
      PyErr_Clear();
      return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      value[i] = PyFloat_AsDouble(PySequence_Fast_GET_ITEM(fast.ptr(), static_cast<Py_ssize_t>(i)));
    }
    if (!PyErr_Occurred()) return true;
    PyErr_Clear();
    return false;
  }
  static handle from_cpp(const glisson::Vec3d& v, rv_policy, cleanup_list*) noexcept {
    return glisson::python::scalars({v.x, v.y, v.z}).release();
  }
};

template <>
struct type_caster<glisson::Mat3d> {
  using Row = make_caster<glisson::Vec3d>;
  NB_TYPE_CASTER(glisson::Mat3d, io_name("numpy.typing.ArrayLike", "numpy.typing.NDArray[numpy.float64]"))
  bool from_python(handle src, std::uint8_t flags, cleanup_list* cleanup) noexcept {
    object fast = steal(PySequence_Fast(src.ptr(), ""));
    if (!fast.is_valid() || PySequence_Fast_GET_SIZE(fast.ptr()) != 3) {
      PyErr_Clear();
      return false;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      Row row;
      if (!row.from_python(PySequence_Fast_GET_ITEM(fast.ptr(), static_cast<Py_ssize_t>(i)), flags, cleanup))
        return false;
      value.m[i] = {row.value.x, row.value.y, row.value.z};
    }
    return true;
  }
  static handle from_cpp(const glisson::Mat3d& a, rv_policy, cleanup_list*) noexcept {
    std::vector<double> numbers;
    for (const auto& row : a.m) numbers.insert(numbers.end(), row.begin(), row.end());
    return glisson::python::owned<glisson::python::Doubles>(std::move(numbers), {3, 3}).release();
  }
};

}  // namespace nanobind::detail
