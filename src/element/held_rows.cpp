#include "glisson/simulation/held_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "glisson/archive.h"

namespace glisson {

void VertexWeight::archive(Archive& ar) { ar(vertex, weight); }

void HeldRows::Row::archive(Archive& ar) { ar(mean, direction); }

std::uint32_t HeldRows::add_mean(std::span<const VertexWeight> mean) {
  weights_.insert(weights_.end(), mean.begin(), mean.end());
  mean_ends_.push_back(static_cast<std::uint32_t>(weights_.size()));
  return static_cast<std::uint32_t>(mean_ends_.size() - 1);
}

void HeldRows::end_group(std::span<const double> compliance) {
  const auto end = static_cast<std::uint32_t>(rows_.size()), free = groups_.empty() ? 0U : groups_.back()[1];
  const auto size = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(compliance.size()))));
  if (std::size_t{size} * size != compliance.size() || size > end - free) {
    throw std::invalid_argument("HeldRows::end_group: the compliance must have the square of a number of rows");
  }
  compliance_.insert(compliance_.end(), compliance.begin(), compliance.end());
  groups_.push_back({end - size, end, static_cast<std::uint32_t>(compliance_.size())});
}

std::span<const VertexWeight> HeldRows::mean(std::size_t k) const {
  const std::size_t begin = k == 0 ? 0 : mean_ends_[k - 1];
  return std::span(weights_).subspan(begin, mean_ends_[k] - begin);
}

HeldRows::Group HeldRows::group(std::size_t k) const {
  const std::size_t begin = k == 0 ? 0 : groups_[k - 1][2];
  return {groups_[k][0], groups_[k][1], std::span(compliance_).subspan(begin, groups_[k][2] - begin)};
}

bool HeldRows::has_means_of(const HeldRows& other) const {
  return weights_ == other.weights_ && mean_ends_ == other.mean_ends_ && vertices_ == other.vertices_;
}

void HeldRows::archive(Archive& ar) {
  ar(weights_, mean_ends_, rows_, groups_, compliance_, vertices_);
  ar.check(std::ranges::is_sorted(mean_ends_) && (mean_ends_.empty() ? 0 : mean_ends_.back()) == weights_.size());
  for (const Row& row : rows_) ar.check(row.mean < mean_ends_.size());
  std::size_t row = 0, number = 0;
  for (const auto& [first, end, numbers] : groups_) {
    ar.check(first >= row && first <= end && end <= rows_.size() && numbers >= number);
    ar.check(numbers - number == std::size_t{end - first} * (end - first));
    row = end, number = numbers;
  }
  ar.check(number == compliance_.size());
}

}  // namespace glisson
