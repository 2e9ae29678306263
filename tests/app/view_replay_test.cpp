// A recorded run is shown as it was: at the times of its frames the bytes of its frames, between them straight lines; its
// forces are those of its tables; what broke off is shown as far as it goes; memory stays within its bound.
#include <array>
#include <chrono>
#include <fstream>
#include <thread>

#include "app/program.h"
#include "glisson/io.h"
#include "view/replay/force_lines.h"
#include "view/replay/replay.h"
#include "view/replay/run_folder.h"
#include "view/state/surface.h"

namespace glisson::test {
namespace {

namespace fs = std::filesystem;
using view::CommandKind;

class ViewReplay : public ProgramTest {
 protected:
  fs::path recorded(const std::string& more = "") {
    const Outcome outcome =
        run({"run", write("s.toml", small_scene(more)), "--out", "o", "--quiet", "--set", "output.frames=6"});
    EXPECT_THAT(outcome, Exits(0));
    return folder_ / "o";
  }
  std::string why(const fs::path& folder, const std::string& variant = "") {
    try {
      view::open_run(folder, variant);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "it was opened";
  }
};

/// Asks a replay for a state, as the server does.
struct Watching {
  explicit Watching(view::RunFolder folder) : replay(std::move(folder)) { replay.start(); }
  ~Watching() { replay.stop(); }
  /// The first state after the replay has heard of a command.
  view::Snapshot after(view::Command command) {
    command.sequence = ++sequence;
    replay.post(command);
    for (int i = 0; i < 20000; ++i) {
      if (const view::Snapshot* state = replay.latest(); state != nullptr && state->echo == sequence) return *state;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ADD_FAILURE() << "no state within 20 s";
    return {};
  }
  view::Snapshot at(double time) { return after({.kind = CommandKind::seek, .values = {static_cast<float>(time)}}); }

  view::Replay replay;
  std::uint32_t sequence = 0;
};

std::vector<Vec3d> places(const view::Snapshot& state) {
  std::vector<Vec3d> x = state.shape->mesh.vertices;
  for (std::size_t v = 0; v < x.size(); ++v) x[v] += state.displacement[v];
  return x;
}

/// Of the vertices in a frame as it is on disk.
std::vector<Vec3d> places_in(const fs::path& file) {
  const std::vector<std::string> wanted{"displacement_m"};
  const ReadFrame frame = read_frame(file, wanted);
  std::vector<Vec3d> x = frame.mesh.vertices;
  const std::vector<double>& u = frame.vertex_fields.at(0).values;
  for (std::size_t v = 0; v < x.size(); ++v) x[v] += Vec3d{u[3 * v], u[3 * v + 1], u[3 * v + 2]};
  return x;
}

double apart(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  EXPECT_EQ(a.size(), b.size());
  double most = 0.0;
  for (std::size_t v = 0; v < std::min(a.size(), b.size()); ++v) most = std::max(most, norm(a[v] - b[v]));
  return most;
}

// The time of a command has 32 bits: 4e-9 s at 0.05 s, at 20 mm/s less than 1e-10 m.
constexpr double kSamePlace = 1e-9;

TEST_F(ViewReplay, ShowsEachFrameAndStraightLinesBetween) {
  const view::RunFolder run = view::open_run(recorded(), "");
  ASSERT_EQ(run.frames.size(), 6u);
  std::vector<std::vector<Vec3d>> frames;
  for (const view::RunFrame& frame : run.frames) frames.push_back(places_in(frame.file));
  Watching watching(run);
  for (const std::size_t i : {5u, 0u, 3u, 1u, 4u, 2u})
    EXPECT_LT(apart(places(watching.at(run.frames[i].time)), frames[i]), kSamePlace) << "frame " << i;
  const view::Snapshot between = watching.at(0.75 * run.frames[2].time + 0.25 * run.frames[3].time);
  std::vector<Vec3d> line;
  for (std::size_t v = 0; v < frames[2].size(); ++v) line.push_back(frames[2][v] * 0.75 + frames[3][v] * 0.25);
  EXPECT_LT(apart(places(between), line), kSamePlace);
  EXPECT_EQ(between.shape_number, 1u) << "one mesh, one shape";
}

TEST_F(ViewReplay, MarksWhatIsHeldAndDriven) {
  const view::RunFolder run = view::open_run(recorded(), "");
  Watching watching(run);
  const view::Snapshot state = watching.at(0.0);
  const auto& marks = state.shape->marks;
  EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 9) << "the bottom";
  EXPECT_GT(std::count(marks.begin(), marks.end(), 2), 0) << "where the tool presses";
}

/// The arrays of a frame as it is on disk.
std::vector<double> array_in(const fs::path& file, const std::string& name) {
  const std::vector<std::string> wanted{name};
  const ReadFrame frame = read_frame(file, wanted);
  const auto& fields = frame.tet_fields.empty() ? frame.vertex_fields : frame.tet_fields;
  return fields.empty() ? std::vector<double>() : fields.front().values;
}

// The stress of a recorded run is that of its frames, on straight lines between them, and none is read until somebody asks for it.
TEST_F(ViewReplay, ShowsTheStressOfItsFrames) {
  const view::RunFolder run = view::open_run(recorded(), "");
  Watching watching(run);
  EXPECT_TRUE(watching.replay.has_stress());
  EXPECT_TRUE(watching.at(run.frames[2].time).von_mises.empty()) << "nobody looks at it";
  watching.replay.want_fields(true, false);
  const std::vector<double> two = array_in(run.frames[2].file, "von_mises_Pa"),
                            three = array_in(run.frames[3].file, "von_mises_Pa"),
                            pressure = array_in(run.frames[5].file, "pressure_Pa");
  const view::Snapshot state = watching.at(0.75 * run.frames[2].time + 0.25 * run.frames[3].time);
  ASSERT_EQ(state.von_mises.size(), two.size());
  double most = 0.0;
  for (std::size_t t = 0; t < two.size(); ++t) {
    most = std::max(most, three[t]);
    EXPECT_NEAR(state.von_mises[t], 0.75 * two[t] + 0.25 * three[t], 1e-4 * most + 1e-9);
  }
  EXPECT_GT(most, 10.0);
  const view::Snapshot last = watching.at(run.frames[5].time);
  view::Surface surface(last.shape);
  const std::vector<double> shown = surface.field(view::Field::pressure, last);
  for (std::size_t v = 0; v < surface.size(); ++v) {
    double sum = 0.0, count = 0.0;
    for (std::size_t t = 0; t < pressure.size(); ++t) {
      const Tet& tet = last.shape->mesh.tets[t];
      if (std::find(tet.begin(), tet.end(), surface.mesh_vertex(v)) == tet.end()) continue;
      sum += pressure[t], count += 1.0;
    }
    EXPECT_NEAR(shown[v], sum / count, 1e-6 * std::abs(sum)) << v;
  }
}

// Frames without stress, as of an older run, offer none and show none.
TEST_F(ViewReplay, OffersNoStressWhereFramesHaveNone) {
  const fs::path folder = recorded();
  for (int i = 0; i < 6; ++i) {
    const fs::path file = folder / ("main/frames/frame_000" + std::to_string(i) + ".vtu");
    const std::vector<std::string> wanted{"displacement_m"};
    const ReadFrame frame = read_frame(file, wanted);
    write_vtu(file, frame.mesh, {}, frame.vertex_fields);
  }
  Watching watching(view::open_run(folder, ""));
  EXPECT_FALSE(watching.replay.has_stress());
  watching.replay.want_fields(true, true);
  const view::Snapshot state = watching.at(0.05);
  view::Surface surface(state.shape);
  for (const double x : surface.field(view::Field::von_mises, state)) EXPECT_EQ(x, 0.0);
}

// The container about a recorded body, with a wall without end drawn above it, as the live view and the report have it; none where there
// is none, or where the run is from an older glisson.
TEST_F(ViewReplay, HasTheContainer) {
  const auto vessel = [&](const std::string& container) {
    const fs::path folder = recorded(container);
    const nlohmann::json head = report_data(folder / "report.html")["scenes"][0]["variants"][0]["surface"];
    const std::string own = view::Replay(view::open_run(folder, "")).vessel();
    return std::pair(own.empty() ? nlohmann::json() : nlohmann::json::parse(own), head);
  };
  const std::string box = "[container]\nkind = \"box\"\nwidth_mm = 60\nlength_mm = 50\n";
  const auto [open, reported] = vessel(box);
  EXPECT_EQ(open["kind"], "box");
  EXPECT_EQ(open["width_m"], 0.06);
  EXPECT_EQ(open, reported["container"]) << "as in the report";
  EXPECT_GT(open["height_m"].get<double>(), 0.02);
  EXPECT_EQ(vessel(box + "height_mm = 7\n").first["height_m"], 0.007);
  EXPECT_TRUE(vessel("").first.is_null());
}

// A block that a blade has parted shows both faces of its section of 4 cm² as cut, from the frame of the cut on and not before, in
// whatever order frames are asked for.
TEST_F(ViewReplay, TellsCutFacesFromSkin) {
  const Outcome outcome = run({"run", write("cut.toml", R"(title = "A block in two"
[mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.02, 0.02, 0.02]
[tissue]
youngs_modulus_Pa = 3600
poisson_ratio = 0.4
[motion]
damping_rate_per_s = 20
[[fixed]]
set = "z_min"
[[instrument]]
kind = "blade"
name = "knife"
tip_m = [-0.002, 0.01, 0.0137]
direction = [1, 0, 0]
side = [0, 1, 0]
edge_from_mm = [-15, 0, 0]
edge_to_mm = [15, 0, 0]
toughness_J_m2 = 0
[instrument.motion]
kind = "press"
velocity_mm_s = 200
depth_mm = 25
)"),
                               "--out", "o", "--quiet", "--set", "output.frames=4"});
  ASSERT_THAT(outcome, Exits(0));
  const view::RunFolder run = view::open_run(folder_ / "o", "");
  const auto areas = [](const view::Snapshot& state) {
    const view::Surface surface(state.shape);
    std::array<double, 3> area{};
    for (std::size_t t = 0; t < surface.kinds().size(); ++t) {
      const auto at = [&](std::size_t k) { return surface.rest(surface.triangles()[3 * t + k]); };
      area[surface.kinds()[t]] += 0.5 * norm(cross(at(1) - at(0), at(2) - at(0)));
    }
    return area;
  };
  Watching watching(run);
  const std::array<double, 3> cut = areas(watching.at(run.frames.back().time)), whole = areas(watching.at(0.0));
  EXPECT_NEAR(whole[0], 24e-4, 1e-10);
  EXPECT_EQ(whole[1], 0.0);
  EXPECT_NEAR(cut[1], 8e-4, 0.05 * 8e-4);
  EXPECT_NEAR(cut[0], 24e-4, 0.02 * 24e-4);
}

// A capsule that is stretched beyond its strength is torn in the frames after, and in none before, as the run's own file says.
TEST_F(ViewReplay, TellsWhereACapsuleIsTorn) {
  const fs::path folder =
      recorded("[[capsule]]\nset = \"x_min\"\nyoungs_modulus_Pa = 1e5\nstrength_N_m = 0.02\naveraging_length_mm = 1\n");
  const view::RunFolder run = view::open_run(folder, "");
  ASSERT_TRUE(run.frames.back().torn) << "nothing has torn";
  ASSERT_FALSE(run.frames.back().torn->empty());
  EXPECT_FALSE(run.frames.front().torn);
  Watching watching(run);
  const auto torn = [&](double time) {
    const view::Surface surface(watching.at(time).shape);
    return static_cast<std::size_t>(std::count(surface.kinds().begin(), surface.kinds().end(), 2));
  };
  EXPECT_EQ(torn(run.frames.back().time), run.frames.back().torn->size());
  EXPECT_EQ(torn(0.0), 0u);
}

TEST_F(ViewReplay, TellsTheForcesOfTheTables) {
  const fs::path folder = recorded();
  auto table = read_csv(folder / "main/forces.csv");
  const view::RunFolder run = view::open_run(folder, "");
  ASSERT_EQ(run.forces.size(), table["time_s"].size());
  Watching watching(run);
  view::ForceSample sample;
  for (std::size_t i = 0; i < table["time_s"].size(); ++i) {
    ASSERT_TRUE(watching.replay.next_sample(sample));
    EXPECT_EQ(sample.force[0], static_cast<float>(table["force_N"][i]));
    EXPECT_EQ(sample.depth[0], static_cast<float>(table["depth_m"][i]));
  }
  EXPECT_FALSE(watching.replay.next_sample(sample));
  const std::size_t last = table["time_s"].size() - 1;
  const view::Snapshot end = watching.at(1e9);
  EXPECT_EQ(end.tools.at(0).depth, table["depth_m"][last]);
  EXPECT_NEAR(dot(end.tools.at(0).force, run.tools.at(0).direction), table["force_N"][last], 1e-12);
}

TEST_F(ViewReplay, PlaysToItsEndStepsAndGoesBack) {
  const view::RunFolder run = view::open_run(recorded(), "");
  Watching watching(run);
  EXPECT_TRUE(watching.at(0.0).paused);
  EXPECT_EQ(watching.after({.kind = CommandKind::step}).time, run.frames[1].time);
  watching.after({.kind = CommandKind::rate, .values = {100.0f}});
  view::Snapshot state = watching.after({.kind = CommandKind::play});
  for (int i = 0; i < 5000 && !state.paused; ++i) {
    if (const view::Snapshot* next = watching.replay.latest()) state = *next;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(state.paused);
  EXPECT_EQ(state.time, run.frames.back().time);
  EXPECT_EQ(watching.after({.kind = CommandKind::reset}).time, run.frames.front().time);
}

// A hand moves nothing: the body is that of the recording whatever is asked.
TEST_F(ViewReplay, BearsNoHand) {
  const view::RunFolder run = view::open_run(recorded(), "");
  Watching watching(run);
  const std::vector<Vec3d> before = places(watching.at(0.02));
  for (const CommandKind kind : {CommandKind::place, CommandKind::grab, CommandKind::drag, CommandKind::parameter})
    EXPECT_EQ(apart(places(watching.after({.kind = kind, .values = {0.01f, 0.0f, 0.0f}})), before), 0.0);
  EXPECT_FALSE(watching.replay.can_grab());
  EXPECT_TRUE(watching.replay.parameters().empty());
}

TEST_F(ViewReplay, KeepsMemoryWithinItsBound) {
  const view::RunFolder run = view::open_run(recorded(), "");
  view::FrameCache cache(run,
                         3 * 27 * sizeof(Vec3d) + 27 * sizeof(Vec3d) + 48 * sizeof(Tet));  // the mesh, three frames
  for (int round = 0; round < 3; ++round) {
    for (std::size_t i = 0; i < run.frames.size(); ++i) ASSERT_EQ(cache.at(i)->displacement.size(), 27u);
    EXPECT_LE(cache.bytes(), 5 * 27 * sizeof(Vec3d) + 48 * sizeof(Tet));
  }
  EXPECT_EQ(cache.reads(), 18u) << "one after the other, none is kept until its turn comes again";
  cache.at(5);
  EXPECT_EQ(cache.reads(), 18u) << "the last is still there";
}

TEST_F(ViewReplay, OpensWhatBrokeOffAsFarAsItGoes) {
  const fs::path folder = recorded();
  fs::remove(folder / "main/summary.json");
  fs::remove(folder / "main/frames/frame_0004.vtu");
  std::string forces = read_text(folder / "main/forces.csv");
  const std::size_t whole = static_cast<std::size_t>(std::count(forces.begin(), forces.end(), '\n')) - 1;
  std::ofstream(folder / "main/forces.csv", std::ios::binary) << forces.substr(0, forces.size() - 9);
  const view::RunFolder run = view::open_run(folder, "");
  EXPECT_EQ(run.frames.size(), 4u);
  EXPECT_EQ(run.forces.size(), whole - 1) << "the half line is none";
  EXPECT_NE(run.notice.find("Only 4 of 6 frames"), std::string::npos) << run.notice;
  EXPECT_NE(run.notice.find("interrupted"), std::string::npos) << run.notice;
  Watching watching(run);
  EXPECT_EQ(watching.at(1e9).time, run.frames[3].time);
}

// A frame of an older version, whose points were displaced, is refused by name, not drawn twice as far.
TEST_F(ViewReplay, TellsOfAFrameOfAnOlderVersion) {
  const fs::path folder = recorded(), old = folder / "main/frames/frame_0003.vtu";
  const std::vector<std::string> wanted{"displacement_m"};
  const ReadFrame frame = read_frame(old, wanted);
  const Field stress{"stress_xx_Pa", 1, std::vector<double>(frame.mesh.tets.size(), 0.0)};
  write_vtu(old, frame.mesh, places_in(old), frame.vertex_fields, std::span(&stress, 1));
  const view::RunFolder run = view::open_run(folder, "");
  Watching watching(run);
  const std::string notice = watching.at(run.frames[3].time).notice;
  EXPECT_NE(notice.find("frame_0003.vtu: a frame of an older version"), std::string::npos) << notice;
}

// A frame that is there by half is told when its turn comes, and the one before it stays.
TEST_F(ViewReplay, TellsOfAHalfWrittenFrame) {
  const fs::path folder = recorded(), bad = folder / "main/frames/frame_0003.vtu";
  fs::resize_file(bad, fs::file_size(bad) / 2);
  const view::RunFolder run = view::open_run(folder, "");
  Watching watching(run);
  const std::vector<Vec3d> second = places_in(run.frames[2].file);
  const view::Snapshot state = watching.at(run.frames[3].time);
  EXPECT_NE(state.notice.find("frame_0003.vtu"), std::string::npos) << state.notice;
  EXPECT_LT(apart(places(state), second), kSamePlace);
  EXPECT_EQ(watching.at(run.frames[5].time).notice, "");
}

TEST_F(ViewReplay, RunsWithoutAViewFileStillOpen) {
  const fs::path folder = recorded();
  fs::remove(folder / "main/view.jsonl");
  const view::RunFolder run = view::open_run(folder, "");
  EXPECT_NE(run.notice.find("view.jsonl"), std::string::npos);
  EXPECT_FALSE(run.forces.empty());
  EXPECT_NE(run.notice.find("older glisson"), std::string::npos);
}

// A damaged or cut first line is what it is, not the mark of an older version: the notice names the line and what is lost.
TEST_F(ViewReplay, TellsOfADamagedHeadOfTheViewFile) {
  const fs::path folder = recorded();
  for (const char* head : {"{\"format\":1,\"tools\":\n", "{\"format\":1", ""}) {
    std::ofstream(folder / "main/view.jsonl") << head;
    const std::string notice = view::open_run(folder, "").notice;
    EXPECT_NE(notice.find("view.jsonl, line 1: "), std::string::npos) << notice;
    EXPECT_NE(notice.find("the file is damaged"), std::string::npos) << notice;
    EXPECT_EQ(notice.find("older"), std::string::npos) << notice;
  }
}

TEST_F(ViewReplay, SaysWhatIsNoRunAndTheWayOut) {
  fs::create_directories(folder_ / "empty");
  EXPECT_NE(why(folder_ / "empty").find("give the folder that `glisson run SCENE --out DIR` wrote"), std::string::npos);
  const fs::path folder = recorded();
  EXPECT_NE(why(folder, "other").find("it has main"), std::string::npos);
  EXPECT_EQ(why(folder / "main"), "it was opened") << "the folder of a variant does, too";
  fs::remove_all(folder / "main/frames");
  EXPECT_NE(why(folder).find("run the scene again"), std::string::npos);
  ASSERT_THAT(run({"run", "s.toml", "--out", "o2", "--quiet", "--set", "output.frames=0"}), Exits(0));
  EXPECT_NE(why(folder_ / "o2").find("--set output.frames=30"), std::string::npos);
}

TEST_F(ViewReplay, CommandRefusesWhatCannotBe) {
  recorded();
  const auto refused = [&](std::vector<std::string> options) {
    options.insert(options.begin(), {"view", "o"});
    const Outcome outcome = run(options);
    EXPECT_THAT(outcome, Exits(2));
    return outcome.err;
  };
  EXPECT_NE(refused({"--set", "tissue.poisson_ratio=0.3"}).find("cannot be changed; give the scene"),
            std::string::npos);
  EXPECT_NE(refused({"--variant", "nine"}).find("it has main"), std::string::npos);
}

// A table longer than what is kept loses lines, not its peak, nor its end.
TEST(ForceLines, ThinningKeepsPeakAndEnd) {
  std::vector<view::ForceLine> lines;
  for (int i = 0; i < 1000; ++i) lines.push_back({.time = 0.001 * i, .depth = {}, .force = {1.0}});
  lines[617].force[0] = -9.0;
  lines[999].force[0] = 0.5;
  const std::vector<view::ForceLine> few = view::thinned(lines, 90);
  EXPECT_LE(few.size(), 90u);
  EXPECT_TRUE(std::any_of(few.begin(), few.end(), [](const auto& x) { return x.time == 0.617 && x.force[0] == -9.0; }));
  EXPECT_EQ(few.back().time, 0.999);
  EXPECT_EQ(view::forces_at(lines, 0.0005).force[0], 1.0);
  EXPECT_NEAR(view::forces_at(lines, 0.6165).force[0], -4.0, 1e-9);
  EXPECT_EQ(view::forces_at(lines, 7.0).time, 0.999);
}

}  // namespace
}  // namespace glisson::test
