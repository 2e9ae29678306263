// reference_sections.h — sections of a scene as Markdown tables, from their descriptions.
#pragma once

#include <string>

#include "scene/parse/schema.h"

namespace glisson::scene {

/// `| key | type | unit | range | default | meaning |` and a row for each key; empty without keys.
std::string key_table(const SectionSpec& section);

/// The words of every key that takes some, as a list; empty where none does.
std::string word_list(const SectionSpec& section);

/// A heading, the section's purpose, its table, its words, its kinds and what excludes what.
std::string section_text(const SectionSpec& section, const std::string& heading);

}  // namespace glisson::scene
