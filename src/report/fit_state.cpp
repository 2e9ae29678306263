#include "report/fit_state.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "report/output_file.h"
#include "report/version.h"

namespace glisson {
namespace {

using Json = nlohmann::ordered_json;

/// FNV-1a.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) value_ = (value_ ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    value_ = (value_ ^ 0xffu) * 1099511628211ull;  // so that "a", "b" is not "ab"
  }
  void add_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    add(std::string{std::istreambuf_iterator<char>(stream), {}});
  }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = 14695981039346656037ull;
};

Json start_json(const fit::StartRecord& s) {
  // a failed descent has an infinite cost, which JSON has no word for
  const Json cost = std::isfinite(s.optimum.cost) ? Json(s.optimum.cost) : Json(nullptr);
  return {{"from", s.from},
          {"to", s.optimum.scaled},
          {"cost", cost},
          {"converged", s.optimum.converged},
          {"iterations", s.optimum.iterations},
          {"message", s.optimum.message}};
}

fit::StartRecord start_of(const Json& json) {
  fit::StartRecord s;
  s.from = json.at("from").get<std::vector<double>>();
  s.optimum.scaled = json.at("to").get<std::vector<double>>();
  s.optimum.cost = json.at("cost").is_null() ? std::numeric_limits<double>::infinity() : json.at("cost").get<double>();
  s.optimum.converged = json.at("converged").get<bool>();
  s.optimum.iterations = json.at("iterations").get<int>();
  s.optimum.message = json.at("message").get<std::string>();
  return s;
}

fit::LawMemory law_of(const Json& json) {
  fit::LawMemory law;
  for (const Json& s : json.at("starts")) law.starts.push_back(start_of(s));
  return law;
}

}  // namespace

std::string fit_fingerprint(const fit::FitSpec& spec, const fit::FitOptions& options) {
  Fingerprint print;
  print.add(version());
  print.add(spec.source);
  if (!spec.scene.empty()) print.add_file(spec.scene);
  const std::filesystem::path base = options.data_folder.empty() ? spec.file.parent_path() : options.data_folder;
  for (const fit::DataSpec& data : spec.data) {
    for (const std::filesystem::path& file : data.files) print.add_file(file.is_relative() ? base / file : file);
  }
  for (const std::string& law : options.laws) print.add(law);
  return print.text();
}

void write_fit_state(const std::filesystem::path& file, const std::string& fingerprint, const fit::FitMemory& memory) {
  Json laws = Json::object();
  for (const auto& [name, law] : memory) {
    Json starts = Json::array();
    for (const fit::StartRecord& s : law.starts) starts.push_back(start_json(s));
    laws[name] = {{"starts", starts}};
  }
  write_whole(file, Json{{"format", 1}, {"fingerprint", fingerprint}, {"laws", laws}}.dump() + "\n");
}

std::optional<fit::FitMemory> read_fit_state(const std::filesystem::path& file, const std::string& fingerprint) {
  std::ifstream stream(file);
  if (!stream) return {};
  try {
    const Json json = Json::parse(stream);
    if (json.at("format") != 1 || json.at("fingerprint") != fingerprint) return {};
    fit::FitMemory memory;
    for (const auto& [name, law] : json.at("laws").items()) memory[name] = law_of(law);
    return memory;
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

}  // namespace glisson
