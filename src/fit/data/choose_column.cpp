#include "fit/data/choose_column.h"

#include <algorithm>
#include <functional>
#include <tuple>

#include "base/nearest.h"
#include "base/text.h"

namespace glisson::fit {
namespace {

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

scene::Origin at_names(const CurveFile& file) { return {std::max(file.names_line, 1U), 1, {}}; }

std::string names_of(const CurveFile& file) {
  std::string text;
  for (std::size_t i = 0; i < file.names.size(); ++i) text.append(text.empty() ? "" : ", ").append(file.title(i));
  return text;
}

std::vector<std::size_t> matching(const CurveFile& file, const std::function<bool(const std::string&)>& matches) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < file.names.size(); ++i) {
    if (matches(file.names[i])) found.push_back(i);
  }
  return found;
}

/// Exactly, else but for case, else but for the unit.
std::vector<std::size_t> named(const CurveFile& file, const std::string& name) {
  auto found = matching(file, [&](const std::string& n) { return n == name; });
  if (found.empty())
    found = matching(file, [&](const std::string& n) { return detail::lower_case(n) == detail::lower_case(name); });
  const auto bare = [](const std::string& n) { return detail::lower_case(split_title(n).name); };
  if (found.empty()) found = matching(file, [&](const std::string& n) { return bare(n) == detail::lower_case(name); });
  return found;
}

void complain_of_several(const CurveFile& file, const std::vector<std::size_t>& found, const std::string& name,
                         const std::string& key, scene::Problems& problems) {
  std::string numbers;
  for (const std::size_t i : found) numbers.append(numbers.empty() ? "" : ", ").append(std::to_string(i + 1));
  problems.add(at_names(file), key,
               std::to_string(found.size()) + " columns match " + in_quotes(name) + ": numbers " + numbers +
                   "; choose one by `number`");
}

void complain_of_name(const CurveFile& file, const std::string& name, const std::string& key,
                      scene::Problems& problems) {
  if (file.names.empty()) {
    problems.add(at_names(file), key,
                 "no column " + in_quotes(name) + ": the file has no line of names; choose by `number`, 1 to " +
                     std::to_string(file.columns) + ", or say `text.names_line`");
    return;
  }
  const std::string meant = scene::nearest(name, file.names);
  problems.add(at_names(file), key,
               "no column " + in_quotes(name) + (meant.empty() ? "" : "; did you mean " + in_quotes(meant) + "?") +
                   " Columns: " + names_of(file));
}

std::optional<std::size_t> index_of(const CurveFile& file, const ColumnSpec& spec, const std::string& key,
                                    scene::Problems& problems) {
  if (spec.number) {
    if (*spec.number >= 1 && static_cast<std::size_t>(*spec.number) <= file.columns) return *spec.number - 1;
    problems.add(
        at_names(file), key,
        "no column number " + std::to_string(*spec.number) + "; allowed: 1 to " + std::to_string(file.columns));
    return std::nullopt;
  }
  const auto found = named(file, spec.name);
  if (found.size() == 1) return found.front();
  if (found.empty())
    complain_of_name(file, spec.name, key, problems);
  else
    complain_of_several(file, found, spec.name, key, problems);
  return std::nullopt;
}

/// The unit that is said, else that of the file, else of strain a pure number.
const Unit* unit_of(const CurveFile& file, std::size_t column, const std::string& said, Quantity quantity,
                    const std::string& key, scene::Problems& problems) {
  if (file.is_clock(column)) {
    const Unit* seconds = quantity == Quantity::time ? find_unit(quantity, "s") : nullptr;
    if (seconds && (said.empty() || said == "s")) return seconds;
    problems.add(at_names(file), key,
                 "column " + file.title(column) + " holds clock times, from " + in_quotes(file.clocks[column]) +
                     " on, " + (seconds ? "which are read in seconds; leave `unit` out" : "which are a time"));
    return nullptr;
  }
  const std::string in_file = column < file.units.size() ? file.units[column] : std::string{};
  std::string text = said.empty() ? in_file : said;
  if (text.empty() && (quantity == Quantity::strain || quantity == Quantity::stretch)) text = "-";
  const Unit* unit = find_unit(quantity, text);
  if (unit) return unit;
  if (quantity == Quantity::frequency && is_per_second(text)) {
    if (column < file.names.size() && says_angular(split_title(file.names[column]).name))
      return find_unit(quantity, "rad/s");
    problems.add(at_names(file), key,
                 in_quotes(text) + " of column " + file.title(column) +
                     " may be Hz or rad/s; give `unit` as the one that is meant: " + key +
                     " = { number = " + std::to_string(column + 1) + ", unit = \"Hz\" } or unit = \"rad/s\"");
    return nullptr;
  }
  problems.add(at_names(file), key,
               (text.empty() ? "column " + file.title(column) + " says no unit"
                             : "unknown unit " + in_quotes(text) + " of column " + file.title(column)) +
                   "; give `unit` as one of " + unit_names(quantity));
  return nullptr;
}

/// Columns with a customary name. Beside a unit that is of another quantity the name does not count: "Compression (%)",
/// "Load cell (mV)".
std::vector<std::size_t> customary(const CurveFile& file, Quantity quantity, ColumnMeaning meaning) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < file.names.size(); ++i) {
    if (!file.units[i].empty() && !may_be(quantity, file.units[i])) continue;
    if (has_meaning(split_title(file.names[i]).name, meaning)) found.push_back(i);
  }
  return found;
}

}  // namespace

std::optional<ChosenColumn> choose_column(const CurveFile& file, const ColumnSpec& spec, Quantity quantity,
                                          const std::string& key, scene::Problems& problems) {
  const auto index = index_of(file, spec, key, problems);
  if (!index) return std::nullopt;
  const Unit* unit = unit_of(file, *index, spec.unit, quantity, key, problems);
  if (!unit) return std::nullopt;
  return ChosenColumn{*index, {file.title(*index), quantity, unit, key}};
}

bool has_customary(const CurveFile& file, Quantity quantity, ColumnMeaning meaning) {
  return !customary(file, quantity, meaning).empty();
}

std::optional<ChosenColumn> guess_column(const CurveFile& file, Quantity quantity, ColumnMeaning meaning,
                                         const std::string& key, scene::Problems& problems) {
  const std::vector<std::size_t> found = customary(file, quantity, meaning);
  if (found.size() == 1) {
    ColumnSpec spec;
    spec.number = static_cast<std::int32_t>(found.front() + 1);
    return choose_column(file, spec, quantity, key, problems);
  }
  const std::string some = file.names.empty() ? "the file has no line of names" : "columns: " + names_of(file);
  problems.add(at_names(file), key,
               (found.empty() ? "is not given, and no column has a customary name for it; "
                              : "is not given, and several columns could be it; ") +
                   some + "; say " + key + " = { " + (file.names.empty() ? "number = 1" : "name = \"…\"") +
                   ", unit = \"" + std::string(units_of(quantity).front().name) + "\" }" +
                   (quantity == Quantity::time ? " or speed_mm_s" : ""));
  return std::nullopt;
}

std::vector<ChosenColumn> check_columns(const CurveFile& file) {
  std::vector<ChosenColumn> found;
  for (std::size_t i = 0; i < file.names.size(); ++i) {
    const std::string name = split_title(file.names[i]).name;
    for (const auto& [quantity, meaning, word] : {std::tuple{Quantity::stress, ColumnMeaning::stress, "stress"},
                                                  std::tuple{Quantity::strain, ColumnMeaning::strain, "strain"}}) {
      const Unit* unit = find_unit(quantity, file.units[i]);
      const bool says = has_meaning(name, meaning) || detail::lower_case(name).find(word) != std::string::npos;
      if (unit && says) found.push_back({i, {file.title(i), quantity, unit, std::string("columns.") + word}});
    }
  }
  return found;
}

}  // namespace glisson::fit
