// section.cpp — the keys of a section, whatever struct it fills.
#include "scene/parse/section.h"

#include <stdexcept>

namespace glisson::scene {

SectionBuilder::SectionBuilder(std::string name, std::string help) {
  spec_.name = std::move(name);
  spec_.help = std::move(help);
}

void SectionBuilder::bare_after(std::string_view other, std::vector<KeySpec> keys) {
  const auto is_it = [&](const KeySpec& key) { return key.name == other; };
  const auto at = std::find_if(spec_.keys.begin(), spec_.keys.end(), is_it) + 1;
  spec_.keys.insert(at, std::move_iterator(keys.begin()), std::move_iterator(keys.end()));
}

KeySpec& SectionBuilder::add_value(std::string name, const ValueCode& code, MemberPlace place, const void* initial,
                                   std::string help) {
  KeySpec key{.name = std::move(name), .help = std::move(help), .type = code.type, .shape = code.shape};
  if (code.largest > 0.0) key.range = between(0.0, code.largest);
  if (code.words) key.words = code.words();
  key.default_text = code.show(initial);
  key.store = [place = std::move(place), read = code.read](void* target, const Node& node) {
    read(node, place.in(target));
  };
  return push(std::move(key));
}

KeySpec& SectionBuilder::add_tables(std::string name, Shape shape, const SectionSpec& section, MemberPlace place,
                                    Slot slot, std::string help) {
  KeySpec key{
      .name = std::move(name), .help = std::move(help), .type = ValueType::table, .shape = shape, .section = &section};
  key.slot = [place = std::move(place), slot](void* target, const std::string& entry) {
    return slot(place.in(target), entry);
  };
  return push(std::move(key));
}

void SectionBuilder::add_field(Fields& fields, const FieldText& field, const MemberKind& kind, void* member) {
  fields.keys.emplace_back(field.name, field.key());
  const auto& without = fields.without;
  if (!field.in_scenes || std::find(without.begin(), without.end(), field.name) != without.end()) return;
  const auto in_part = static_cast<char*>(member) - static_cast<char*>(fields.initial);
  const MemberPlace place{fields.part.part, fields.part.offset + in_part};
  const auto code = field.scale() == 1.0 ? kind.value : field.unit == "°" ? kind.degrees : kind.thousandth;
  if (!kind.section && !code) {
    throw std::logic_error(field.key() + ": no scene can hold a value of its type; it is no_key()");
  }
  KeySpec& key = kind.section
                     ? add_tables(field.key(), kind.shape, kind.section(), place, kind.slot, std::string(field.help))
                     : add_value(field.key(), code(), place, member, std::string(field.help));
  key.unit = field.unit;
  if (field.range.bounded()) key.range = field.range;
  key.advice = field.advice;
  key.accepts_auto = field.accepts_auto;
  key.is_direction = field.is_direction;
  if (!field.default_text.empty()) key.default_text = field.default_text;
  if (field.required) key.must();
}

void SectionBuilder::check_part(std::function<Fault(void* target)> check,
                                std::vector<std::pair<std::string_view, std::string>> keys) {
  add_check([check = std::move(check), keys = std::move(keys)](void* target, const Node& table, const Place& place) {
    const Fault fault = check(target);
    if (fault.what.empty()) return;
    const auto is_it = [&](const auto& key) { return key.first == fault.field; };
    const auto key = std::find_if(keys.begin(), keys.end(), is_it);
    if (key == keys.end()) return place.complain(fault.what);
    const Node* given = table.find(key->second);
    place.complain(given ? *given : table, key->second, fault.what);
  });
}

void SectionBuilder::add_check(Check check) {
  spec_.finish = [check = std::move(check), then = spec_.finish](void* target, const Node& node, const Place& place) {
    const std::size_t before = place.problems.count();
    check(target, node, place);
    if (then && place.problems.count() == before) then(target, node, place);
  };
}

KeySpec& SectionBuilder::push(KeySpec key) {
  spec_.keys.push_back(std::move(key));
  return spec_.keys.back();
}

}  // namespace glisson::scene
