// progress.h — how far the runs are: one live bar on a terminal, plain lines at 10 % steps in a pipe.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

namespace glisson::app {

/// Safe to call from all runs at once.
class Progress {
 public:
  enum class Style { silent, lines, bar };

  /// Bar where standard output is a terminal, lines where it is not, nothing where quiet.
  static Style style_for(bool quiet);

  /// @param names  of the runs @param workers  how many of them run at a time
  Progress(std::vector<std::string> names, int workers, Style style);

  void started(std::size_t run);
  /// @param fraction  of the run that is done, 0 to 1
  void advanced(std::size_t run, double fraction);
  /// @param how  e.g. "finished"
  void ended(std::size_t run, const std::string& how);
  /// Takes the bar away; the next print starts on a clean line.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  enum class State { waiting, running, done };
  struct Run {
    std::string name;
    State state = State::waiting;
    double fraction = 0.0;
    int said_tenths = 0;
    Clock::time_point start{}, moved{}, said{};  ///< moved: when its fraction was last another one

    double elapsed_s = 0.0;  // where done
  };

  double elapsed(const Run& run) const;
  void say_long_step(Run& run);
  void draw();
  std::string bar_text() const;
  /// Wall time still needed [s] from the pace of the runs so far; negative: not known yet.
  double seconds_left(double& fraction_done) const;

  std::mutex mutex_;
  std::vector<Run> runs_;
  int workers_;
  Style style_;
  Clock::time_point drawn_{};
};

/// "0.4 s", "42 s", "2 min 05 s", "1 h 10 min".
std::string duration_text(double seconds);

}  // namespace glisson::app
