#include "scene/advice/advice_text.h"

#include <array>
#include <cstdio>

namespace glisson::advice {

std::string fill(std::string_view pattern, std::initializer_list<std::string> values) {
  constexpr std::string_view kPlace = "{}";
  std::string text;
  for (const std::string& value : values) {
    const std::size_t place = pattern.find(kPlace);
    text.append(pattern.substr(0, place)).append(value);
    pattern.remove_prefix(place + kPlace.size());
  }
  return text.append(pattern);
}

std::string whole(double value) {
  std::array<char, 400> buffer{};  // the largest double has 309 digits
  std::snprintf(buffer.data(), buffer.size(), "%.0f", value);
  return buffer.data();
}

std::string listed(const std::vector<std::string>& texts, std::string_view between) {
  std::string all;
  for (const std::string& text : texts) all.append(all.empty() ? std::string_view{} : between).append(text);
  return all;
}

}  // namespace glisson::advice
