#include "fit/data/column_words.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "base/text.h"

namespace glisson::fit {
namespace {

using Words = std::vector<std::string_view>;

struct MeaningWords {
  ColumnMeaning meaning;
  Words words;         ///< with which a name begins
  Words symbols = {};  ///< that are a whole name
};

// In small letters. English, then German, then French and Spanish.
const std::vector<MeaningWords>& all_words() {
  using R = ColumnMeaning;
  static const std::vector<MeaningWords> list{
      {R::time,
       {"time", "test time", "step time", "elapsed time", "run time", "timestamp", "zeit", "prüfzeit", "messzeit",
        "versuchszeit", "temps", "durée", "duree", "tiempo"},
       {"t"}},
      {R::displacement,
       {"displacement", "compression",   "extension",   "elongation",  "position",        "depth",        "indentation",
        "penetration",  "stroke",        "crosshead",   "travel",      "standard travel", "distance",     "disp",
        "weg",          "traversenweg",  "standardweg", "scherweg",    "kolbenweg",       "maschinenweg", "verformung",
        "verschiebung", "eindringtiefe", "eindringweg", "tiefe",       "verlängerung",    "hub",          "traverse",
        "deformation",  "déformation",   "déplacement", "deplacement", "enfoncement",     "profondeur",   "course",
        "allongement",  "desplazamiento"},
       {"d", "x", "z", "h", "pd"}},
      {R::strain,
       {"strain", "engineering strain", "nominal strain", "dehnung", "stauchung", "technische dehnung", "déformation",
        "deformation", "deformación", "deformacion"},
       {"ε"}},
      {R::stretch, {"stretch", "stretch ratio", "lambda", "streckung", "streckgrad"}, {"λ"}},
      {R::true_strain,
       {"true strain", "true_strain", "log strain", "logarithmic strain", "hencky strain", "wahre dehnung",
        "logarithmische dehnung", "déformation vraie", "déformation logarithmique"},
       {}},
      {R::green_strain, {"green", "e_green"}, {}},
      {R::shear,
       {"shear strain", "shear_strain", "shear amount", "shear_amount", "gamma", "scherung", "scherdehnung",
        "schiebung", "scherdeformation", "déformation de cisaillement"},
       {"γ"}},
      {R::angle,
       {"angle", "twist", "rotation", "deflection angle", "angular displacement", "winkel", "verdrehwinkel",
        "drehwinkel", "auslenkwinkel", "torsion angle"},
       {"φ", "ϕ", "θ"}},
      {R::frequency,
       {"frequency", "freq", "angular frequency", "frequenz", "kreisfrequenz", "winkelfrequenz", "fréquence",
        "frequence", "pulsation", "frecuencia", "omega"},
       {"f", "ω"}},
      {R::force,
       {"force", "load", "standard force", "kraft", "standardkraft", "prüfkraft", "druckkraft", "zugkraft",
        "kompressionskraft", "normalkraft", "scherkraft", "last", "charge", "effort", "fuerza", "carga"},
       {"f", "fz", "fn", "p"}},
      {R::stress,
       {"stress", "nominal stress", "nominal_stress", "engineering stress", "engineering_stress", "shear stress",
        "spannung", "druckspannung", "zugspannung", "technische spannung", "schubspannung", "scherspannung",
        "contrainte", "esfuerzo", "tensión"},
       {"σ", "τ"}},
      {R::cauchy_stress,
       {"cauchy", "true stress", "true_stress", "wahre spannung", "contrainte vraie", "contrainte de cauchy"},
       {}},
      {R::second_piola_stress, {"second piola", "pk2"}, {}},
      {R::torque, {"torque", "moment", "drehmoment", "couple"}, {"m"}},
      {R::axial_force,
       {"axial force", "axial_force", "normal force", "normal_force", "axialkraft", "normalkraft", "force normale",
        "force axiale"},
       {"fn"}},
      {R::storage_modulus,
       {"storage", "storage modulus", "speichermodul", "module de conservation", "module élastique",
        "module de stockage"},
       {"g'", "g′", "e'"}},
      {R::temperature,
       {"temperature", "temp", "thermocouple", "temperatur", "thermoelement", "température", "temperatura"},
       {}},
      {R::loss_modulus,
       {"loss modulus", "loss mod", "verlustmodul", "module de perte", "module visqueux"},
       {"g''", "g″", "g\"", "e''"}}};
  return list;
}

// Before a word they leave its meaning as it is.
constexpr std::array<std::string_view, 19> kAdjectives{"eng.",     "compressive", "compression", "tensile", "tension",
                                                       "applied",  "measured",    "axial",       "normal",  "corrected",
                                                       "indenter", "probe",       "crosshead",   "tool",    "actuator",
                                                       "total",    "platen",      "sample",      "specimen"};

const MeaningWords& words_of(ColumnMeaning meaning) {
  const auto& list = all_words();
  return *std::find_if(list.begin(), list.end(), [&](const MeaningWords& w) { return w.meaning == meaning; });
}

/// A to Z and the capitals of Latin-1 in small letters.
std::string in_small_letters(std::string_view text) {
  std::string small = detail::lower_case(text);
  for (std::size_t i = 1; i < small.size(); ++i) {
    const auto lead = static_cast<unsigned char>(small[i - 1]), next = static_cast<unsigned char>(small[i]);
    if (lead == 0xC3 && next >= 0x80 && next <= 0x9E && next != 0x97) small[i] = static_cast<char>(next + 0x20);
  }
  return small;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80; }

/// Whether a text begins with a word, and no letter follows.
bool begins_with(std::string_view text, std::string_view word) {
  return text.starts_with(word) && (text.size() == word.size() || !is_letter(text[word.size()]));
}

bool begins_with_any(std::string_view text, const Words& words) {
  return std::any_of(words.begin(), words.end(), [&](std::string_view w) { return begins_with(text, w); });
}

/// The name without the adjective it begins with; empty where it begins with none.
std::string_view without_adjective(std::string_view name) {
  for (const std::string_view adjective : kAdjectives) {
    if (begins_with(name, adjective) && name.size() > adjective.size() + 1) return name.substr(adjective.size() + 1);
  }
  return {};
}

}  // namespace

bool has_meaning(std::string_view name, ColumnMeaning meaning) {
  const std::string small = in_small_letters(name);
  const MeaningWords& words = words_of(meaning);
  if (std::find(words.symbols.begin(), words.symbols.end(), small) != words.symbols.end()) return true;
  return begins_with_any(small, words.words) || begins_with_any(without_adjective(small), words.words);
}

bool says_angular(std::string_view name) {
  static const Words words{"angular frequency", "angular freq", "kreisfrequenz",
                           "winkelfrequenz",    "pulsation",    "omega"};
  const std::string small = in_small_letters(name);
  return small == "ω" || begins_with_any(small, words);
}

}  // namespace glisson::fit
