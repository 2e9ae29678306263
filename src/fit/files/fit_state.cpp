#include "fit/files/fit_state.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>

#include "base/input_file.h"
#include "dynamics/state/checkpoint.h"
#include "glisson/version.h"
#include "report/json_text.h"
#include "report/output_file.h"

namespace glisson {
namespace {

using FlatJson = nlohmann::json;

constexpr int kFormat = 2;

/// A number for parts in their order: "a", "b" is not "ab".
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    constexpr std::byte kEnd{0xff};
    value_ = hash_bytes(std::span(&kEnd, 1), hash_bytes(std::as_bytes(std::span(bytes)), value_));
  }
  /// What is wrong with a file is told by those who need its contents.
  void add_file(const std::filesystem::path& file) { add(detail::read_input(file, detail::kTableInput).bytes); }
  std::string text() const { return fmt::format("{:016x}", value_); }

 private:
  std::uint64_t value_ = kHashStart;
};

/// Over everything but itself; numbers are written so that they read back as the same, so the text is, too.
std::string checksum(const FlatJson& json) {
  Fingerprint sum;
  sum.add(json_text(json.at("fingerprint")));
  sum.add(json_text(json.at("laws")));
  return sum.text();
}

FlatJson start_json(const fit::StartRecord& s) {
  // a failed descent has an infinite cost, which JSON has no word for
  const FlatJson cost = std::isfinite(s.optimum.cost) ? FlatJson(s.optimum.cost) : FlatJson(nullptr);
  return {{"from", s.from},
          {"to", s.optimum.scaled},
          {"cost", cost},
          {"converged", s.optimum.converged},
          {"iterations", s.optimum.iterations},
          {"message", s.optimum.message}};
}

/// A state that is not as it was written. what() is the fault alone.
struct Damage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

const FlatJson& member(const FlatJson& json, const char* key, bool (FlatJson::*is)() const, const char* kind) {
  const auto found = json.is_object() ? json.find(key) : json.end();
  if (found == json.end() || !(*found.*is)()) throw Damage(fmt::format("`{}` is missing or no {}", key, kind));
  return *found;
}

/// Parameters on their scale from 0 to 1.
std::vector<double> scaled_of(const FlatJson& json, const char* key) {
  std::vector<double> list;
  for (const FlatJson& x : member(json, key, &FlatJson::is_array, "list")) {
    const double z = x.is_number() ? x.get<double>() : -1.0;
    if (!(z >= 0.0 && z <= 1.0)) throw Damage(fmt::format("`{}` holds something else than numbers from 0 to 1", key));
    list.push_back(z);
  }
  if (list.empty()) throw Damage(fmt::format("`{}` is empty", key));
  return list;
}

double cost_of(const FlatJson& json) {
  if (json.contains("cost") && json["cost"].is_null()) return std::numeric_limits<double>::infinity();
  const double cost = member(json, "cost", &FlatJson::is_number, "number").get<double>();
  if (!(cost >= 0.0)) throw Damage("a `cost` is below 0");
  return cost;
}

fit::StartRecord start_of(const FlatJson& json) {
  fit::StartRecord s;
  s.from = scaled_of(json, "from");
  s.optimum.scaled = scaled_of(json, "to");
  if (s.from.size() != s.optimum.scaled.size()) throw Damage("`from` and `to` differ in length");
  s.optimum.cost = cost_of(json);
  s.optimum.converged = member(json, "converged", &FlatJson::is_boolean, "yes or no").get<bool>();
  const auto iterations = member(json, "iterations", &FlatJson::is_number_integer, "whole number").get<std::int64_t>();
  if (iterations < 0 || iterations > std::numeric_limits<int>::max()) throw Damage("`iterations` is out of range");
  s.optimum.iterations = static_cast<int>(iterations);
  s.optimum.message = member(json, "message", &FlatJson::is_string, "text").get<std::string>();
  return s;
}

fit::LawMemory law_of(const FlatJson& json) {
  fit::LawMemory law;
  for (const FlatJson& s : member(json, "starts", &FlatJson::is_array, "list")) {
    law.starts.push_back(start_of(s));
    if (law.starts.back().from.size() != law.starts.front().from.size()) throw Damage("`starts` differ in length");
  }
  if (!json.contains("forward")) return law;
  law.forward = member(json, "forward", &FlatJson::is_string, "text").get<std::string>();
  law.speedup = member(json, "speedup", &FlatJson::is_number, "number").get<double>();
  return law;
}

std::optional<fit::FitMemory> memory_of(const std::string& bytes, const std::string& fingerprint) {
  const FlatJson json = parse_json(bytes);
  if (member(json, "format", &FlatJson::is_number_integer, "whole number") != kFormat) return {};
  member(json, "laws", &FlatJson::is_object, "table");
  member(json, "fingerprint", &FlatJson::is_string, "text");
  if (member(json, "checksum", &FlatJson::is_string, "text") != checksum(json))
    throw Damage("its checksum is wrong, bytes have changed since it was written");
  if (json["fingerprint"] != fingerprint) return {};
  fit::FitMemory memory;
  for (const auto& [name, law] : json["laws"].items()) memory[name] = law_of(law);
  return memory;
}

}  // namespace

std::string fit_fingerprint(const fit::FitSpec& spec, const fit::FitRun& options) {
  Fingerprint print;
  print.add(GLISSON_VERSION);
  print.add(spec.source);
  if (!spec.scene.empty()) print.add_file(spec.scene);
  const std::filesystem::path base = options.data_folder.empty() ? spec.file.parent_path() : options.data_folder;
  for (const fit::DataSpec& data : spec.data) {
    for (const std::filesystem::path& file : data.files) print.add_file(file.is_relative() ? base / file : file);
  }
  for (const std::string& law : options.laws) print.add(law);
  if (options.discover > 0) print.add(std::to_string(options.discover));
  return print.text();
}

void write_fit_state(const std::filesystem::path& file, const std::string& fingerprint, const fit::FitMemory& memory) {
  FlatJson laws = FlatJson::object();
  for (const auto& [name, law] : memory) {
    FlatJson starts = FlatJson::array();
    for (const fit::StartRecord& s : law.starts) starts.push_back(start_json(s));
    laws[name] = {{"starts", starts}};
    if (law.forward.empty()) continue;
    laws[name]["forward"] = law.forward;
    laws[name]["speedup"] = law.speedup;
  }
  FlatJson json{{"format", kFormat}, {"fingerprint", fingerprint}, {"laws", laws}};
  json["checksum"] = checksum(json);
  write_whole(file, json_text(json) + "\n");
}

std::optional<fit::FitMemory> read_fit_state(const std::filesystem::path& file, const std::string& fingerprint) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(file, error))) return {};
  const detail::InputFile input = detail::read_input(file, detail::kStateInput);
  const auto refuse = [&](const std::string& why) {
    return std::invalid_argument(file.string() + ": " + why + "; delete it, or start again with --fresh");
  };
  if (!input.problem.empty()) throw std::invalid_argument(input.problem + ", or start again with --fresh");
  try {
    return memory_of(input.bytes, fingerprint);
  } catch (const Damage& damage) {
    throw refuse(damage.what());
  } catch (const JsonError& broken) {
    throw refuse(std::string("is no state of a fit: ") + broken.what());
  } catch (const nlohmann::json::exception&) {
    throw refuse("is no state of a fit: its JSON is broken");
  }
}

}  // namespace glisson
