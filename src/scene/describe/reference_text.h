// reference_text.h — the prose of the scene reference.
#pragma once

#include <string_view>

namespace glisson::scene {

extern const std::string_view kReferenceIntroduction;
extern const std::string_view kReferenceVariants;
extern const std::string_view kReferenceOverrides;
extern const std::string_view kReferenceRun;
extern const std::string_view kReferenceExample;  ///< a complete scene

}  // namespace glisson::scene
