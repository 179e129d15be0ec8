// SPDX-License-Identifier: Apache-2.0
// The lf_* keys of transforms.json that say how stored numbers become light. Internal to this
// folder.
#pragma once

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/light_field/model/raw_encoding.h"
#include "lf/light_field/transforms_json/json_fields.h"

namespace lf {

// All lf_* keys of the top level, and all of a frame (doc/formats/transforms_json.md).
inline constexpr const char* kTopLevelLfKeys[] = {"lf_bayer",
                                                  "lf_transfer",
                                                  "lf_response",
                                                  "lf_black_level",
                                                  "lf_white_level",
                                                  "lf_white_balance",
                                                  "lf_camera_to_srgb",
                                                  "lf_max_radiance",
                                                  "lf_pedestal",
                                                  "lf_unit_m",
                                                  "lf_depth_range",
                                                  "lf_skew",
                                                  "lf_fov_omega",
                                                  "lf_alpha",
                                                  "lf_background",
                                                  "lf_clipped",
                                                  "lf_pixels",
                                                  "lf_written_by",
                                                  "lf_eucm_alpha",
                                                  "lf_eucm_beta",
                                                  "lf_sx1",
                                                  "lf_sy1",
                                                  "lf_p0",
                                                  "lf_p1",
                                                  "lf_s0",
                                                  "lf_s1",
                                                  "lf_s2",
                                                  "lf_s3",
                                                  "lf_vignetting"};
inline constexpr const char* kFrameLfKeys[] = {
    "lf_gain",      "lf_mask", "lf_translation", "lf_skew",      "lf_fov_omega", "lf_eucm_alpha",
    "lf_eucm_beta", "lf_sx1",  "lf_sy1",         "lf_p0",        "lf_p1",        "lf_s0",
    "lf_s1",        "lf_s2",   "lf_s3",          "lf_vignetting"};

// Reads the keys of the top level. If lf_bayer, lf_black_level, lf_white_level, lf_white_balance or
// lf_camera_to_srgb is missing and the first image is a camera raw file, `raw_facts` reads the
// missing values from this image, unless `raw_facts` is empty; the default transfer is then linear.
// Other defaults: sRGB without a Bayer pattern, linear with a pattern; pedestal 1024 if the black
// level is above 0, otherwise 0; max_radiance from DefaultMaxRadiance() or BrightestWhite(), which
// is larger, but at most kFloatMaxRadiance: no gain clips light, and black to white still has 4096
// steps. If more would be needed, a warning tells what to state.
//   light_field  its encoding is not used
Result<RadianceEncoding> ReadEncoding(const JsonFields& top, const LightField& light_field,
                                      const RawFactsSource& raw_facts);

}  // namespace lf
