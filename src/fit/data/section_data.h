// section_data.h — [[data]] of FIT.toml: measured curves.
#pragma once

#include "fit/data/data_spec.h"
#include "scene/parse/schema.h"

namespace glisson::fit {

const scene::SectionSpec& column_section();    ///< fills ColumnSpec
const scene::SectionSpec& columns_section();   ///< fills ColumnsSpec
const scene::SectionSpec& text_section();      ///< fills TextSpec
const scene::SectionSpec& contact_section();   ///< fills ContactSpec
const scene::SectionSpec& indenter_section();  ///< fills Indenter
const scene::SectionSpec& crop_section();      ///< fills CropSpec
const scene::SectionSpec& cycle_section();     ///< fills CycleSpec
const scene::SectionSpec& filter_section();    ///< fills FilterSpec
const scene::SectionSpec& resample_section();  ///< fills ResampleSpec
const scene::SectionSpec& data_section();      ///< fills DataSpec

}  // namespace glisson::fit
