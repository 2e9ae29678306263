// instrument_json.h — an instrument as the report page draws it: its form once, its place in every frame.
#pragma once

#include <nlohmann/json.hpp>

#include "glisson/instruments/instrument.h"

namespace glisson {

/// InstrumentForm of web/src/report_data.ts.
nlohmann::json instrument_form_json(const Instrument& instrument);

/// InstrumentPlace of web/src/report_data.ts: the centre line of a needle as it is bent, the pose of a shape.
nlohmann::json instrument_place_json(const Instrument& instrument);

}  // namespace glisson
