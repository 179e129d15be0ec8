// SPDX-License-Identifier: Apache-2.0
// Reads the picture of a lens's transmission from an image file.
#pragma once

#include <filesystem>

#include "lf/camera/path/path_yaml.h"
#include "lf/camera/transmission.h"
#include "lf/core/result.h"

namespace lf {

// Returns the transmission of a picture file: the mean of R, G and B (or grey) times alpha, without
// a transfer function, so that half the value lets half the light through. Floating-point values
// are limited to 0 to 1.
// kInput: the file cannot be read, has more than 4 channels or 2^24 pixels, or is wholly dark.
Result<Transmission> ReadTransmissionFile(const std::filesystem::path& file);

// Returns a function that reads pictures whose names are relative to the folder of this camera
// path.
ReadTransmission PicturesBeside(const std::filesystem::path& camera_path);

}  // namespace lf
