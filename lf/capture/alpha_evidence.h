// Finds out whether the alpha of LF images is a mask or light, if the calibration does not say it.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "lf/capture/light_field.h"

namespace lf {

struct AlphaEvidence {
  AlphaMeaning meaning = AlphaMeaning::kMask;
  std::array<double, 3> background = {0, 0, 0};  // not of a mask; as RadianceEncoding::background
  std::string image_name;                        // of the LF image that tells
};

// Looks at the pixels of three LF images with an alpha channel, from the first, the middle and the
// last on:
// - They are of an object alone where, in each, all fully transparent pixels have one and the same
//   colour. Alpha is light, and that colour is the background. Alpha is premultiplied where files
//   hold floats and that colour is black, as renderers write them; else straight.
// - Else alpha is a mask: there is a picture beneath the transparent pixels, or the same pixels are
//   transparent in all (to 2 % of them), as the borders of undistorted photographs are.
// None: the images have no alpha, or nothing is transparent. Files that cannot be read are passed
// over.
std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field);

}  // namespace lf
