// progress.cpp — see progress.h.
#include "cli/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr int kBarCells = 24;
constexpr std::chrono::milliseconds kRedraw{100};
constexpr std::chrono::seconds kLongStep{5};  ///< in one step: lines say so then …
constexpr std::chrono::seconds kRepeat{30};   ///< … and again after so long
constexpr double kTrustedFraction = 0.002;    // of a run, before its pace says anything

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

/// The first `columns` characters of UTF-8 text.
std::string cut(const std::string& text, std::size_t columns) {
  std::size_t bytes = 0;
  for (std::size_t seen = 0; bytes < text.size(); ++bytes) {
    if ((static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) continue;
    if (seen++ == columns) break;
  }
  return text.substr(0, bytes);
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", std::max(0.0, seconds));
  const long s = std::lround(seconds);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
}

Progress::Style Progress::style_for(bool quiet) {
  if (quiet) return Style::silent;
  return isatty(STDOUT_FILENO) != 0 ? Style::bar : Style::lines;
}

Progress::Progress(std::vector<std::string> names, int workers, Style style) : workers_(workers), style_(style) {
  for (std::string& name : names) {
    Run run;
    run.name = std::move(name);
    runs_.push_back(std::move(run));
  }
}

void Progress::started(std::size_t index) {
  const std::lock_guard lock(mutex_);
  Run& run = runs_[index];
  run.state = State::running;
  run.start = run.moved = run.said = Clock::now();
  if (style_ == Style::lines) say("{}: started\n", run.name);
  draw();
}

void Progress::advanced(std::size_t index, double fraction) {
  const std::lock_guard lock(mutex_);
  Run& run = runs_[index];
  if (fraction > run.fraction) run.moved = Clock::now();
  run.fraction = std::clamp(fraction, run.fraction, 1.0);
  const int tenths = static_cast<int>(run.fraction * 10.0 + 1e-9);
  if (style_ == Style::lines && tenths > run.said_tenths && tenths < 10) {
    const double left = elapsed(run) * (1.0 - run.fraction) / run.fraction;
    say("{}: {} %, {} left\n", run.name, 10 * tenths, duration_text(left));
    std::fflush(stdout);
    run.said_tenths = tenths;
    run.said = Clock::now();
  }
  if (style_ == Style::lines) say_long_step(run);
  if (Clock::now() - drawn_ >= kRedraw) draw();
}

/// A step of an implicit integrator may take minutes in which nothing else is said.
void Progress::say_long_step(Run& run) {
  const Clock::time_point now = Clock::now();
  const auto within = now - run.moved;
  if (within < kLongStep || (run.said > run.moved && now - run.said < kRepeat)) return;
  const double seconds = std::chrono::duration<double>(within).count();
  say("{}: {:.1f} %, in one step for {}\n", run.name, 100.0 * run.fraction, duration_text(seconds));
  std::fflush(stdout);
  run.said = now;
}

void Progress::ended(std::size_t index, const std::string& how) {
  const std::lock_guard lock(mutex_);
  Run& run = runs_[index];
  run.elapsed_s = elapsed(run);
  run.state = State::done;
  if (style_ == Style::lines) {
    say("{}: {} after {}\n", run.name, how, duration_text(run.elapsed_s));
    std::fflush(stdout);
  }
  draw();
}

void Progress::clear() {
  if (style_ != Style::bar) return;
  say("\r\033[K");
  std::fflush(stdout);
}

double Progress::elapsed(const Run& run) const {
  if (run.state == State::waiting) return 0.0;
  if (run.state == State::done) return run.elapsed_s;
  return std::chrono::duration<double>(Clock::now() - run.start).count();
}

double Progress::seconds_left(double& fraction_done) const {
  double known = 0.0, spent = 0.0, longest_left = 0.0;
  int estimated = 0;
  for (const Run& run : runs_) {
    if (run.state == State::waiting) continue;
    const double now = elapsed(run);
    if (run.state == State::running && run.fraction < kTrustedFraction) return -1.0;
    const double whole = run.state == State::done ? now : now / run.fraction;
    longest_left = std::max(longest_left, whole - now);
    known += whole;
    spent += now;
    ++estimated;
  }
  if (estimated == 0) return -1.0;
  const double whole = known / estimated * static_cast<double>(runs_.size());  // runs not begun: as long as the others
  fraction_done = whole > 0.0 ? spent / whole : 1.0;
  return std::max(longest_left, (whole - spent) / workers_);
}

std::string Progress::bar_text() const {
  double fraction = 0.0;
  const double left = seconds_left(fraction);
  std::string bar;
  for (int i = 0; i < kBarCells; ++i) bar += i < fraction * kBarCells ? "█" : "░";
  std::string names;
  std::size_t done = 0;
  for (const Run& run : runs_) {
    done += run.state == State::done ? 1 : 0;
    if (run.state == State::running) names += fmt::format("  {} {:.0f} %", run.name, 100.0 * run.fraction);
  }
  const std::string time = left < 0.0 ? "" : duration_text(left) + " left";
  return fmt::format("{} {:3.0f} %  {}  {}/{} done{}", bar, 100.0 * fraction, time, done, runs_.size(), names);
}

void Progress::draw() {
  if (style_ != Style::bar) return;
  drawn_ = Clock::now();
  say("\r\033[K{}", cut(bar_text(), terminal_width() - 1));
  std::fflush(stdout);
}

}  // namespace glisson::app
