// An instrument of a kind that only this file knows is moved, attached, drawn and written down like any other.
#include <gtest/gtest.h>

#include "dynamics/simulation_parts.h"
#include "glisson/archive.h"
#include "report/instrument_json.h"
#include "report/variant_recorder.h"
#include "support/folder.h"
#include "view/engine/live_body.h"

namespace glisson::test::own_instrument_test {
namespace {

constexpr double kPull = 2e-3;  // [N]
constexpr double kField = 0.7;  // [T]

/// Pulls the vertex nearest to it upwards, wherever it is.
class Magnet final : public Instrument {
 public:
  Magnet(const std::string& name, std::shared_ptr<ToolDriver> driver)
      : Instrument(name, std::move(driver), {0, 0, -1}) {}

  InstrumentForm form() const override { return {.kind = InstrumentForm::Kind::ball, .radius = 3e-3}; }
  std::vector<Vec3d> centre_line() const override { return {pose_.position + Vec3d{0, 0, 0.1}, pose_.position}; }
  void attached(const BodyView& body, double) override {
    double nearest = 1e9;
    for (std::uint32_t v = 0; v < body.mesh.vertices.size(); ++v) {
      const double away = norm(body.mesh.vertices[v] - pose_.position);
      if (away < nearest) nearest = away, vertex_ = v;
    }
  }
  void body_changed(const BodyView&, std::span<const std::uint32_t>) override {}
  std::span<const std::uint32_t> reach(double, double) override { return {&vertex_, 1}; }
  void declare(const InteractionStep& step, StepRows& rows, int round) override {
    if (round > 0) return;
    drive(step);
    forces_ = {.normal = {0, 0, kPull}};
    rows.push(step.place_of[vertex_], forces_.normal * step.h);
  }
  void archive(Archive& ar) override { archive_motion(ar); }

 private:
  std::span<const InstrumentColumn> own_columns() const override {
    static constexpr std::array<InstrumentColumn, 1> kColumns{{{"field_T", [](const Instrument&) { return kField; }}}};
    return kColumns;
  }
  std::uint32_t vertex_ = 0;
};

Variant with_magnet() {
  Variant v = parse_scene(R"([mesh]
kind = "box"
cells = [3, 3, 3]
size_m = [0.03, 0.03, 0.03]
[[fixed]]
set = "z_min"
[[instrument]]
kind = "ball"
name = "magnet"
tip_m = [0.015, 0.015, 0.04]
motion = { kind = "press", depth_mm = 5, velocity_mm_s = 100 }
[output]
frames = 3
)",
                          "s.toml", "/", {})
                  .variants.at(0);
  v.instruments.at(0).what = [](const InstrumentSpec& spec, std::shared_ptr<ToolDriver> driver) {
    return std::make_shared<Magnet>(spec.name, std::move(driver));
  };
  return v;
}

// A run writes its columns after those that all have, and the page gets its form and its place.
TEST(OwnInstrument, IsWrittenDown) {
  const test::Folder own;
  const std::filesystem::path folder = own.path() / "run";
  std::atomic<bool> stop{false};
  const Variant variant = with_magnet();
  VariantRecorder recorder(variant, {.folder = folder, .scene = "s"}, stop);
  EXPECT_EQ(run_variant(variant, {}, recorder, stop).end, RunSummary::End::finished);
  const std::vector<std::string> head{"time_s", "depth_m", "force_x_N", "force_y_N", "force_z_N", "force_N", "field_T"};
  EXPECT_EQ(std::vector(recorder.columns().begin(), recorder.columns().begin() + 7), head);
  EXPECT_EQ(recorder.column("force_z_N").back(), kPull);
  EXPECT_EQ(recorder.column("force_N").back(), -kPull) << "against its direction";
  EXPECT_EQ(recorder.column("field_T").back(), kField);
  EXPECT_NEAR(recorder.column("depth_m").back(), 0.1 * recorder.column("time_s").back(), 1e-12);
  const nlohmann::json surface = recorder.json(1.0)["surface"];
  EXPECT_EQ(surface["instruments"][0]["kind"], "ball");
  EXPECT_EQ(surface["instruments"][0]["radius_m"], 3e-3);
  EXPECT_EQ(surface["frames"].back()["instruments"][0]["points"].size(), 6u) << "its two points";
}

// The live view leads it and shows its line and its force.
TEST(OwnInstrument, IsLedByHand) {
  view::LiveBody body(with_magnet(), {});
  body.way(0).play();
  for (int frame = 0; frame < 20; ++frame) {
    body.way(0).plan(1e-3 * frame, 1e-3);
    ASSERT_TRUE(body.built().simulation.advance_to(1e-3 * (frame + 1)).made());
  }
  const view::ToolState state = body.tool_state(0);
  EXPECT_NEAR(state.depth, 0.1 * body.built().simulation.force_time(), 1e-9);
  EXPECT_EQ(state.force, (Vec3d{0, 0, kPull}));
  ASSERT_EQ(state.line.size(), 2u);
  EXPECT_EQ(state.line[1], body.built().instruments[0]->pose().position);
  EXPECT_EQ(instrument_forms_json(body.built().instruments)[0]["name"], "magnet");
}

// It is attached once, to one simulation; a second one refuses it by its name.
TEST(OwnInstrument, IsRefusedByASecondBody) {
  BuiltVariant first(with_magnet(), {}), second(with_magnet(), {});
  try {
    second.simulation.attach(first.instruments[0]);
    ADD_FAILURE() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("instrument \"magnet\" acts on a simulation already"), std::string::npos);
  }
}

}  // namespace
}  // namespace glisson::test::own_instrument_test
