// nearest.h — the word that was probably meant, and the words there are.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace glisson::scene {

/// Least number of insertions, deletions, replacements and swaps of neighbours that turn a into b, case ignored.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate closest to `word`, where one is close enough to be a slip; else empty. A key written without
/// its unit (`density` for `density_kg_m3`) or with another one counts as close.
std::string nearest(std::string_view word, std::span<const std::string> candidates);

/// `a, b, c`.
std::string listed(std::span<const std::string> words);

}  // namespace glisson::scene
