// law_table.h — what a dear run says of a law, between runs that were made: a table over the parameters that the law depends on.
//
//   each such parameter from its low to its high bound in 32 parts, by its own scale; of these every 8th, 4th, 2nd or all
//   are taken: as few as a cubic between them needs along the line through the start. Between them cubics of continuous
//   slope, in each parameter in turn. Nodes are run when they are first asked for, from many threads.
//
// A tissue's branches and viscosity are none of its law. Of more than three parameters a table is larger than a search: then every
// run is made itself, once.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/fit.h"

namespace glisson::fit {

class LawTable {
 public:
  using Row = std::vector<double>;
  using Run = std::function<Row(std::span<const double>)>;

  /// @param parameters  of the values @param active  which of them `run` depends on
  /// @param run  numbers, always as many, smooth in the values; throws std::exception where there are none
  /// @param error  of the cubics along the lines through the start; 0: every run is made itself
  LawTable(std::vector<Parameter> parameters, std::vector<std::size_t> active, Run run, double error);

  /// @throws std::runtime_error where a node beside the values has none
  Row at(std::span<const double> values) const;
  /// Runs so far.
  std::size_t runs() const;

  static constexpr std::size_t kMostActive = 3;

 private:
  static constexpr int kParts = 32, kWidest = 8;
  struct Node {
    std::once_flag once;
    Row row;
    std::string failure;
  };
  using Index = std::vector<int>;

  const Node& node(const Index& index) const;
  Row exactly(std::span<const double> values) const;
  void look_along_lines() const;
  double error_along(const Index& start, std::size_t dimension, int stride) const;
  std::optional<Row> between(Index& index, std::size_t dimension, const std::vector<double>& place,
                             std::string& failure) const;
  double place_of(std::size_t dimension, double value) const;
  double value_of(std::size_t dimension, int part) const;

  std::vector<Parameter> parameters_;
  std::vector<std::size_t> active_;
  Run run_;
  double error_;
  mutable std::once_flag looked_;
  mutable std::vector<int> strides_;
  mutable std::mutex mutex_;
  mutable std::map<Index, std::shared_ptr<Node>> nodes_;
  mutable std::map<Row, std::shared_ptr<Node>> exact_;
};

}  // namespace glisson::fit
