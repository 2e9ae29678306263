// view_lines.cpp — see view_lines.h.
#include "view/replay/view_lines.h"

#include <fstream>
#include <string>

#include "report/json_field.h"
#include "view/replay/outside_file.h"

namespace glisson::view {
namespace {

constexpr double kNear = 1e-9;  // of times that are the same [s]

Vec3d vector_of(const JsonField& list) { return {list.at(0).number(), list.at(1).number(), list.at(2).number()}; }

std::vector<std::string> texts_of(const JsonField& list) {
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < list.size(); ++i) texts.push_back(list.at(i).text());
  return texts;
}

/// What the page draws: it relies on kind and name.
std::string forms_of(const JsonField& list) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    list.at(i).at("kind").text();
    list.at(i).at("name").text();
  }
  return json_text(list.raw());
}

std::vector<double> first_numbers(const JsonField& list, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(list.at(i).number());
  return numbers;
}

/// The container, each of its values looked at; empty where there is none, or the run is from an older glisson.
std::string vessel_of(const JsonField& head) {
  const auto form = head.find("container");
  if (!form || form->raw().is_null()) return {};
  nlohmann::json vessel{{"kind", form->at("kind").text()},
                        {"origin", first_numbers(form->at("origin"), 3)},
                        {"axes", first_numbers(form->at("axes"), 9)}};
  vessel["height_m"] = nullptr;
  if (!form->at("height_m").raw().is_null()) vessel["height_m"] = form->at("height_m").number();
  for (const char* size : {"radius_m", "width_m", "length_m"}) {
    if (const auto value = form->find(size)) vessel[size] = value->number();
  }
  return json_text(vessel);
}

void take_head(const JsonField& head, RunFolder& run) {
  if (head.at("format").number() != 1.0) throw JsonError("format: expected 1, as this glisson writes it");
  std::vector<ToolInfo> tools;
  const JsonField list = head.at("tools");
  for (std::size_t i = 0; i < list.size(); ++i) {
    const JsonField x = list.at(i);
    tools.push_back({.name = x.at("name").text(),
                     .instrument = x.at("instrument").truth(),
                     .direction = vector_of(x.at("direction"))});
  }
  std::vector<std::string> held = texts_of(head.at("held")), driven = texts_of(head.at("driven"));
  std::string forms = forms_of(head.at("instruments")), title = head.at("scene").text(),
              label = head.at("label").text(), vessel = vessel_of(head);
  run.tools = std::move(tools);  // all of the head, or nothing
  run.held = std::move(held);
  run.driven = std::move(driven);
  run.forms = std::move(forms);
  run.vessel = std::move(vessel);
  run.title = std::move(title);
  run.label = std::move(label);
}

ToolState place_of(const JsonField& place) {
  ToolState state{.depth = 0.0, .aside = {}, .force = {}, .line = {}, .axes = identity<double>()};
  const JsonField points = place.at("points"), axes = place.at("axes");
  for (std::size_t i = 0; i + 2 < points.size(); i += 3)
    state.line.push_back({points.at(i).number(), points.at(i + 1).number(), points.at(i + 2).number()});
  for (std::size_t k = 0; k < 9; ++k) state.axes(k / 3, k % 3) = axes.at(k).number();
  return state;
}

/// Triangles of three vertices each; numbers alone are compared with those of the surface, so that any will do.
std::vector<Triangle> triangles_of(const JsonField& list) {
  std::vector<Triangle> triangles(list.size() / 3);
  for (std::size_t i = 0; i < 3 * triangles.size(); ++i) {
    const double vertex = list.at(i).number();
    if (!(vertex >= 0.0 && vertex < 4294967296.0))
      throw JsonError("torn[" + std::to_string(i) + "]: expected the number of a vertex");
    triangles[i / 3][i % 3] = static_cast<std::uint32_t>(vertex);
  }
  return triangles;
}

/// One line after the head. @param frame  that its time is looked for from; moves on
void take_places(const JsonField& x, std::size_t& frame, RunFolder& run) {
  const double time = x.at("time_s").number();
  while (frame < run.frames.size() && run.frames[frame].time < time - kNear) ++frame;
  if (frame == run.frames.size() || run.frames[frame].time > time + kNear) return;
  const JsonField list = x.at("instruments");
  std::vector<ToolState> places;
  for (std::size_t i = 0; i < list.size(); ++i) places.push_back(place_of(list.at(i)));
  run.frames[frame].instruments = std::move(places);
  if (const auto torn = x.find("torn"))
    run.frames[frame].torn = std::make_shared<const std::vector<Triangle>>(triangles_of(*torn));
}

/// Frames whose line tells of no other tears have those of the frame before.
void carry_tears_on(std::vector<RunFrame>& frames) {
  for (std::size_t i = 1; i < frames.size(); ++i) {
    if (!frames[i].torn) frames[i].torn = frames[i - 1].torn;
  }
}

}  // namespace

void take_view_file(const std::filesystem::path& file, RunFolder& run) {
  std::ifstream stream = open_outside(file);
  const bool is_there = stream.is_open();
  std::size_t frame = 0, number = 1;
  try {
    for (std::string line; std::getline(stream, line) && !stream.eof(); ++number) {
      const nlohmann::json json = parse_json(line);
      number == 1 ? take_head(JsonField(json), run) : take_places(JsonField(json), frame, run);
    }
    if (is_there && number == 1) throw JsonError("it is empty or broke off");
  } catch (const JsonError& error) {
    run.notice +=
        "view.jsonl, line " + std::to_string(number) + ": " + error.what() +
        (number > 1 ? "; instruments are shown up to the line before it.\n"
                    : "; the file is damaged, and what it says of tools and instruments is lost: forces.csv is "
                      "shown as that of one tool. Run the scene again to see them.\n");
  }
  carry_tears_on(run.frames);
  if (run.tools.empty() && !is_there)
    run.notice +=
        "There is no view.jsonl: the run is from an older glisson, and forces.csv is shown as that of one tool. Run "
        "the scene again to see its tools and instruments.\n";
}

}  // namespace glisson::view
