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
  bool is_sure = true;                           // false: `meaning` is the less harmful guess
  std::string reason;  // the shares of pixels that decided, as a sentence without a full stop
};

// Examines the pixels of up to three LF images with an alpha channel, from the beginning, the
// middle and the end of the light field. Images without transparent pixels are ignored. Each
// judgement rests on shares of the pixels (alpha_facts.h), because resampling, renderers and lossy
// files change some colours.
//
// Alpha is a mask if two or more images have the same transparent pixels (98 %) and their opaque
// pixels reach from side to side or cover 60 %, like the borders of undistorted photographs; or if,
// in one image, less than 85 % of the inner transparent pixels have about one colour, because a
// picture lies beneath them.
//
// Otherwise alpha is an opacity, because the images show an object alone. The background is the
// colour of the transparent pixels of the first image. Over black, alpha is premultiplied if
// colours grow darker with it at 70 % of the half-transparent pixels, and straight if they do at
// less than 30 %. If there are few such pixels, it is premultiplied for float files, as renderers
// write them, and straight for others. Over another colour it is straight.
//
// The judgement is not sure if a share lies between these limits, if the picture beneath has no
// detail or is seen near outlines alone, if all images have the same transparent pixels and their
// opaque pixels do not reach from side to side, or if half-transparent pixels lie beside too few
// opaque ones. It is not sure, and takes a mask unless the files hold floats, if at least 60 % of
// each image are opaque: such an image is either a photograph of which parts are masked, or an
// object that fills it.
//
// Returns nullopt if no examined image has an alpha channel and a transparent pixel. If the header
// of a file cannot be read, the next LF image with a readable header is examined instead, if it is
// among the next four.
std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field);

}  // namespace lf
