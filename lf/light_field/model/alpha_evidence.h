// SPDX-License-Identifier: Apache-2.0
// Decides whether the alpha channel of LF images is a mask or an opacity, for calibrations that do
// not state it.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "lf/light_field/model/light_field.h"

namespace lf {

struct AlphaEvidence {
  AlphaMeaning meaning = AlphaMeaning::kMask;
  std::array<double, 3> background = {0, 0, 0};  // RadianceEncoding::background; unused for a mask
  std::string image_name;                        // name of the LF image that decided the meaning
};

// Examines the pixels of up to three LF images with an alpha channel, from the beginning, the
// middle and the end of the light field. Images without fully transparent pixels are ignored.
//
// Alpha is a mask if the transparent pixels of one image have different colours, because a picture
// lies beneath them, or if two or more images remain and all have the same transparent pixels (up
// to 2 % of these may differ), like the borders of undistorted photographs.
//
// Otherwise alpha is an opacity: in each image, all fully transparent pixels have one colour,
// because the images show an object alone. The background is this colour of the first image. Alpha
// is premultiplied if the first image is a float file and its background is black, as renderers
// write them; otherwise it is straight.
//
// Returns nullopt if no examined image has an alpha channel and a fully transparent pixel. If the
// header of a file cannot be read, the next LF image with a readable header is examined instead, if
// it is among the next four.
std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field);

}  // namespace lf
