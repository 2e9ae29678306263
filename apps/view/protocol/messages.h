// messages.h — what the server tells a page, as bytes: view/wire/messages.toml describes them.
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "view/state/recording.h"
#include "view/state/snapshot.h"
#include "view/state/source.h"
#include "view/state/surface.h"

namespace glisson::view {

/// The skin at rest. @param number  that frames refer to
std::string keyframe_message(const Surface& surface, std::uint32_t number);
/// One instant, without colours. @param keyframe  number of the keyframe it is to be read with
std::string frame_message(const Snapshot& state, const Surface& surface, std::uint32_t keyframe);
/// The same with the field that gives colours. @param values  of it, per surface vertex
std::string with_field(std::string frame, Field field, const std::vector<double>& values);
/// Forces of the frames `from` … `end` of a history, 4000 at most.
std::string samples_message(const std::deque<ForceSample>& history, std::size_t from, std::size_t tools);

/// What a page has to know of the scene, as JSON.
struct SceneFacts {
  std::string title, variant, version;
  std::string instruments;   ///< JSON list of instrument_form_json
  RecordingWriter recorder;  ///< none: nothing is recorded
};
std::string hello_message(const Source& source, const SceneFacts& facts, const std::string& session);
std::string role_message(bool drives, bool led, std::size_t viewers);
/// @param pieces  that the body is in
std::string state_message(const Snapshot& state, std::size_t pieces);
std::string notice_message(const std::string& text);

}  // namespace glisson::view
