// json_field.h — a value of JSON from outside together with where it stands, so that what is wrong is said by file and key.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "report/json_text.h"

namespace glisson {

/// Looks at a value that outlives it. Each accessor throws JsonError: `instruments[0].points[2]: expected a number, found null`.
class JsonField {
 public:
  explicit JsonField(const nlohmann::json& value, std::string place = {}) : value_(value), place_(std::move(place)) {}

  JsonField at(const std::string& key) const;  ///< of an object
  JsonField at(std::size_t number) const;      ///< of a list
  std::optional<JsonField> find(const std::string& key) const;
  std::size_t size() const;  ///< of a list
  std::string text() const;
  double number() const;
  bool truth() const;
  const nlohmann::json& raw() const { return value_; }

 private:
  [[noreturn]] void refuse(const std::string& expected) const;

  const nlohmann::json& value_;
  std::string place_;
};

}  // namespace glisson
