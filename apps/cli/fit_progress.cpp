#include "cli/fit_progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "cli/progress.h"
#include "fit/data/units.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr std::chrono::seconds kLineEvery{2};  // in a pipe

}  // namespace

FitProgressLine::FitProgressLine(bool quiet) : quiet_(quiet), live_(isatty(STDOUT_FILENO) != 0) {}

std::string FitProgressLine::text(const fit::FitProgress& p) const {
  std::string line = p.law.empty() ? "" : p.law + ": ";
  line += fmt::format("{} {}/{}", p.stage, p.done, p.planned);
  if (p.best_rms > 0.0) line += ", best " + fit::measured_text(p.best_rms, p.unit, 4) + " rms";
  if (p.found > 0) line += fmt::format(" found {} time{}", p.found, p.found == 1 ? "" : "s");
  line += fmt::format(", {} forward runs", p.forward_runs);
  const double spent = std::chrono::duration<double>(Clock::now() - begin_).count();
  if (p.done > first_ && p.done < p.planned) {
    const auto made = static_cast<double>(p.done - first_), left = static_cast<double>(p.planned - p.done);
    line += ", " + duration_text(spent * left / made) + " left";
  }
  return line;
}

void FitProgressLine::show(const fit::FitProgress& p) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  const std::string stage = p.law + p.stage;
  const bool new_stage = stage != stage_;
  if (new_stage) {
    stage_ = stage;
    first_ = p.done;
    begin_ = Clock::now();
  }
  const bool due = new_stage || p.done == p.planned || Clock::now() - said_ >= kLineEvery;
  if (!live_ && !due) return;
  said_ = Clock::now();
  say("{}{}{}", live_ ? "\r\033[K" : "", text(p), live_ ? "" : "\n");
  std::fflush(stdout);
}

void FitProgressLine::show(const fit::FitForecast& f, int threads) {
  if (quiet_ || !(f.run_s > 0.0)) return;
  const std::lock_guard lock(mutex_);
  const auto duration = [&](std::uint64_t runs) {
    return duration_text(static_cast<double>(runs) * f.run_s / static_cast<double>(threads));
  };
  say("{}{}: forward model {}, {:.2g} s a run and core: {} to {} runs, about {} to {} on {} thread{}\n",
      live_ ? "\r\033[K" : "", f.law, f.forward, f.run_s, f.least_runs, f.most_runs, duration(f.least_runs),
      duration(f.most_runs), threads, threads == 1 ? "" : "s");
  std::fflush(stdout);
}

void FitProgressLine::clear() {
  if (quiet_ || !live_) return;
  say("\r\033[K");
  std::fflush(stdout);
}

}  // namespace glisson::app
