// source.h — what the server shows: a body that is simulated (engine.h), or one that was recorded (replay.h).
//
// A source runs in a thread of its own and never waits for who watches.
#pragma once

#include <string>
#include <vector>

#include "view/state/command.h"
#include "view/state/snapshot.h"

namespace glisson::view {

/// What there is of a recorded run.
struct Recorded {
  double start = 0.0, end = 0.0;  ///< times of the first and the last frame [s]
  std::size_t frames = 0;
};

class Source {
 public:
  virtual ~Source() = default;
  virtual void start() = 0;
  virtual void stop() = 0;

  // Of the one thread that watches.
  /// @return false where too many wait already
  virtual bool post(const Command& command) = 0;
  /// The newest state, valid until the next call; null where there is none since the last.
  virtual const Snapshot* latest() = 0;
  virtual bool next_sample(ForceSample& sample) = 0;
  /// Whether somebody looks. The clock is held while nobody does, and the source's thread sleeps.
  virtual void set_watched(bool) {}
  /// Whether states are to hold what the stress follows from, and the contact pressure.
  virtual void want_fields(bool /*stress*/, bool /*contact*/) {}

  // Known from the start, and the same after every reset.
  virtual const std::vector<ToolInfo>& tools() const = 0;
  virtual const std::vector<ParameterInfo>& parameters() const = 0;
  /// What instruments look like, a JSON list as web/src/report_data.ts has it.
  virtual const std::string& forms() const = 0;
  /// Of the container, as web/src/report_data.ts has it, in JSON; empty: there is none.
  virtual std::string vessel() const { return {}; }
  virtual bool can_grab() const = 0;
  /// Empty where a hand's blade cuts the body.
  virtual const std::string& why_no_cut() const = 0;
  /// Whether states have what stress and contact pressure follow from.
  virtual bool has_stress() const = 0;
  virtual std::size_t vertices() const = 0;
  virtual std::size_t tets() const = 0;
  /// Null of a body that is simulated.
  virtual const Recorded* recorded() const { return nullptr; }
};

}  // namespace glisson::view
