// What a hand did is kept whole and goes again: `glisson run` of the scene that a recording writes meets the forces that were
// felt. An archive is what any unzip opens; what a scene cannot say is said in its head; memory is bounded.
#include <chrono>
#include <fstream>
#include <thread>

#include "app/program.h"
#include "glisson/scene/scene.h"
#include "view/engine/engine.h"
#include "view/engine/scene_writer.h"
#include "view/state/recording.h"
#include "view/state/zip.h"

namespace glisson::test {
namespace {

using namespace std::chrono_literals;
using view::CommandKind;
using view::ForceSample;
using view::Recording;

std::string content_of(const view::ZipFile& file) {
  std::string text;
  file.content([&](std::string_view piece) {
    text += piece;
    return true;
  });
  return text;
}

class ViewRecording : public ProgramTest {
 protected:
  /// Leads the first tool to depths [m], one after the other, each until it is there and 50 ms beyond.
  void lead(view::Engine& engine, Recording& recording, const std::vector<float>& depths) {
    engine.start();
    std::uint32_t sequence = 0;
    double last = 0.0;
    float depth = 0.0f;
    const auto until = [&](auto holds) {
      for (int i = 0; i < 60000; ++i) {
        for (ForceSample sample; engine.next_sample(sample);) {
          recording.add(sample);
          last = sample.frame_time;
          depth = sample.depth[0];
        }
        if (holds()) return;
        std::this_thread::sleep_for(1ms);
      }
      ADD_FAILURE() << "a minute has passed";
    };
    for (const float to : depths) {
      engine.post({.kind = CommandKind::place, .sequence = ++sequence, .values = {to, 0.0f, 0.0f}});
      until([&] { return std::abs(depth - to) < 1e-6f; });
      const double there = last;
      until([&] { return last > there + 0.05; });
    }
    engine.stop();
    for (ForceSample sample; engine.next_sample(sample);) recording.add(sample);
  }

  void unpack(const std::vector<view::ZipFile>& files) const {
    std::filesystem::create_directories(folder_ / "recording");
    for (const view::ZipFile& file : files)
      std::ofstream(folder_ / "recording" / file.name, std::ios::binary) << content_of(file);
  }
};

std::vector<view::ZipFile> files_of(const Scene& scene, const view::Engine& engine, const Recording& recording,
                                    const std::vector<Override>& overrides = {}) {
  std::vector<double> parameters;
  for (const view::ParameterInfo& x : engine.parameters()) parameters.push_back(x.value);
  return view::recording_files(scene, scene.variants.front(), overrides, engine.tools(), recording.snapshot(),
                               parameters);
}

/// A value at a time from a table of increasing times.
double at(const std::vector<double>& times, const std::vector<double>& values, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return values.front();
  if (after == times.end()) return values.back();
  const auto i = static_cast<std::size_t>(after - times.begin());
  const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return values[i - 1] * (1.0 - share) + values[i] * share;
}

// The way is a straight line within each millisecond by hand and a cubic through the same points in the run: while the speed is
// the same both are one line; while it changes, by Δv over 1 ms, they are Δv/8 ms apart, 1 µm here, and inertia, m Δv/h in the
// step at each corner, is another. So places are compared throughout, and forces where the speed was the same for 7 ms about, where
// 1 % of the largest bounds what is left of those corners; a motion shifted by one frame would be off by that alone.
TEST_F(ViewRecording, GoesAgainWithTheForcesThatWereFelt) {
  const std::vector<Override> fine{{"motion.step_s", "0.0002"}};  // steps that see the ramp of 2 ms
  const Scene scene = load_scene(write("s.toml", small_scene()), fine);
  view::Engine engine(scene.variants.front(), {});
  Recording recording(engine.tools().size());
  lead(engine, recording, {0.001f, 0.0004f, 0.0008f});
  ASSERT_GT(recording.frames(), 150u);
  EXPECT_EQ(recording.unsaid(), "");
  unpack(files_of(scene, engine, recording, fine));

  const Outcome outcome = run({"run", "recording/scene.toml", "--out", "again", "--quiet"});
  ASSERT_THAT(outcome, Exits(0));
  auto felt = read_csv(folder_ / "recording/forces.csv"), again = read_csv(folder_ / "again/main/forces.csv");
  ASSERT_EQ(felt["time_s"].size(), recording.frames());
  EXPECT_NEAR(again["time_s"].back(), recording.duration(), 2e-3);
  const std::string name = engine.tools().front().name;
  const std::vector<double>& force = felt[name + "_force_N"];
  const std::vector<double>& depth = felt[name + "_depth_m"];
  const auto steady = [&](std::size_t i) {
    if (i < 5 || i + 3 >= depth.size()) return false;
    for (std::size_t k = i - 4; k <= i + 2; ++k) {
      if (std::abs(depth[k + 1] - 2.0 * depth[k] + depth[k - 1]) > 2e-8) return false;
    }
    return true;
  };
  double most = 0.0, off = 0.0, deep = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < force.size() && felt["time_s"][i] < again["time_s"].back(); ++i) {
    most = std::max(most, std::abs(force[i]));
    deep = std::max(deep, std::abs(depth[i] - at(again["time_s"], again["depth_m"], felt["time_s"][i])));
    if (!steady(i)) continue;
    ++compared;
    const double apart = std::abs(force[i] - at(again["time_s"], again["force_N"], felt["time_s"][i]));
    off = std::max(off, apart);
  }
  EXPECT_GT(compared, force.size() / 2);
  EXPECT_GT(most, 0.01);
  EXPECT_LT(off, 0.01 * most);
  EXPECT_LT(deep, 3e-6);
  RecordProperty("off_percent", std::to_string(100.0 * off / most));
}

// Variants, --set and sliders are laid out: the scene stands by itself.
TEST_F(ViewRecording, WritesTheExperimentAsItStood) {
  const std::string text = small_scene(
      "[[variant]]\nname = \"soft\"\ntissue.youngs_modulus_Pa = 1000\n[[variant]]\nname = "
      "\"hard\"\nlabel = \"hard one\"\ntissue.youngs_modulus_Pa = 9000\n");
  const std::vector<Override> overrides{{"tissue.density_kg_m3", "1100"}};
  const Scene scene = parse_scene(text, "s.toml", ".", overrides);
  view::Engine engine(scene.variants[1], {});
  Recording recording(engine.tools().size());
  for (int i = 0; i < 5; ++i) recording.add({.epoch = 0, .frame_time = 0.001 * i, .force_time = 0.001 * i});
  const auto files = view::recording_files(scene, scene.variants[1], overrides, engine.tools(), recording.snapshot(),
                                           {12000.0, 0.3, 7.0});
  unpack(files);
  const Scene again = load_scene(folder_ / "recording/scene.toml");
  ASSERT_EQ(again.variants.size(), 1u);
  const Variant& v = again.variants.front();
  EXPECT_EQ(v.tissue.youngs_modulus, 12000.0);
  EXPECT_EQ(v.tissue.poisson_ratio, 0.3);
  EXPECT_EQ(v.tissue.viscosity, 7.0);
  EXPECT_EQ(v.tissue.density, 1100.0);
  EXPECT_EQ(v.tools.front().record->motion.times.size(), 5u);
  EXPECT_DOUBLE_EQ(*v.duration, 0.004);
  EXPECT_NE(again.source.find("hard one"), std::string::npos) << "the head says what it was";
}

TEST_F(ViewRecording, SaysWhatASceneCannot) {
  Recording recording(1);
  for (int i = 0; i < 9; ++i)
    recording.add({.epoch = 3, .frame_time = 0.001 * i, .force_time = 0.001 * i, .grabbed = i == 4, .cut = i > 5});
  EXPECT_EQ(recording.unsaid(),
            "Tissue was pulled by hand from 0.004 s on.\nThe body was cut by hand from 0.006 s on.\n");
  const Scene scene = parse_scene(small_scene(), "s.toml", ".");
  const view::Engine engine(scene.variants.front(), {});
  const std::string text = content_of(files_of(scene, engine, recording).back());
  EXPECT_EQ(text.substr(0, 1), "#");
  EXPECT_NE(text.find("# The body was cut by hand from 0.006 s on."), std::string::npos) << text;
}

// A new body begins a new recording; what does not follow on, or is too much, ends it with a word.
TEST_F(ViewRecording, BeginsWithEachBodyAndIsBounded) {
  Recording recording(2, 12 * 10 * sizeof(double));
  for (int i = 0; i < 30; ++i) recording.add({.epoch = 1, .frame_time = 0.001 * i});
  EXPECT_EQ(recording.frames(), 10u);
  EXPECT_TRUE(recording.full());
  EXPECT_NE(recording.unsaid().find("maximum size"), std::string::npos);
  recording.add({.epoch = 2, .frame_time = 0.0});
  EXPECT_EQ(recording.frames(), 1u);
  EXPECT_EQ(recording.unsaid(), "");
  recording.add({.epoch = 2, .frame_time = 0.005});
  recording.add({.epoch = 2, .frame_time = 0.006});
  EXPECT_EQ(recording.frames(), 1u) << "after a gap the motion is not known";
  EXPECT_NE(recording.unsaid().find("fast enough"), std::string::npos);
}

// What goes out while the body moves on is what was there when it was asked for, in pieces of a bounded size.
TEST_F(ViewRecording, SnapshotsStandStill) {
  Recording recording(1);
  const auto add = [&](int from, int to) {
    for (int i = from; i < to; ++i) recording.add({.epoch = 0, .frame_time = 0.001 * i, .force_time = 0.001 * i});
  };
  const std::vector<view::ToolInfo> tools{{.name = "t"}};
  const auto text_of = [&](const Recording& kept) {
    return content_of({"", [&](const view::TextSink& out) {
                         kept.forces_csv(tools, [&](std::string_view piece) {
                           EXPECT_LE(piece.size(), 66000u);
                           return out(piece);
                         });
                       }});
  };
  add(0, 6000);
  const std::shared_ptr<const Recording> then = recording.snapshot();
  const std::string text = text_of(*then);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6001);
  add(6000, 20000);
  EXPECT_EQ(text_of(*then), text);
  EXPECT_EQ(text_of(recording).substr(0, text.size()), text);
  recording.add({.epoch = 1, .frame_time = 0.0});
  EXPECT_EQ(text_of(*then), text) << "a new body begins another recording, and takes nothing away";
}

// Python's own reader checks names, sizes and checksums.
TEST_F(ViewRecording, ArchiveOpensElsewhere) {
  const view::ZipFile in_pieces{"b.bin", [](const view::TextSink& out) {
                                  for (int i = 0; i < 7; ++i) out(std::string(10000, '\x9c'));
                                }};
  const view::ZipArchive archive({view::text_file("a.txt", "some text\n"), view::text_file("empty", ""), in_pieces});
  std::string bytes;
  EXPECT_TRUE(archive.write([&](std::string_view piece) {
    bytes += piece;
    return true;
  }));
  EXPECT_EQ(bytes.size(), archive.bytes()) << "as its head says";
  std::ofstream(folder_ / "x.zip", std::ios::binary) << bytes;
  const std::string command =
      "cd '" + folder_.string() +
      "' && python3 -c \"import zipfile; z = zipfile.ZipFile('x.zip'); assert z.testzip() is None; "
      "assert z.namelist() == ['a.txt', 'empty', 'b.bin']; assert z.read('a.txt') == b'some text\\n'; "
      "assert len(z.read('b.bin')) == 70000\"";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace glisson::test
