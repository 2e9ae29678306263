// recording.cpp — see recording.h.
#include "view/state/recording.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "report/output_file.h"

namespace glisson::view {
namespace {

constexpr std::size_t kPiece = 32768;  // of a table that is handed on [bytes]
constexpr double kFrameSlack = 1e-4;   // of a second: frames follow each other every millisecond

void note(double& first, bool now, double time) {
  if (now && first < 0.0) first = time;
}

std::string at(const char* what, double time, const char* more) {
  return time < 0.0 ? "" : what + number_text(time) + more;
}

/// A name among others in a line of a table.
std::string column(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ',' || c == '"' || c == '\n'; }, '_');
  return name;
}

}  // namespace

void Recording::add(const ForceSample& sample) {
  if (sample.epoch != epoch_) *this = Recording(tools_, most_bytes_);
  epoch_ = sample.epoch;
  if (full_ || gap_) return;
  if (frames_ * stride() * sizeof(double) >= most_bytes_) {
    full_ = true;
    return;
  }
  const double expected = frames_ > 0 ? value(frames_ - 1, 0) + 0.001 : 0.0;
  if (std::abs(sample.frame_time - expected) > kFrameSlack) {
    gap_ = true;
    return;
  }
  if (frames_ == blocks_.size() * kBlockFrames) blocks_.emplace_back(new double[kBlockFrames * stride()]);
  double* at = &blocks_.back()[frames_ % kBlockFrames * stride()];
  *at++ = sample.frame_time;
  *at++ = sample.force_time;
  for (std::size_t i = 0; i < tools_; ++i) {
    for (std::size_t k = 0; k < 3; ++k) *at++ = sample.way[i][k];
    *at++ = static_cast<double>(sample.depth[i]);
    *at++ = static_cast<double>(sample.force[i]);
  }
  ++frames_;
  note(grabbed_, sample.grabbed, sample.frame_time);
  note(cut_, sample.cut, sample.frame_time);
  note(changed_, sample.changed, sample.frame_time);
}

double Recording::duration() const { return frames_ > 0 ? value(frames_ - 1, 0) : 0.0; }

std::string Recording::unsaid() const {
  std::string text =
      at("Tissue was pulled by hand from ", grabbed_, " s on.\n") +
      at("The body was cut by hand from ", cut_, " s on.\n") +
      at("The tissue was changed while it moved, first at ", changed_, " s; this scene has it as it was at the end.\n");
  if (full_) text += "The recording ends here: it reached its maximum size.\n";
  if (gap_) text += "The recording ends here: the program could not write it fast enough.\n";
  return text;
}

template <class Row>
void Recording::table(std::string text, const TextSink& out, Row row) const {
  for (std::size_t f = 0; f < frames_; ++f) {
    row(text, f);
    text += '\n';
    if (text.size() < kPiece) continue;
    if (!out(text)) return;
    text.clear();
  }
  out(text);
}

void Recording::forces_csv(const std::vector<ToolInfo>& tools, const TextSink& out) const {
  std::string head = "time_s";
  for (std::size_t i = 0; i < tools_; ++i)
    head += "," + column(tools[i].name) + "_depth_m," + column(tools[i].name) + "_force_N";
  table(head + "\n", out, [this](std::string& text, std::size_t f) {
    text += number_text(value(f, 1));
    for (std::size_t i = 0; i < tools_; ++i)
      text += "," + number_text(value(f, 5 + 5 * i)) + "," + number_text(value(f, 6 + 5 * i));
  });
}

void Recording::way_csv(std::size_t tool, const TextSink& out) const {
  table("time_s,x_m,y_m,z_m\n", out, [this, tool](std::string& text, std::size_t f) {
    text += number_text(value(f, 0));
    for (std::size_t k = 0; k < 3; ++k) text += "," + number_text(value(f, 2 + 5 * tool + k));
  });
}

std::string way_file(const std::vector<ToolInfo>& tools, std::size_t tool) {
  std::string name = "way_" + std::to_string(tool + 1) + "_";
  for (const char c : tools[tool].name) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name + ".csv";
}

}  // namespace glisson::view
