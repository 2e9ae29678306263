// summary_json.h — summary.json: a run in some twenty numbers.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "glisson/scene/advice.h"
#include "glisson/scene/scene.h"

namespace glisson {

/// A sentence on an end that is the numbers' doing, with the way out; empty for finished and interrupted.
std::string trouble_text(const RunSummary& summary);

/// A sentence on energy that came from nothing, with the time from which on and the ways out; empty where none did.
std::string energy_warning(const RunSummary& summary);

/// A sentence on instruments that never met the body, with the way out; empty where all did.
std::string meeting_warning(const RunSummary& summary);

/// The object of summary.json, keys in the order they are written.
/// @param scene  name of the scene; @param threads  variants at a time (results do not depend on it)
/// @param rejected  rejected_poses() of its instruments @param advice  advise_at_rest() of the variant
nlohmann::ordered_json summary_json(const RunSummary& summary, const Variant& variant, const std::string& scene,
                                    int threads, std::uint64_t rejected, std::span<const Advice> advice);

/// A piece of advice by its rule, kind, what it is about and text, which has no line breaks.
nlohmann::ordered_json advice_json(const Advice& advice);

/// How many poses of its instruments were rejected (Instrument::rejected).
std::uint64_t rejected_poses(std::span<const std::shared_ptr<Instrument>> instruments);

}  // namespace glisson
