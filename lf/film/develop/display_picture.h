// SPDX-License-Identifier: Apache-2.0
// Makes a picture for display of the pixels of a frame's file. Internal to this folder.
#pragma once

#include <cstdint>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// Returns the first three channels, composited over black, as 8-bit sRGB [height][width][3].
//   stored  floats: linear light in Rec. 709, multiplied by alpha. Integers: sRGB display values,
//           not multiplied by alpha
//   name    name of the file, for messages
// kInput: there are fewer than three channels.
Result<Image<uint8_t>> DisplayPicture(const StoredImage& stored, const std::string& name);

}  // namespace lf
