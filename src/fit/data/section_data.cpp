#include "fit/data/section_data.h"

#include <algorithm>
#include <functional>

#include "fit/data/test_columns.h"
#include "fit/data/units.h"
#include "scene/parse/section.h"

namespace glisson::fit {
namespace {

using scene::KindSpec;
using scene::Milli;
using scene::Node;
using scene::OptionalMilli;
using scene::Place;
using scene::Section;
using scene::SectionSpec;

/// mm² of the file, m² of the struct.
struct OptionalSquareMilli {
  static constexpr scene::ValueType kType = scene::ValueType::number;
  static constexpr scene::Shape kShape = scene::Shape::one;
  static std::optional<double> read(const Node& n) { return scene::number_of(n) * 1e-6; }
  static std::string show(const std::optional<double>& x) { return x ? scene::show(*x * 1e6) : ""; }
};

/// A kind that says which word was chosen and fills the struct itself.
template <class Spec, class Kind>
KindSpec kind_of(SectionSpec section, Kind kind) {
  return {std::move(section), [kind](void* target) -> void* {
            static_cast<Spec*>(target)->kind = kind;
            return target;
          }};
}

/// Complains of a unit that is none of the quantity's.
void require_unit(const ColumnSpec& column, const Node& table, const std::string& key, Quantity quantity,
                  const Place& place) {
  if (column.unit.empty() || may_be(quantity, column.unit)) return;
  place.complain(*table.find(key)->find("unit"), key + ".unit",
                 "unknown unit \"" + column.unit + "\"; allowed: " + unit_names(quantity));
}

void require_order(const Node& table, const std::optional<double>& low, const std::optional<double>& high,
                   const std::string& least, const std::string& most, const Place& place) {
  if (low && high && !(*low < *high))
    place.complain(*table.find(most), most, "must be greater than `" + least + "`; nothing would be left");
}

/// The words of an enumeration as choices.
template <class E>
std::vector<scene::Choice<E>> choices_of() {
  std::vector<scene::Choice<E>> list;
  for (const Word<E>& w : kWords<E>) list.push_back({std::string(w.word), w.value, std::string(w.help), is_alias(w)});
  return list;
}
template <class E>
std::vector<scene::Choice<std::optional<E>>> optional_choices_of() {
  std::vector<scene::Choice<std::optional<E>>> list;
  for (const Word<E>& w : kWords<E>) list.push_back({std::string(w.word), w.value, std::string(w.help), is_alias(w)});
  return list;
}

SectionSpec detect_kind() {
  Section<ContactSpec> s("detect",
                         "Where the force starts to rise: a line and a parabola joined where they fit best. The line "
                         "rests, or has a slope where the rows show one; then all files of the test are placed on one. "
                         "If a file begins in contact, the parabola is extrapolated to zero force; all files of the "
                         "test are then extrapolated from the force at which that one begins. A contact that the rows "
                         "do not determine is refused.");
  s.key("threshold_sd", &ContactSpec::threshold,
        "rise of the force above its mean before contact that counts as contact, in standard deviations of its noise")
      .in("-")
      .within(between(1, 100));
  s.key("zero_force", &ContactSpec::zero_force,
        "subtracts the baseline before contact, its slope too where it has one");
  return s.spec();
}

SectionSpec automatic_kind() {
  Section<ContactSpec> s("auto",
                         "`none` or `detect`, whichever leaves the files of the test nearer to each other, fitted and "
                         "held-out tables together: each is predicted by the mean of the others of about its speed. A "
                         "test of one file is detected.");
  return s.spec();
}

SectionSpec given_kind() {
  Section<ContactSpec> s("given", "At a given displacement of the files.");
  s.key<Milli>("at_mm", &ContactSpec::at, "displacement in the file at first contact").in("mm").must();
  s.key("zero_force", &ContactSpec::zero_force,
        "subtracts the baseline before contact, the line through its rows where it has a slope");
  return s.spec();
}

SectionSpec indenter_kind(const Word<IndenterShape>& word) {
  const IndenterShape shape = word.value;
  Section<Indenter> s(std::string(word.word), std::string(word.help));
  std::vector<std::string_view> without;
  each_field<Indenter>([&](const FieldText& f) {
    if (!Indenter::has(shape, f.name)) without.push_back(f.name);
  });
  s.fields({}, without);
  return s.spec();
}

KindSpec indenter_of(const Word<IndenterShape>& word) {
  return {indenter_kind(word), [shape = word.value](void* target) -> void* {
            static_cast<Indenter*>(target)->shape = shape;
            return target;
          }};
}

SectionSpec median_kind() {
  Section<FilterSpec> s("median", "A running median against spikes, applied before contact detection.");
  s.key("half_width", &FilterSpec::half_width, "rows on each side").within(between(1, 500));
  return s.spec();
}

SectionSpec savitzky_golay_kind() {
  Section<FilterSpec> s(
      "savitzky_golay",
      "A polynomial through each row and its neighbours, applied after contact detection and cropping.");
  s.key("half_width", &FilterSpec::half_width, "rows on each side").within(between(1, 500));
  s.key("degree", &FilterSpec::degree, "degree of the polynomial, below twice the half-width").within(between(0, 8));
  s.finish([](FilterSpec& x, const Node& table, const Place& place) {
    if (x.degree < 2 * x.half_width) return;
    const char* key = table.find("degree") ? "degree" : "half_width";
    place.complain(*table.find(key), key,
                   "degree " + std::to_string(x.degree) +
                       " must be below 2 half_width = " + std::to_string(2 * x.half_width) + "; widen half_width");
  });
  return s.spec();
}

void add_mark_keys(Section<TextSpec>& s) {
  s.choice<char>("separator", &TextSpec::separator,
                 {{"auto", 0, "detected"},
                  {",", ',', ""},
                  {";", ';', ""},
                  {"tab", '\t', ""},
                  {"blanks", ' ', "any number of blanks"}},
                 "separator of the columns");
  s.choice<char>("decimal", &TextSpec::decimal, {{"auto", 0, "detected"}, {".", '.', ""}, {",", ',', ""}},
                 "decimal mark; the other of the two, a blank or an apostrophe may part thousands");
}

/// One column of each list at most.
void require_one(const Node& columns, const Place& here, std::initializer_list<std::pair<const char*, bool>> list) {
  const char* first = nullptr;
  for (const auto& [key, given] : list) {
    if (given && first)
      here.complain(*columns.find(key), key, "contradicts `" + std::string(first) + "`; give one of the two");
    if (given && !first) first = key;
  }
}

void require_columns(const DataSpec& x, const Node& table, const Place& place) {
  const ColumnsSpec& c = x.columns;
  const Node* columns = table.find("columns");
  if (!columns) return;
  const Place here = place.inside("columns", columns->where);
  require_one(*columns, here,
              {{"displacement", c.displacement.given},
               {"strain", c.strain.given},
               {"stretch", c.stretch.given},
               {"true_strain", c.true_strain.given},
               {"green_strain", c.green_strain.given},
               {"shear", c.shear.given},
               {"angle", c.angle.given},
               {"frequency", c.frequency.given}});
  require_one(*columns, here,
              {{"force", c.force.given},
               {"stress", c.stress.given},
               {"cauchy_stress", c.cauchy_stress.given},
               {"second_piola_stress", c.second_piola_stress.given},
               {"torque", c.torque.given || c.axial_force.given},
               {"storage_modulus", c.storage_modulus.given || c.loss_modulus.given},
               {"value", c.value.given}});
}

/// What of a scene of heat was measured, in files or as values of FIT.toml.
void require_heat(const DataSpec& x, const Node& table, const Place& place) {
  const auto complain = [&](const char* key, const std::string& what) { place.complain(*table.find(key), key, what); };
  if (!x.is_heat()) {
    for (const char* key : {"of", "over", "variant", "times_s", "values", "deviation"}) {
      if (table.find(key)) complain(key, "belongs to test = \"heat\"");
    }
    return;
  }
  for (const char* key : {"contact", "cycle", "area_mm2", "height_mm", "speed_mm_s"}) {
    if (table.find(key)) complain(key, "does not belong to test = \"heat\"; remove it");
  }
  if (x.heat.column.empty())
    place.complain("test = \"heat\" needs `of`, the column of temperature.csv or heat.csv that was measured");
  if (x.times.size() != x.values.size())
    complain(x.values.empty() ? "times_s" : "values", "there are " + std::to_string(x.times.size()) +
                                                          " `times_s` and " + std::to_string(x.values.size()) +
                                                          " `values`; give one value for each time");
  if (std::adjacent_find(x.times.begin(), x.times.end(), std::greater_equal<>()) != x.times.end())
    complain("times_s", "must ascend");
  if (!x.values.empty() && !x.deviation)
    complain("values", "needs `deviation`, the standard deviation of one value: values alone do not show it");
  if (!x.files.empty() && !x.heat.column.empty() && !unit_of(x.heat).quantity)
    complain("of",
             "files are read of columns that end with _C, _m, _m2 or _m3, and of one column over another; give "
             "`times_s` and `values` in place of files");
}

void finish_data(DataSpec& x, const Node& table, const Place& place) {
  x.origin = place.text();
  require_heat(x, table, place);
  if (x.deforming && names_its_deformation(x.test))
    place.complain(
        *table.find("mode"), "mode",
        "belongs to relaxation, creep and cyclic; a test of " + std::string(word_of(x.test)) + " says how it deforms");
  if (x.indents() && !x.indenter)
    place.complain(*table.find(x.test == LabTest::indentation ? "test" : "mode"),
                   x.test == LabTest::indentation ? "test" : "mode",
                   "indentation needs an indenter; give indenter = { kind = \"sphere\", radius_mm = … }, "
                   "{ kind = \"flat\", radius_mm = … } or { kind = \"cone\", half_angle_deg = … }");
  if (!x.indents() && x.indenter)
    place.complain(*table.find("indenter"), "indenter",
                   names_its_deformation(x.test)
                       ? "belongs to test = \"indentation\""
                       : "needs mode = \"indentation\" in a test of " + std::string(word_of(x.test)));
  if (x.test == LabTest::creep && x.deforming == Deforming::torsion)
    place.complain(*table.find("mode"), "mode",
                   "a torsion is fitted as it is driven by its angle; give test = \"torsion\" with columns of angle, "
                   "torque and time");
  if (x.prestretch != 1.0 && x.test != LabTest::oscillation)
    place.complain(*table.find("prestretch"), "prestretch", "belongs to test = \"oscillation\"");
  if (x.text.names_line > 0 && x.text.interval > 0)
    place.complain(*table.find("interval"), "interval",
                   "contradicts `text.names_line`, which says the table already; give one of the two");
  if (x.files.empty() && x.values.empty() && table.find("files"))
    place.complain(*table.find("files"), "files", "is empty; name at least one file");
  else if (x.files.empty() && x.values.empty())
    place.complain(x.is_heat() ? "needs `files`, or `times_s` and `values`" : "`files` is missing; name at least one");
  require_columns(x, table, place);
}

/// What a test of heat measures, and values in the place of files.
void add_keys_of_heat(Section<DataSpec>& s) {
  s.key(
       "of", [](DataSpec & d) -> auto& { return d.heat.column; },
       "of a test of heat: the column of the scene's temperature.csv or heat.csv that was measured, e.g. "
       "\"aside_2_C\", \"cold_width_m\"")
      .otherwise("none");
  s.key(
       "over", [](DataSpec & d) -> auto& { return d.heat.over; },
       "of a test of heat: a column that it is divided by, e.g. \"ice_area_m2\"")
      .otherwise("none");
  s.key(
       "variant", [](DataSpec & d) -> auto& { return d.heat.variant; }, "of a test of heat: variant of the scene")
      .otherwise("that of the fit");
  s.key("times_s", &DataSpec::times, "of a test of heat, in place of files: times of the scene, ascending")
      .in("s")
      .within(at_least(0))
      .otherwise("`files`");
  s.key("values", &DataSpec::values,
        "what was measured then, in the unit of the column: °C, m, m², m³, or a share of 1")
      .otherwise("`files`");
  s.key("deviation", &DataSpec::deviation,
        "of a test of heat: standard deviation of one value, in the unit of the column; where all fitted curves have "
        "one, and are weighed by it, intervals follow from it")
      .within(above(0))
      .otherwise("that of the rows about a smooth curve");
}

}  // namespace

const SectionSpec& column_section() {
  static const SectionSpec section = [] {
    Section<ColumnSpec> s("data.columns.NAME", "A column of the files, by name or by number.");
    s.key("name", &ColumnSpec::name, "name in the file; case, surrounding blanks and the unit may be omitted");
    s.key("number", &ColumnSpec::number, "column number, from 1").within(between(1, 100000));
    s.key("unit", &ColumnSpec::unit, "unit of its numbers").otherwise("unit given in the file");
    s.choice<Sign>("sign", &ColumnSpec::sign,
                   {{"auto", Sign::found,
                     "the direction of the largest deviation from the start of the test; the report names the columns "
                     "that were turned"},
                    {"positive", Sign::positive, "compression and insertion are positive"},
                    {"negative", Sign::negative, "they are negative"}},
                   "sign of compression and insertion");
    s.spec().exclusions = {{{{"name"}, {"number"}}, true}};
    s.finish([](ColumnSpec& x, const Node&, const Place& place) {
      x.given = true;
      x.origin = place.text();
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& columns_section() {
  static const SectionSpec section = [] {
    Section<ColumnsSpec> s(
        "data.columns",
        "Meaning of the columns: one that is driven, one that answers, and the time. A column that "
        "is not given is detected if exactly one name begins with a customary word, in English, German, "
        "French or Spanish: time; displacement, compression, extension, depth, …; force, load, …; "
        "stretch; strain; stress; shear; angle; torque; frequency; storage and loss modulus. "
        "Adjectives may precede it (\"Compressive load\"). A file may hold several tests side by side: rows that "
        "are empty in the columns of one are no rows of it.");
    s.table("time", column_section(), &ColumnsSpec::time, "time, in s, ms or min");
    s.table("displacement", column_section(), &ColumnsSpec::displacement,
            "displacement of the tool, in m, cm, mm, µm, nm or in");
    s.table("strain", column_section(), &ColumnsSpec::strain,
            "engineering strain, in - or %, instead of displacement; needs the height");
    s.table("stretch", column_section(), &ColumnsSpec::stretch,
            "length over length at rest, below 1 in compression, instead of displacement");
    s.table("true_strain", column_section(), &ColumnsSpec::true_strain, "logarithmic strain, ln λ, in - or %");
    s.table("green_strain", column_section(), &ColumnsSpec::green_strain, "Green's strain, (λ² − 1)/2, in - or %");
    s.table("shear", column_section(), &ColumnsSpec::shear,
            "amount of shear, displacement over distance of the faces, in - or %");
    s.table("angle", column_section(), &ColumnsSpec::angle,
            "angle of twist of one face against the other, in rad or deg");
    s.table("frequency", column_section(), &ColumnsSpec::frequency,
            "of an oscillation, in Hz, kHz or rad/s; 1/s is rad/s where the column's name says angular, and is refused "
            "elsewhere");
    s.table("force", column_section(), &ColumnsSpec::force, "force, in N, mN, µN, nN, kN, gf, kgf or lbf");
    s.table("stress", column_section(), &ColumnsSpec::stress,
            "nominal stress, force over area at rest, in Pa, kPa, MPa, N/mm², kgf/cm² or psi, instead of force; needs "
            "the area");
    s.table("cauchy_stress", column_section(), &ColumnsSpec::cauchy_stress,
            "true stress, force over the present area, in Pa, kPa or MPa");
    s.table("second_piola_stress", column_section(), &ColumnsSpec::second_piola_stress,
            "second Piola–Kirchhoff stress, nominal stress over stretch, in Pa, kPa or MPa");
    s.table("torque", column_section(), &ColumnsSpec::torque, "torque about the axis, in N m, mN m, µN m or N mm");
    s.table("axial_force", column_section(), &ColumnsSpec::axial_force,
            "force along the axis of a torsion, positive where the specimen pushes the plates apart, as rheometers "
            "show it; "
            "with the torque it is a curve of its own");
    s.table("storage_modulus", column_section(), &ColumnsSpec::storage_modulus,
            "G′ of an oscillation, in Pa, kPa or MPa");
    s.table("loss_modulus", column_section(), &ColumnsSpec::loss_modulus,
            "G″ of an oscillation; with G′ it is a curve of its own");
    s.table(
        "value", column_section(), &ColumnsSpec::value,
        "of a test of heat: temperature in °C, a length in mm, cm or m, an area in mm², cm² or m², a volume in mm³, "
        "cm³, mL or m³, a share in - or %; by default the column that has the name of `of`, else the only one of "
        "temperatures");
    s.finish([](ColumnsSpec& x, const Node& table, const Place& place) {
      require_unit(x.time, table, "time", Quantity::time, place);
      require_unit(x.displacement, table, "displacement", Quantity::length, place);
      require_unit(x.strain, table, "strain", Quantity::strain, place);
      require_unit(x.stretch, table, "stretch", Quantity::stretch, place);
      require_unit(x.true_strain, table, "true_strain", Quantity::strain, place);
      require_unit(x.green_strain, table, "green_strain", Quantity::strain, place);
      require_unit(x.shear, table, "shear", Quantity::strain, place);
      require_unit(x.angle, table, "angle", Quantity::angle, place);
      require_unit(x.frequency, table, "frequency", Quantity::frequency, place);
      require_unit(x.force, table, "force", Quantity::force, place);
      require_unit(x.stress, table, "stress", Quantity::stress, place);
      require_unit(x.cauchy_stress, table, "cauchy_stress", Quantity::stress, place);
      require_unit(x.second_piola_stress, table, "second_piola_stress", Quantity::stress, place);
      require_unit(x.torque, table, "torque", Quantity::torque, place);
      require_unit(x.axial_force, table, "axial_force", Quantity::force, place);
      require_unit(x.storage_modulus, table, "storage_modulus", Quantity::stress, place);
      require_unit(x.loss_modulus, table, "loss_modulus", Quantity::stress, place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& text_section() {
  static const SectionSpec section = [] {
    Section<TextSpec> s("data.text", "Format of the files, where it should not be detected.");
    add_mark_keys(s);
    s.key("names_line", &TextSpec::names_line, "line of the columns' names, from 1; 0: detected")
        .within(between(0, 1e6));
    return s.spec();
  }();
  return section;
}

const SectionSpec& contact_section() {
  static const SectionSpec section = [] {
    Section<ContactSpec> s("data.contact", "First contact of the tool: displacement and time count from there.");
    s.spec().kinds = {
        kind_of<ContactSpec>(Section<ContactSpec>("none", "Displacement as recorded, nothing removed.").spec(),
                             ContactKind::none),
        kind_of<ContactSpec>(detect_kind(), ContactKind::detect),
        kind_of<ContactSpec>(given_kind(), ContactKind::given),
        kind_of<ContactSpec>(automatic_kind(), ContactKind::automatic)};
    return s.spec();
  }();
  return section;
}

const SectionSpec& indenter_section() {
  static const SectionSpec section = [] {
    Section<Indenter> s("data.indenter", "The rigid indenter of an indentation.");
    for (const Word<IndenterShape>& word : kWords<IndenterShape>) s.spec().kinds.push_back(indenter_of(word));
    return s.spec();
  }();
  return section;
}

const SectionSpec& crop_section() {
  static const SectionSpec section = [] {
    using C = CropSpec;
    Section<C> s("data.crop", "Range to keep, counted from contact.");
    s.key("min_time_s", &C::min_time, "rows before it are dropped").in("s");
    s.key("max_time_s", &C::max_time, "rows after it are dropped").in("s");
    s.key<OptionalMilli>("min_displacement_mm", &C::min_displacement, "rows below it are dropped").in("mm");
    s.key<OptionalMilli>("max_displacement_mm", &C::max_displacement, "rows above it are dropped").in("mm");
    s.key("min_strain", &C::min_strain, "rows below it are dropped; displacement over height").in("-");
    s.key("max_strain", &C::max_strain, "rows above it are dropped").in("-");
    s.key("min_force_N", &C::min_force, "rows below it are dropped").in("N");
    s.key("max_force_N", &C::max_force, "rows above it are dropped").in("N");
    s.choice<CropUntil>("until", &C::until,
                        {{"end", CropUntil::end, "the last row"},
                         {"peak", CropUntil::peak, "the largest force"},
                         {"drop", CropUntil::drop, "the largest force before it first drops, as at a puncture"}},
                        "end of the curve");
    s.key("drop", &C::drop,
          "fall that ends the curve with until = \"drop\", as a fraction of the largest force before it")
        .in("-")
        .within(strictly_between(0, 1));
    s.finish([](C& x, const Node& table, const Place& place) {
      require_order(table, x.min_time, x.max_time, "min_time_s", "max_time_s", place);
      require_order(table, x.min_displacement, x.max_displacement, "min_displacement_mm", "max_displacement_mm", place);
      require_order(table, x.min_strain, x.max_strain, "min_strain", "max_strain", place);
      require_order(table, x.min_force, x.max_force, "min_force_N", "max_force_N", place);
    });
    return s.spec();
  }();
  return section;
}

const SectionSpec& cycle_section() {
  static const SectionSpec section = [] {
    using C = CycleSpec;
    Section<C> s("data.cycle", "Part of a test with loading and unloading.");
    s.choice<CyclePart>("part", &C::part,
                        {{"both", CyclePart::both, "loading and unloading"},
                         {"loading", CyclePart::loading, "loading only"},
                         {"unloading", CyclePart::unloading, "unloading only"}},
                        "part of the cycle");
    s.key("number", &C::number, "which cycle, from 1; those before are in the past of a tissue that relaxes")
        .within(between(1, 100000))
        .otherwise("all with \"both\", else 1");
    s.key("least", &C::least, "smallest reversal that counts as a turn, as a fraction of the whole travel")
        .in("-")
        .within(strictly_between(0, 1));
    return s.spec();
  }();
  return section;
}

const SectionSpec& filter_section() {
  static const SectionSpec section = [] {
    Section<FilterSpec> s("data.filter",
                          "Smooths the force. The fit averages noise itself; use a filter against spikes.");
    s.spec().kinds = {
        kind_of<FilterSpec>(Section<FilterSpec>("none", "The force as recorded.").spec(), FilterKind::none),
        kind_of<FilterSpec>(median_kind(), FilterKind::median),
        kind_of<FilterSpec>(savitzky_golay_kind(), FilterKind::savitzky_golay)};
    return s.spec();
  }();
  return section;
}

const SectionSpec& resample_section() {
  static const SectionSpec section = [] {
    using R = ResampleSpec;
    Section<R> s("data.resample", "Fewer points, evenly spread.");
    s.choice<ResampleOver>("over", &R::over,
                           {{"time", ResampleOver::time, "evenly spaced in time"},
                            {"displacement", ResampleOver::displacement, "evenly spaced in displacement, loading only"},
                            {"none", ResampleOver::none, "every row"}},
                           "abscissa of the points");
    s.choice<ResampleHow>("how", &R::how,
                          {{"average", ResampleHow::average, "the mean of the rows of a bin, which reduces noise"},
                           {"pick", ResampleHow::pick, "the row next to the middle of a bin"}},
                          "value of a point");
    s.key("points", &R::points, "largest number of points; a bin without rows gives none").within(between(5, 100000));
    return s.spec();
  }();
  return section;
}

const SectionSpec& data_section() {
  static const SectionSpec section = [] {
    using D = DataSpec;
    Section<D> s("data", "Measured curves: repetitions of one test, one file each.");
    s.key("name", &D::group, "name of the test, e.g. \"2 mm/s\"; the files are its repetitions");
    s.key("batch", &D::batch,
          "name of the batch that these specimens are of, e.g. \"A\"; with three or more batches fitted, the result "
          "says where the optimum of a further one is to be expected")
        .otherwise("not said");
    s.key("files", &D::files, "files, relative to FIT.toml, or to --data DIR")
        .otherwise("`times_s` and `values` of a test of heat; else required");
    s.choice<LabTest>("test", &D::test, choices_of<LabTest>(), "what was done to the specimen");
    s.choice<std::optional<Deforming>>("mode", &D::deforming, optional_choices_of<Deforming>(),
                                       "how the specimen deforms in a test of relaxation, creep or cycles")
        .otherwise("tension or compression as a column of stretches says, else compression");
    s.key("prestretch", &D::prestretch, "length over length at rest about which an oscillation is small")
        .in("-")
        .within(above(0));
    s.table(
         "indenter", indenter_section(), [](D & d) -> auto& { return d.indenter.emplace(); },
         "the indenter of an indentation")
        .otherwise("none");
    add_keys_of_heat(s);
    s.choice<bool>("use", &D::held_out, {{"fit", false, "fitted"}, {"test", true, "held out, to test the fit"}},
                   "purpose");
    s.key("weight", &D::weight, "factor on the residuals").in("-").within(at_least(0));
    s.table("columns", columns_section(), &D::columns, "meaning of the columns");
    s.table("text", text_section(), &D::text, "separator, decimal mark, line of names");
    s.key<OptionalMilli>("speed_mm_s", &D::speed, "speed of the tool; gives the time where no column contains it")
        .in("mm/s")
        .within(above(0));
    s.key<OptionalSquareMilli>(
         "area_mm2", [](D & d) -> auto& { return d.size.area; }, "area of these specimens, across the load")
        .in("mm²")
        .within(above(0))
        .otherwise("that of the specimen");
    s.key<OptionalMilli>(
         "height_mm", [](D & d) -> auto& { return d.size.height; }, "height of these specimens, along the load")
        .in("mm")
        .within(above(0))
        .otherwise("that of the specimen");
    s.key(
         "interval", [](D & d) -> auto& { return d.text.interval; },
         "which of several tables of the files, one below the other as the intervals of a rheometer, from 1")
        .within(between(1, 100000))
        .otherwise("the files hold one table");
    s.key("skip_bad_rows", &D::skip_bad_rows,
          "skips rows that lack a required number, a twentieth of the test at most, and only where they lie scattered; "
          "the result says how many");
    s.key("unlikely", &D::unlikely, "accepts numbers that look like a wrong unit");
    s.table("contact", contact_section(), &D::contact, "first contact of the tool");
    s.table("cycle", cycle_section(), &D::cycle, "part of a test with loading and unloading");
    s.table("crop", crop_section(), &D::crop, "range to keep");
    s.table("filter", filter_section(), &D::filter, "smoothing");
    s.table("resample", resample_section(), &D::resample, "number of points");
    s.finish(finish_data);
    return s.spec();
  }();
  return section;
}

}  // namespace glisson::fit
