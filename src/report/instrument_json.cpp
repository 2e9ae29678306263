// instrument_json.cpp — see instrument_json.h.
#include "report/instrument_json.h"

namespace glisson {
namespace {

using nlohmann::json;

json numbers(const Vec3d& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

json list_of(const InstrumentList& instruments, json (*make)(const Instrument&)) {
  json list = json::array();
  for (const auto& x : instruments) {
    if (x->form().kind != InstrumentForm::Kind::none) list.push_back(make(*x));
  }
  return list;
}

}  // namespace

json instrument_form_json(const Instrument& instrument) {
  const InstrumentForm form = instrument.form();
  json out{{"kind", word_of(form.kind)}, {"name", instrument.name()}};
  const auto length = [&](const char* key, double value) {
    if (value > 0.0) out[key] = value;
  };
  length("radius_m", form.radius);
  length("length_m", form.length);
  length("tip_m", form.tip);
  if (form.kind == InstrumentForm::Kind::block) out["size_m"] = numbers(form.size);
  if (form.kind == InstrumentForm::Kind::blade) {
    out["size_m"] = numbers(form.from);
    for (const json& x : numbers(form.to)) out["size_m"].push_back(x);
  }
  return out;
}

json instrument_place_json(const Instrument& instrument) {
  json line = json::array(), axes = json::array();
  for (const Vec3d& p : instrument.centre_line()) {
    for (const json& x : numbers(p)) line.push_back(x);
  }
  for (const auto& row : instrument.pose().axes.m) {
    for (const double x : row) axes.push_back(static_cast<float>(x));
  }
  return {{"points", std::move(line)}, {"axes", std::move(axes)}};
}

json instrument_forms_json(const InstrumentList& instruments) { return list_of(instruments, instrument_form_json); }
json instrument_places_json(const InstrumentList& instruments) { return list_of(instruments, instrument_place_json); }

}  // namespace glisson
