// instrument_json.h — an instrument as the report page draws it: its form once, its place in every frame.
#pragma once

#include <nlohmann/json.hpp>
#include <span>

#include "glisson/instruments/container.h"
#include "glisson/instruments/instrument.h"

namespace glisson {

/// InstrumentForm of web/src/report_data.ts.
nlohmann::json instrument_form_json(const Instrument& instrument);

using InstrumentList = std::vector<std::shared_ptr<Instrument>>;

/// Forms of all that are drawn, and their places in the same order.
nlohmann::json instrument_forms_json(const InstrumentList& instruments);
nlohmann::json instrument_places_json(const InstrumentList& instruments);

/// InstrumentPlace of web/src/report_data.ts: the centre line of a needle as it is bent, the pose of a shape.
nlohmann::json instrument_place_json(const Instrument& instrument);

/// The height at which a wall without end is drawn: 1.15 times that of the body above the floor [m]; 0 without a body.
double drawn_wall_height(const Vec3d& floor, const Vec3d& up, std::span<const Vec3d> vertices);

/// VesselForm of web/src/report_data.ts; a wall without end is drawn somewhat higher than the body at rest.
nlohmann::json vessel_json(const ContainerOptions& container, std::span<const Vec3d> vertices);

}  // namespace glisson
