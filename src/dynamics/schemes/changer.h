// changer.h — what is done to a body between two steps: tets removed, faces split, tissues exchanged.
//
//   change the body state ─▶ let the integrator follow ─▶ book the energy that came or went
#pragma once

#include <array>
#include <span>
#include <vector>

#include "dynamics/schemes/scheme.h"

namespace glisson {

class Changer {
 public:
  explicit Changer(Scheme& scheme) : scheme_(scheme), state_(scheme.state_), ledger_(scheme.ledger_) {}

  struct Split {
    SplitReport report;
    std::vector<std::uint32_t> changed;  ///< elements that got other vertices
  };

  /// As Simulation's. @throws std::invalid_argument; nothing has changed then
  RemovalReport remove(std::span<const std::uint32_t> tets);
  Split split(std::span<const Triangle> faces, std::span<const VertexMove> moves);
  /// Gives blocks of the body other tissues. @return whether masses have changed
  /// @throws std::invalid_argument for what the scheme or its step does not support; nothing has changed then
  bool set_tissues(const BlockTissues& tissues);

 private:
  void weigh(std::span<const std::uint32_t> elements, RemovalReport& report);
  void carry(const BodyChange& change);
  void follow_with_loads();
  void move_bases(std::span<const MovedVertex> moved);
  void hold_copies(std::span<const std::uint32_t> origins);
  void put_tissues(const BlockTissues& to);
  std::array<double, 2> energy_of(std::span<const std::uint32_t> elements) const;
  std::array<double, 2> energy_of_blocks(std::span<const std::size_t> blocks,
                                         std::span<const BranchMemory> memory) const;

  Scheme& scheme_;
  BodyState& state_;
  EnergyLedger& ledger_;
};

}  // namespace glisson
