#include "io/vtu_array.h"

#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkType.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

#include "io/raw_mesh.h"

namespace glisson::detail {
namespace {

/// Deflate, the compressor of nearly all .vtu files, packs at most 1032 bytes into one.
constexpr std::uint64_t kBestCompression = 1032;

std::string_view attribute(vtkXMLDataElement* element, const char* key) {
  const char* value = element != nullptr ? element->GetAttribute(key) : nullptr;
  return value != nullptr ? value : "";
}

std::string shown(std::string_view text) { return '"' + std::string(text.substr(0, 40)) + '"'; }

vtkSmartPointer<vtkDataCompressor> make_compressor(std::string_view kind, const std::string& name) {
  if (kind.empty()) return nullptr;
  if (kind == "vtkZLibDataCompressor") return vtkSmartPointer<vtkZLibDataCompressor>::New();
  if (kind == "vtkLZ4DataCompressor") return vtkSmartPointer<vtkLZ4DataCompressor>::New();
  if (kind == "vtkLZMADataCompressor") return vtkSmartPointer<vtkLZMADataCompressor>::New();
  fail(name, "compressor " + shown(kind) + " is not known; save it with ZLib, LZ4, LZMA or none");
}

/// Turns every value of `size` bytes around.
void swap_bytes(std::vector<unsigned char>& bytes, std::size_t size) {
  for (auto at = bytes.begin(); at != bytes.end(); at += static_cast<std::ptrdiff_t>(size)) {
    std::reverse(at, at + static_cast<std::ptrdiff_t>(size));
  }
}

std::size_t begin_of(vtkXMLDataElement& element) { return static_cast<std::size_t>(element.GetXMLByteIndex()); }

/// Where the content of the element that begins at `open` begins; a ">" in quotes does not end its tag.
std::size_t end_of_tag(std::string_view bytes, std::size_t open) {
  char quote = 0;
  for (std::size_t i = open; i < bytes.size(); ++i) {
    const char c = bytes[i];
    if (quote == 0 && c == '>') return i + 1;
    if (quote == 0 && (c == '"' || c == '\'')) {
      quote = c;
    } else if (c == quote) {
      quote = 0;
    }
  }
  return bytes.size();
}

struct WordType {
  const char* name;
  int type;
  std::size_t size;
};

constexpr WordType kWordTypes[] = {
    {"Int8", VTK_TYPE_INT8, 1},       {"UInt8", VTK_TYPE_UINT8, 1},   {"Int16", VTK_TYPE_INT16, 2},
    {"UInt16", VTK_TYPE_UINT16, 2},   {"Int32", VTK_TYPE_INT32, 4},   {"UInt32", VTK_TYPE_UINT32, 4},
    {"Int64", VTK_TYPE_INT64, 8},     {"UInt64", VTK_TYPE_UINT64, 8}, {"Float32", VTK_TYPE_FLOAT32, 4},
    {"Float64", VTK_TYPE_FLOAT64, 8},
};

template <class From, class To>
void convert(const std::vector<unsigned char>& bytes, std::vector<To>& out) {
  out.resize(bytes.size() / sizeof(From));
  for (std::size_t i = 0; i < out.size(); ++i) {
    From value;
    std::memcpy(&value, bytes.data() + i * sizeof(From), sizeof(From));
    out[i] = static_cast<To>(value);  // NOLINT(bugprone-signed-char-misuse): Int8 holds numbers
  }
}

template <class To>
void convert_integers(int type, const std::vector<unsigned char>& bytes, std::vector<To>& out) {
  switch (type) {
    case VTK_TYPE_INT8:
      return convert<std::int8_t>(bytes, out);
    case VTK_TYPE_UINT8:
      return convert<std::uint8_t>(bytes, out);
    case VTK_TYPE_INT16:
      return convert<std::int16_t>(bytes, out);
    case VTK_TYPE_UINT16:
      return convert<std::uint16_t>(bytes, out);
    case VTK_TYPE_INT32:
      return convert<std::int32_t>(bytes, out);
    case VTK_TYPE_UINT32:
      return convert<std::uint32_t>(bytes, out);
    case VTK_TYPE_INT64:
      return convert<std::int64_t>(bytes, out);
    default:
      return convert<std::uint64_t>(bytes, out);
  }
}

}  // namespace

VtuArrays::VtuArrays(vtkXMLDataParser& parser, std::string_view bytes, const std::string& name)
    : parser_(parser), log_(vtkSmartPointer<VtkErrorLog>::New()), bytes_(bytes), name_(name),
      room_(bytes.size() * kBestCompression) {
  vtkXMLDataElement* root = parser.GetRootElement();
  compressor_ = make_compressor(attribute(root, "compressor"), name);
  if (compressor_ != nullptr) log_->observe(*compressor_);
  inline_.big_endian = attribute(root, "byte_order") == "BigEndian";
  inline_.word = attribute(root, "header_type") == "UInt64" ? 8 : 4;
  inline_.compressor = compressor_;
  appended_ = inline_;
  if (vtkXMLDataElement* appended = root->FindNestedElementWithName("AppendedData")) {
    appended_.base64 = attribute(appended, "encoding") != "raw";
  }
}

void VtuArrays::refuse(vtkXMLDataElement& element, const std::string& what) const {
  const std::string_view array = attribute(&element, "Name");
  const std::string_view before = bytes_.substr(0, begin_of(element));
  const std::string line = std::to_string(1 + std::count(before.begin(), before.end(), '\n'));
  fail(name_ + ":" + line + ", " + (array.empty() ? std::string(element.GetName()) : "array " + shown(array)), what);
}

std::uint64_t VtuArrays::count(vtkXMLDataElement& element, const char* key, std::uint64_t otherwise) const {
  const std::string_view text = attribute(&element, key);
  if (element.GetAttribute(key) == nullptr) return otherwise;
  std::uint64_t value = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size()) {
    refuse(element, std::string(key) + " = " + shown(text) + "; it must be an integer from 0");
  }
  if (value > room_) {
    refuse(element, std::string(key) + " = " + std::to_string(value) +
                        " is more than the file has room for: the count is wrong or the file is cut off");
  }
  return value;
}

void VtuArrays::require_count(vtkXMLDataElement& element, std::uint64_t found, std::uint64_t count) const {
  if (found == count) return;
  refuse(element, "it must have " + std::to_string(count) + " values, but " +
                      (found > count ? "has more" : "only " + std::to_string(found) + " can be read"));
}

std::vector<unsigned char> VtuArrays::read_text(vtkXMLDataElement& element, int type, std::size_t size,
                                                std::uint64_t count) {
  if (count > bytes_.size()) require_count(element, bytes_.size(), count);
  const auto wanted = static_cast<std::size_t>(count + 1);  // one more, to notice if there are more
  std::vector<unsigned char> bytes(wanted * size);
  require_count(element, parser_.ReadInlineData(&element, 1, bytes.data(), 0, wanted, type), count);
  bytes.resize(bytes.size() - size);
  return bytes;
}

std::vector<unsigned char> VtuArrays::read_block(vtkXMLDataElement& element, std::uint64_t position,
                                                 const VtuPacking& packing, std::size_t size) {
  if (position >= bytes_.size()) refuse(element, "its data begin after the end of the file: it is cut off");
  try {
    std::vector<unsigned char> bytes = unpack_block(bytes_.substr(position), packing, room_);
    if (bytes.size() % size != 0) {
      refuse(element, std::to_string(bytes.size()) + " bytes of data for values of " + std::to_string(size) + " bytes");
    }
    if (packing.big_endian != (std::endian::native == std::endian::big)) swap_bytes(bytes, size);
    return bytes;
  } catch (const BadBlock& bad) {
    refuse(element, bad.what());
  }
}

VtuArrays::Raw VtuArrays::read_raw(vtkXMLDataElement& element, std::uint64_t count) {
  const std::string_view type = attribute(&element, "type"), format = attribute(&element, "format");
  const auto* word =
      std::find_if(std::begin(kWordTypes), std::end(kWordTypes), [&](auto& w) { return type == w.name; });
  if (word == std::end(kWordTypes)) refuse(element, "type " + shown(type) + " is not one of numbers");
  Raw raw{word->type, {}};
  if (format == "appended") {
    const std::uint64_t begin = static_cast<std::uint64_t>(parser_.GetAppendedDataPosition());
    raw.bytes = read_block(element, begin + this->count(element, "offset", 0), appended_, word->size);
  } else if (format == "binary") {
    raw.bytes = read_block(element, end_of_tag(bytes_, begin_of(element)), inline_, word->size);
  } else {
    raw.bytes = read_text(element, word->type, word->size, count);
  }
  require_count(element, raw.bytes.size() / word->size, count);
  return raw;
}

std::vector<double> VtuArrays::read(vtkXMLDataElement& element, std::uint64_t count) {
  const Raw raw = read_raw(element, count);
  std::vector<double> values;
  if (raw.type == VTK_TYPE_FLOAT64) {
    convert<double>(raw.bytes, values);
  } else if (raw.type == VTK_TYPE_FLOAT32) {
    convert<float>(raw.bytes, values);
  } else {
    convert_integers(raw.type, raw.bytes, values);
  }
  return values;
}

std::vector<std::int64_t> VtuArrays::read_integers(vtkXMLDataElement& element, std::uint64_t count) {
  const Raw raw = read_raw(element, count);
  if (raw.type == VTK_TYPE_FLOAT64 || raw.type == VTK_TYPE_FLOAT32) {
    refuse(element, "it must hold integers, not " + std::string(attribute(&element, "type")));
  }
  std::vector<std::int64_t> values;
  convert_integers(raw.type, raw.bytes, values);
  return values;
}

}  // namespace glisson::detail
