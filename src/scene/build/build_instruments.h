// build_instruments.h — instruments and membranes of a variant.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "glisson/scene/scene.h"

namespace glisson::scene {

/// @param mesh  of the body @throws std::invalid_argument for options or regions that do not fit
std::shared_ptr<Instrument> make_instrument(const InstrumentSpec& spec, const TetMesh& mesh);

/// The same before there is a body: without regions, and a palpation moves as make_driver says. For what it says of itself.
std::shared_ptr<Instrument> make_instrument(const InstrumentSpec& spec);

/// The driven set of a tool. @throws std::invalid_argument
std::shared_ptr<Instrument> make_tool(const ToolSpec& spec, std::vector<std::uint32_t> vertices);

/// @param set  vertices it covers; empty: all of the surface @throws std::invalid_argument
std::shared_ptr<Capsule> make_capsule(const CapsuleSpec& spec, std::span<const std::uint32_t> set);

/// A needle that pierces the surface opens the capsules there.
void join(std::span<const std::shared_ptr<Instrument>> instruments,
          const std::vector<std::shared_ptr<Capsule>>& capsules);

}  // namespace glisson::scene
