// Finds out whether the alpha channel of LF images is a mask or light, if the calibration does not
// say it.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "lf/light_field/model/light_field.h"

namespace lf {

struct AlphaEvidence {
  AlphaMeaning meaning = AlphaMeaning::kMask;
  std::array<double, 3> background = {0, 0, 0};  // as in RadianceEncoding; unused for a mask
  std::string image_name;                        // the LF image that decided the meaning
};

// Looks at the pixels of three LF images with an alpha channel, taken from the beginning, the
// middle and the end of the light field.
// - Alpha is light if, in each of the three, all fully transparent pixels have one colour: the
// images
//   then show an object alone, and that colour is its background. Alpha is premultiplied if the
//   files hold floats and the colour is black, as renderers write them; otherwise it is straight.
// - Alpha is a mask if there is a picture beneath the transparent pixels, or if the same pixels are
//   transparent in all three (up to 2 % of them), like the borders of undistorted photographs.
// Returns nullopt if the images have no alpha or no transparent pixel. Files that cannot be read
// are skipped.
std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field);

}  // namespace lf
