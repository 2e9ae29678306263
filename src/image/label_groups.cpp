// label_groups.cpp — `liver`, `5`, `vessels=63+64`: words to groups of labels.
#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "base/nearest.h"
#include "base/text.h"
#include "glisson/image/clean_labels.h"

namespace glisson {
namespace {

int label_called(const std::string& word, const std::map<int, std::string>& names) {
  int number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error == std::errc() && end == word.data() + word.size()) {
    if (number < 1 || number > 65535)
      throw std::invalid_argument("label " + word + " is out of range; allowed: 1 to 65535 (0 is the background)");
    return number;
  }
  std::vector<std::string> known;
  for (const auto& [label, name] : names) {
    if (detail::lower_case(name) == detail::lower_case(word)) return label;
    known.push_back(name);
  }
  if (known.empty())
    throw std::invalid_argument("\"" + word +
                                "\" is no number, and the image gives its labels no names; give their numbers");
  const std::string meant = scene::nearest(word, known);
  throw std::invalid_argument(
      "no label is called \"" + word + "\"" +
      (meant.empty() ? "; `glisson info IMAGE` lists them" : "; did you mean \"" + meant + "\"?"));
}

LabelGroup group_of(std::string_view word, const std::map<int, std::string>& names) {
  LabelGroup group;
  if (const std::size_t equals = word.find('='); equals != word.npos) {
    group.name = detail::trimmed(word.substr(0, equals));
    if (group.name.empty()) throw std::invalid_argument("\"" + std::string(word) + "\" has no name before the =");
    word.remove_prefix(equals + 1);
  }
  for (bool more = true; more;) {
    const std::size_t plus = word.find('+');
    const std::string_view part = detail::trimmed(word.substr(0, plus));
    if (part.empty())
      throw std::invalid_argument("a label is missing in \"" + std::string(word) +
                                  "\"; give numbers or names, joined by +");
    group.labels.push_back(label_called(std::string(part), names));
    more = plus != word.npos;
    word.remove_prefix(more ? plus + 1 : word.size());
  }
  if (group.name.empty()) {
    const auto name = names.find(group.number());
    group.name = name == names.end() ? "label_" + std::to_string(group.number()) : name->second;
  }
  return group;
}

}  // namespace

std::vector<LabelGroup> label_groups(std::span<const std::string> words, const std::map<int, std::string>& names) {
  std::vector<LabelGroup> groups;
  std::vector<int> used;
  for (const std::string& word : words) {
    groups.push_back(group_of(detail::trimmed(word), names));
    for (const int label : groups.back().labels) {
      if (std::find(used.begin(), used.end(), label) != used.end())
        throw std::invalid_argument("label " + std::to_string(label) + " is named twice; each belongs to one region");
      used.push_back(label);
    }
    for (std::size_t i = 0; i + 1 < groups.size(); ++i) {
      if (groups[i].name == groups.back().name)
        throw std::invalid_argument("two regions are called \"" + groups[i].name + "\"; name them apart: NAME=LABEL");
    }
  }
  if (groups.empty()) throw std::invalid_argument("no label is chosen; give one or more, by number or name");
  return groups;
}

}  // namespace glisson
