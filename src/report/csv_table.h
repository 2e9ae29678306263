// csv_table.h — rows of numbers: as lines of a .csv, and as what the page shows of them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace glisson {

std::string csv_line(const std::vector<std::string>& names);
/// Each number the shortest that reads back as the same double.
std::string csv_line(const std::vector<double>& row);

/// Columns of web/src/report_data.ts: all rows of a short table, else the first hundred and then evenly spaced ones to the last.
nlohmann::json table_json(const std::vector<std::string>& columns, const std::vector<std::vector<double>>& table);

}  // namespace glisson
