// embedded.cpp — see embedded.h; the bytes come from embedded.S.in.
#include "cli/embedded.h"

#define GLISSON_EMBEDDED(name) \
  extern "C" const char name[], name##_end[]  // NOLINT(bugprone-macro-parentheses): a declarator
GLISSON_EMBEDDED(glisson_report_template);
GLISSON_EMBEDDED(glisson_live_page);
GLISSON_EMBEDDED(glisson_figure2);
GLISSON_EMBEDDED(glisson_figure3a);
GLISSON_EMBEDDED(glisson_figure3b);
GLISSON_EMBEDDED(glisson_speed);
#undef GLISSON_EMBEDDED

namespace glisson::app {
namespace {

std::string_view between(const char* begin, const char* end) { return {begin, static_cast<std::size_t>(end - begin)}; }

}  // namespace

std::string_view report_template() { return between(glisson_report_template, glisson_report_template_end); }
std::string_view live_page() { return between(glisson_live_page, glisson_live_page_end); }
std::string_view figure2_scene() { return between(glisson_figure2, glisson_figure2_end); }
std::string_view figure3a_scene() { return between(glisson_figure3a, glisson_figure3a_end); }
std::string_view figure3b_scene() { return between(glisson_figure3b, glisson_figure3b_end); }
std::string_view speed_scene() { return between(glisson_speed, glisson_speed_end); }

}  // namespace glisson::app
