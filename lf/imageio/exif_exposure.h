// The exposure in the Exif data of a file, read without a decoder. Internal to this folder.
#pragma once

#include "lf/imageio/exposure_facts.h"
#include "lf/imageio/image_probe.h"

namespace lf {

// Reads the Exif data of a file of this format; nothing is known of camera raw files and EXR.
// ExposureTime, FNumber and the sensitivity go before the APEX values of the same.
ExposureFacts ExposureOfExif(const ByteSource& source, ImageFormat format);

}  // namespace lf
