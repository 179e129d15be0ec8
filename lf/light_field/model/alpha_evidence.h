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
// lies beneath them, or if the same pixels are transparent in all of several images (up to 2 % of
// them may differ), like the borders of undistorted photographs.
//
// Otherwise alpha is an opacity: in each image, all fully transparent pixels have one colour,
// because the images show an object alone, and that colour is the background. Alpha is
// premultiplied if the files hold floats and the colour is black, as renderers write them;
// otherwise it is straight.
//
// Returns nullopt if the images have no alpha or no transparent pixel. If a file cannot be read,
// the first readable one of the four LF images after it is examined instead.
std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field);

}  // namespace lf
