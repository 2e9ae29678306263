// choose_column.h — which column of a file is meant, and in which unit it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fit/data/column_words.h"
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

/// Whether a column has a customary name for what is meant, and its unit is none of another quantity.
bool has_customary(const CurveFile& file, Quantity quantity, ColumnMeaning meaning);
/// The one column that has; complains where none or several do.
std::optional<ChosenColumn> guess_column(const CurveFile& file, Quantity quantity, ColumnMeaning meaning,
                                         const std::string& key, scene::Problems& problems);

/// All columns whose names and units say stress or strain.
std::vector<ChosenColumn> check_columns(const CurveFile& file);

}  // namespace glisson::fit
