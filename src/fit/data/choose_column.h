// choose_column.h — which column of a file is meant, and in which unit it is.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "fit/data/data_spec.h"
#include "fit/data/raw_test.h"

namespace glisson::fit {

struct ChosenColumn {
  std::size_t index = 0;
  Source source;
};

/// The column that the user names, exactly or but for case, blanks and the unit. @param key  `columns.force`
/// Complains and returns nothing where there is none, or two, or its unit is not known.
std::optional<ChosenColumn> choose_column(const CurveFile& file, const ColumnSpec& spec, Quantity quantity,
                                          const std::string& key, scene::Problems& problems);

/// Whether a column's name begins with one of the words, and its unit is none of another quantity.
bool has_customary(const CurveFile& file, Quantity quantity, std::span<const std::string_view> words);
/// The one column whose name does; complains where none or several do.
std::optional<ChosenColumn> guess_column(const CurveFile& file, Quantity quantity,
                                         std::span<const std::string_view> words, const std::string& key,
                                         scene::Problems& problems);

/// All columns whose names and units say stress or strain.
std::vector<ChosenColumn> check_columns(const CurveFile& file);

}  // namespace glisson::fit
