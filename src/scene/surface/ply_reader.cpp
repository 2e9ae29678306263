// ply_reader.cpp — .ply: a head that names elements and their properties, then their values as text or in either byte order.
//
// Of the element `vertex` the properties x, y and z are taken, of `face` the list vertex_indices (or vertex_index), whose polygons
// become fans; all else is passed over.
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/text.h"
#include "scene/surface/surface_source.h"

namespace glisson::surface_file {
namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<Type> type_called(std::string_view name) {
  static constexpr struct {
    const char* names[2];
    Type type;
  } kTypes[] = {{{"char", "int8"}, Type::int8},        {{"uchar", "uint8"}, Type::uint8},
                {{"short", "int16"}, Type::int16},     {{"ushort", "uint16"}, Type::uint16},
                {{"int", "int32"}, Type::int32},       {{"uint", "uint32"}, Type::uint32},
                {{"float", "float32"}, Type::float32}, {{"double", "float64"}, Type::float64}};
  for (const auto& t : kTypes) {
    if (name == t.names[0] || name == t.names[1]) return t.type;
  }
  return {};
}

struct Property {
  std::string name;
  Type type{};
  std::optional<Type> length;  ///< of a list: the type of its length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  explicit PlyReader(Source& source) : source_(source) {}

  TriangleSurface run() {
    read_head();
    if (order_) source_.set_binary(*order_);
    for (const Element& element : elements_) read_element(element);
    return std::move(surface_);
  }

 private:
  void read_head() {
    std::string_view line;
    bool has_format = false;
    if (!source_.line(line) || line != "ply") source_.fail("a .ply file begins with \"ply\", found " + shown(line));
    while (true) {
      if (!source_.line(line)) source_.fail("the file ends before \"end_header\": it is cut off; write it again");
      const std::string_view keyword = first_word(line);
      if (keyword == "end_header") break;
      if (keyword == "format") {
        read_format(first_word(line));
        has_format = true;
      } else if (keyword == "element") {
        announce(line);
      } else if (keyword == "property") {
        describe(line);
      } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
        source_.fail("expected format, element, property, comment or end_header, found " + shown(keyword));
      }
    }
    if (!has_format) source_.fail("the head names no format; it is ascii, binary_little_endian or binary_big_endian");
  }

  void read_format(std::string_view name) {
    if (name == "binary_little_endian") {
      order_ = std::endian::little;
    } else if (name == "binary_big_endian") {
      order_ = std::endian::big;
    } else if (name != "ascii") {
      source_.fail("format " + shown(name) + "; it is ascii, binary_little_endian or binary_big_endian");
    }
  }

  void announce(std::string_view line) {
    Element element{std::string(first_word(line)), 0, {}};
    const std::string_view count = first_word(line);
    const double number = real_in(source_, count, "the number of elements");
    // No element takes less than a byte.
    if (!(number >= 0.0) || number != std::floor(number) || number > static_cast<double>(source_.bytes().size()))
      source_.fail(shown(count) + " elements " + shown(element.name) +
                   " is no count, or more than the file has room for: it is wrong or cut off");
    element.count = static_cast<std::uint64_t>(number);
    elements_.push_back(std::move(element));
  }

  Type type_of(std::string_view name) const {
    const std::optional<Type> type = type_called(name);
    if (!type) source_.fail("values of type " + shown(name) + " are not read");
    return *type;
  }

  void describe(std::string_view line) {
    if (elements_.empty()) source_.fail("a property before the first element");
    Property property;
    std::string_view type = first_word(line);
    if (type == "list") {
      property.length = type_of(first_word(line));
      type = first_word(line);
    }
    property.type = type_of(type);
    property.name = first_word(line);
    elements_.back().properties.push_back(std::move(property));
  }

  double value(Type type, const std::string& what) {
    if (!order_) return real_in(source_, word(what), what.c_str());
    switch (type) {
      case Type::int8:
        return source_.number<std::int8_t>(what);
      case Type::uint8:
        return source_.number<std::uint8_t>(what);
      case Type::int16:
        return source_.number<std::int16_t>(what);
      case Type::uint16:
        return source_.number<std::uint16_t>(what);
      case Type::int32:
        return source_.number<std::int32_t>(what);
      case Type::uint32:
        return source_.number<std::uint32_t>(what);
      case Type::float32:
        return source_.number<float>(what);
      case Type::float64:
        return source_.number<double>(what);
    }
    return 0.0;
  }

  std::string_view word(const std::string& what) {
    const std::string_view found = source_.word();
    if (found.empty()) source_.fail("the file ends before " + what + ": it is cut off; write it again");
    return found;
  }

  /// @return a whole number from 0 to `most`
  std::uint64_t whole(Type type, double most, const std::string& what) {
    const double number = value(type, what);
    if (!(number >= 0.0 && number <= most) || number != std::floor(number))
      source_.fail(what + " is " + detail::show(number) + "; allowed: whole numbers from 0 to " + detail::show(most));
    return static_cast<std::uint64_t>(number);
  }

  void read_element(const Element& element) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    if (element.properties.empty()) return;
    if (is_vertex) require_coordinates(element);
    if (is_face) require_corners(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const std::string what = element.name + " " + std::to_string(i);
      Vec3d place{};
      for (const Property& property : element.properties) {
        if (property.length) {
          read_list(property, is_face && is_corners(property), what);
          continue;
        }
        const double number = value(property.type, what);
        if (is_vertex && property.name.size() == 1 && property.name >= "x" && property.name <= "z")
          place[static_cast<std::size_t>(property.name[0] - 'x')] = number;
      }
      if (!is_vertex) continue;
      if (!std::isfinite(place.x + place.y + place.z))
        source_.fail(what + " has a coordinate that is not finite; repair the file");
      surface_.points.push_back(place);
    }
  }

  void require_coordinates(const Element& element) const {
    for (const char* name : {"x", "y", "z"}) {
      const auto is_it = [&](const Property& p) { return p.name == name && !p.length; };
      if (std::none_of(element.properties.begin(), element.properties.end(), is_it))
        source_.fail(std::string("the element \"vertex\" has no property ") + name);
    }
  }
  static bool is_corners(const Property& p) {
    return p.length && (p.name == "vertex_indices" || p.name == "vertex_index");
  }
  void require_corners(const Element& element) const {
    if (std::none_of(element.properties.begin(), element.properties.end(), is_corners))
      source_.fail("the element \"face\" has no list vertex_indices; write the surface with faces");
  }

  /// A list; that of a face's corners becomes a fan.
  void read_list(const Property& property, bool corners, const std::string& what) {
    const std::uint64_t length =
        whole(*property.length, static_cast<double>(source_.left()), "length of a list of " + what);
    if (corners && length < 3)
      source_.fail(what + " has " + detail::count_text(length, "vertex", "vertices") + "; it needs three");
    std::uint32_t first = 0, last = 0;
    for (std::uint64_t k = 0; k < length; ++k) {
      if (!corners) {
        value(property.type, what);
        continue;
      }
      if (surface_.points.empty()) source_.fail("faces before vertices, or no vertices; write the vertices first");
      const auto point = static_cast<std::uint32_t>(
          whole(property.type, static_cast<double>(surface_.points.size() - 1), "a vertex of " + what));
      if (k == 0) first = point;
      if (k >= 2) surface_.triangles.push_back({first, last, point});
      last = point;
    }
  }

  Source& source_;
  std::vector<Element> elements_;
  std::optional<std::endian> order_;  ///< none: text
  TriangleSurface surface_;
};

}  // namespace

TriangleSurface read_ply(Source& source) { return PlyReader(source).run(); }

}  // namespace glisson::surface_file
