// abaqus_reader.cpp — the .inp format of Abaqus, which CalculiX and many meshers write too: nodes, tetrahedra, sets.
//
//   *Element, type=C3D10, elset=liver        a keyword line: options, in any case, with blanks anywhere; it may go on after a comma
//    1, 17, 4, 99, 12, 31, 32, 33,           data lines up to the next keyword; of an element they go on until it has its nodes
//      34, 35, 36                            ** is a comment
//
// What is read: *Node, *Element (C3D4 and C3D10 and their variants), *Nset, *Elset. A node set is a vertex set, an element set a region; where
// element sets share tets the smaller one has them, and the others are vertex sets too. What the analysis does is passed over; what makes
// nodes or elements of others is refused.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include "base/text.h"
#include "io/gmsh_cells.h"

namespace glisson::detail {
namespace {

constexpr std::size_t kTetNodes = 4, kCurvedTetNodes = 10;

/// `*Elset, elset=liver, generate`: a keyword in lower case and its options, the names of options in lower case.
struct Keyword {
  std::string word;
  std::map<std::string, std::string> options;

  bool has(const std::string& option) const { return options.contains(option); }
  std::string value(const std::string& option) const { return has(option) ? options.at(option) : std::string(); }
};

std::vector<std::string_view> parts_of(std::string_view line) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    parts.push_back(trimmed(line.substr(0, comma)));
    if (comma == line.size()) return parts;
    line.remove_prefix(comma + 1);
  }
}

Keyword keyword_of(std::string_view line) {
  Keyword keyword;
  for (const std::string_view part : parts_of(line.substr(1))) {
    if (keyword.word.empty()) {
      keyword.word = lower_case(part);
      std::erase(keyword.word, ' ');
      continue;
    }
    const std::size_t equals = std::min(part.find('='), part.size());
    std::string value(trimmed(part.substr(std::min(equals + 1, part.size()))));
    std::erase(value, '"');
    keyword.options[lower_case(trimmed(part.substr(0, equals)))] = std::move(value);
  }
  return keyword;
}

class AbaqusReader {
 public:
  AbaqusReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}
  RawMesh read();

 private:
  struct ElementSet {
    std::string name;
    bool internal = false;
    std::vector<std::uint64_t> elements{};
  };
  struct Element {
    std::uint64_t number;
    std::vector<std::uint64_t> nodes;
    std::size_t line;
  };

  bool next_line(std::string_view& line);
  [[noreturn]] void refuse(const std::string& what) const { fail(name_ + ":" + std::to_string(line_), what); }
  std::uint64_t number_in(std::string_view part, const char* what) const;
  double real_in(std::string_view part, const char* what) const;
  void begin(const Keyword& keyword);
  void begin_elements(const Keyword& keyword);
  void begin_part();
  void take(std::string_view line);
  void take_node(std::string_view line);
  void take_element(std::string_view line);
  void take_set(std::string_view line, std::vector<std::uint64_t>& numbers);
  ElementSet& element_set(const std::string& name, bool internal);
  void finish_elements();
  void finish_node_sets();
  void finish_regions();

  std::string_view bytes_;
  std::string name_;
  std::size_t position_ = 0, line_ = 0;
  Keyword keyword_{};
  std::string elements_{};         ///< kind of elements that follow; empty: none
  std::size_t element_nodes_ = 0;  ///< of a tet that is read; 0: others
  bool skipped_goes_on_ = false;
  std::vector<std::uint64_t> open_element_{};  ///< numbers of one whose nodes are not complete yet
  std::uint64_t parts_ = 0;
  std::size_t nodes_in_part_ = 0;
  bool in_assembly_ = false;
  GmshNodeIndex nodes_;
  std::vector<Element> tets_;
  std::map<std::string, std::vector<std::uint64_t>> node_sets_;
  std::vector<ElementSet> element_sets_;
  RawMesh raw_;
};

bool AbaqusReader::next_line(std::string_view& line) {
  while (position_ < bytes_.size()) {
    const std::size_t end = std::min(bytes_.find('\n', position_), bytes_.size());
    line = trimmed(bytes_.substr(position_, end - position_));
    position_ = std::min(end + 1, bytes_.size());
    ++line_;
    if (!line.empty() && !line.starts_with("**")) return true;
  }
  return false;
}

std::uint64_t AbaqusReader::number_in(std::string_view part, const char* what) const {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc() || end != part.data() + part.size() || value > (std::uint64_t{1} << 62)) {
    refuse(std::string("expected ") + what + ", a whole number, found \"" + std::string(part.substr(0, 40)) + "\"");
  }
  return value;
}

/// A number, with the exponents of Fortran too: 1.5D-3.
double AbaqusReader::real_in(std::string_view part, const char* what) const {
  std::string text(part);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == 'd' || c == 'D'; }, 'e');
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    refuse(std::string("expected ") + what + ", a finite number, found \"" + text.substr(0, 40) + "\"");
  }
  return value;
}

void AbaqusReader::begin(const Keyword& keyword) {
  if (!open_element_.empty()) {
    refuse("the element before has " + std::to_string(open_element_.size() - 1) + " nodes of " +
           std::to_string(element_nodes_) + ": the file is damaged");
  }
  const std::string& word = keyword.word;
  if (word == "ngen" || word == "nfill" || word == "ncopy" || word == "nmap" || word == "elgen" || word == "elcopy" ||
      word == "include" || word == "system") {
    refuse("*" + word + " is not read; write the mesh out flat, with every node, element and file in it");
  }
  if (word == "part" || word == "endpart") nodes_in_part_ = 0;
  if (word == "assembly" || word == "endassembly") in_assembly_ = word == "assembly";
  if (word == "node" && keyword.has("system") && lower_case(keyword.value("system")) != "r") {
    refuse("nodes in the system \"" + keyword.value("system") + "\" are not read, only rectangular ones");
  }
  elements_.clear();
  if (word == "element") begin_elements(keyword);
}

void AbaqusReader::begin_elements(const Keyword& keyword) {
  elements_ = keyword.value("type");
  std::string kind = lower_case(elements_);
  if (kind.starts_with("dc3d") || kind.starts_with("ac3d")) kind.erase(0, 1);
  const auto is = [&](std::string_view type) {
    return kind.starts_with(type) &&
           (kind.size() == type.size() || std::isalpha(static_cast<unsigned char>(kind[type.size()])) != 0);
  };
  element_nodes_ = is("c3d4") ? kTetNodes : is("c3d10") ? kCurvedTetNodes : 0;
  skipped_goes_on_ = false;
}

AbaqusReader::ElementSet& AbaqusReader::element_set(const std::string& name, bool internal) {
  const auto found = std::find_if(element_sets_.begin(), element_sets_.end(),
                                  [&](const ElementSet& s) { return lower_case(s.name) == lower_case(name); });
  if (found != element_sets_.end()) return *found;
  return element_sets_.emplace_back(ElementSet{.name = name, .internal = internal});
}

/// Every part numbers its nodes anew: those of one can be read.
void AbaqusReader::begin_part() {
  if (nodes_in_part_++ > 0) return;
  if (++parts_ > 1) {
    refuse("nodes of a second part; write each part to a file of its own, or the model without parts");
  }
}

void AbaqusReader::take_node(std::string_view line) {
  begin_part();
  const std::vector<std::string_view> parts = parts_of(line);
  if (parts.size() < 4) refuse("a node needs its number and three coordinates");
  nodes_.add(number_in(parts[0], "the number of a node"));
  raw_.mesh.vertices.push_back({real_in(parts[1], "x"), real_in(parts[2], "y"), real_in(parts[3], "z")});
  if (keyword_.has("nset")) node_sets_[keyword_.value("nset")].push_back(number_in(parts[0], "the number of a node"));
}

void AbaqusReader::take_element(std::string_view line) {
  if (element_nodes_ == 0) {
    if (!skipped_goes_on_) ++raw_.skipped["elements of type " + elements_];
    skipped_goes_on_ = line.ends_with(',');
    return;
  }
  for (const std::string_view part : parts_of(line)) {
    if (!part.empty()) open_element_.push_back(number_in(part, "the number of a node"));
  }
  if (open_element_.size() < element_nodes_ + 1) return;
  if (open_element_.size() > element_nodes_ + 1) {
    refuse(std::to_string(open_element_.size() - 1) + " nodes of an element of type " + elements_ + ", which has " +
           std::to_string(element_nodes_));
  }
  const std::uint64_t number = open_element_.front();
  if (keyword_.has("elset")) element_set(keyword_.value("elset"), false).elements.push_back(number);
  open_element_.erase(open_element_.begin());
  tets_.push_back({number, std::move(open_element_), line_});
  open_element_.clear();
}

/// Numbers, ranges of them with `generate`, or names of other sets, which are passed over for what they hold already.
void AbaqusReader::take_set(std::string_view line, std::vector<std::uint64_t>& numbers) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 32;  // in a set, as vertices
  const std::vector<std::string_view> parts = parts_of(line);
  if (keyword_.has("generate")) {
    const std::uint64_t first = number_in(parts[0], "the first of a range");
    const std::uint64_t last = parts.size() > 1 ? number_in(parts[1], "the last of a range") : first;
    const std::uint64_t step = parts.size() > 2 && !parts[2].empty() ? number_in(parts[2], "the step of a range") : 1;
    if (step == 0 || last < first || (last - first) / step > bytes_.size()) {
      refuse("a range from " + std::to_string(first) + " to " + std::to_string(last) + " by " + std::to_string(step) +
             "; it must rise, to no more numbers than the file can hold");
    }
    for (std::uint64_t n = first; n <= last && numbers.size() < kMost; n += step) numbers.push_back(n);
    return;
  }
  for (const std::string_view part : parts) {
    if (part.empty()) continue;
    if (std::isdigit(static_cast<unsigned char>(part.front())) != 0) {
      numbers.push_back(number_in(part, "a number of the set"));
    } else if (keyword_.word == "nset") {
      if (const auto found = node_sets_.find(std::string(part)); found != node_sets_.end()) {
        const std::vector<std::uint64_t> others = found->second;
        numbers.insert(numbers.end(), others.begin(), others.end());
      }
    } else {
      const std::vector<std::uint64_t> others = element_set(std::string(part), false).elements;
      numbers.insert(numbers.end(), others.begin(), others.end());
    }
  }
}

void AbaqusReader::take(std::string_view line) {
  const std::string& word = keyword_.word;
  // What an assembly adds to its parts are points of reference, and sets of these.
  if (in_assembly_ && !keyword_.has("instance")) return;
  if (word == "node") return take_node(line);
  if (word == "element" && !elements_.empty()) return take_element(line);
  if (word == "nset" && !keyword_.has("internal")) return take_set(line, node_sets_[keyword_.value("nset")]);
  if (word != "elset") return;
  std::vector<std::uint64_t> numbers;
  take_set(line, numbers);
  auto& all = element_set(keyword_.value("elset"), keyword_.has("internal")).elements;
  all.insert(all.end(), numbers.begin(), numbers.end());
}

void AbaqusReader::finish_elements() {
  if (const std::uint64_t* twice = nodes_.finish()) {
    fail(name_, "node " + std::to_string(*twice) + " is given twice; every node needs a number of its own");
  }
  for (const Element& element : tets_) {
    std::array<std::uint32_t, kCurvedTetNodes> at{};
    for (std::size_t i = 0; i < element.nodes.size(); ++i) {
      const std::uint32_t* found = nodes_.find(element.nodes[i]);
      if (found == nullptr) {
        fail(name_ + ":" + std::to_string(element.line), "element " + std::to_string(element.number) +
                                                             " refers to node " + std::to_string(element.nodes[i]) +
                                                             ", which the file does not hold");
      }
      at[i] = *found;
    }
    raw_.mesh.tets.push_back({at[0], at[1], at[2], at[3]});
    if (element.nodes.size() == kCurvedTetNodes) {
      raw_.curved.push_back({raw_.mesh.tets.back(), {at[4], at[5], at[6], at[7], at[8], at[9]}});
    }
  }
}

void AbaqusReader::finish_node_sets() {
  for (const auto& [set, numbers] : node_sets_) {
    auto& vertices = raw_.mesh.vertex_sets[set];
    for (const std::uint64_t number : numbers) {
      if (const std::uint32_t* found = nodes_.find(number)) vertices.push_back(*found);
    }
  }
}

/// The smallest of the sets that have a tet gives it its region; the others become vertex sets too.
void AbaqusReader::finish_regions() {
  std::map<std::uint64_t, std::size_t> tet_of;
  for (std::size_t t = 0; t < tets_.size(); ++t) tet_of.emplace(tets_[t].number, t);
  std::vector<std::pair<const ElementSet*, std::set<std::size_t>>> sets;
  for (const ElementSet& set : element_sets_) {
    std::set<std::size_t> tets;
    for (const std::uint64_t number : set.elements) {
      if (const auto found = tet_of.find(number); found != tet_of.end()) tets.insert(found->second);
    }
    if (!tets.empty()) sets.emplace_back(&set, std::move(tets));
  }
  std::stable_sort(sets.begin(), sets.end(), [](const auto& a, const auto& b) {
    return std::pair(a.first->internal, a.second.size()) < std::pair(b.first->internal, b.second.size());
  });
  TetMesh& mesh = raw_.mesh;
  if (!sets.empty()) mesh.regions.assign(mesh.tets.size(), 0);
  int number = 0;
  for (const auto& [set, tets] : sets) {
    std::size_t own = 0;
    for (const std::size_t t : tets) {
      if (mesh.regions[t] != 0) continue;
      mesh.regions[t] = number + 1;
      ++own;
    }
    if (own > 0) mesh.region_names[++number] = set->name;
    if (own == tets.size() || set->internal || mesh.vertex_sets.contains(set->name)) continue;
    auto& vertices = mesh.vertex_sets[set->name];
    for (const std::size_t t : tets) vertices.insert(vertices.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    raw_.notes.push_back("Element set \"" + set->name +
                         "\" shares tets with smaller ones, whose regions these are: it is "
                         "a vertex set too.");
  }
}

RawMesh AbaqusReader::read() {
  std::string_view line;
  bool any = false;
  std::string whole;  // of a keyword that goes on
  while (next_line(line)) {
    const bool goes_on = !whole.empty();
    if (!goes_on && !line.starts_with('*')) {
      if (!any) refuse("an Abaqus file begins with a keyword, such as *Node; this is another format");
      take(line);
      continue;
    }
    whole += line;
    if (line.ends_with(',')) continue;
    keyword_ = keyword_of(whole);
    whole.clear();
    any = true;
    begin(keyword_);
  }
  if (!open_element_.empty() || !whole.empty()) refuse("the file ends within a line that goes on: it is cut off");
  finish_elements();
  finish_node_sets();
  finish_regions();
  return std::move(raw_);
}

}  // namespace

RawMesh read_abaqus(std::string_view bytes, const std::string& name) { return AbaqusReader(bytes, name).read(); }

}  // namespace glisson::detail
