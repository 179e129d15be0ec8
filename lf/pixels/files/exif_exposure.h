// SPDX-License-Identifier: Apache-2.0
// The exposure in the Exif data of a file, read without a decoder. Internal to this folder.
#pragma once

#include "lf/pixels/files/exposure_facts.h"
#include "lf/pixels/files/image_probe.h"

namespace lf {

// Returns the exposure that the Exif data of a file of this format state; no value for other
// formats than JPEG, TIFF and PNG. ExposureTime and FNumber take precedence over the equivalent
// APEX values (ShutterSpeedValue, ApertureValue). If the sensitivity is missing, or at the limit of
// its 16 bits, RecommendedExposureIndex or ISOSpeed replaces it.
ExposureFacts ExposureOfExif(const ByteSource& source, ImageFormat format);

}  // namespace lf
