// SPDX-License-Identifier: Apache-2.0
// Measures one LF image for the judgement what its alpha means. Internal to this folder.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "lf/light_field/model/channel_use.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// A pixel is transparent if its alpha is at most 1/64 (4 of 255), because lossy files keep no exact
// 0. It is an inner pixel if, besides, all pixels around it are transparent, up to a distance of
// 1/128 of the image's width, but 2 to 8 pixels: filters that resample images, and renderers,
// change colours near outlines. If hardly any pixel is inner, all transparent pixels take their
// place.
struct AlphaFacts {
  std::string image_name;
  int width = 0;
  std::vector<bool> is_transparent;  // row by row
  size_t transparent_count = 0;
  bool opaque_spans_image = false;  // opaque pixels reach two opposite sides of the image
  double opaque_share = 0;          // share of all pixels

  bool has_inner = true;   // false: all transparent pixels stand for the inner ones
  size_t inner_count = 0;  // number of inner pixels
  // Share of the inner pixels whose colour is at most 3/255 of white away from the median colour of
  // them all.
  double one_colour_share = 0;
  // Share of the pairs of neighbouring inner pixels that differ by more than that: much in
  // photographs, little in colours that a program has invented.
  double detail_share = 0;
  std::array<double, 3> background = {};  // radiance of the median colour

  bool is_float = false;
  // Number of pixels with an alpha between 0.15 and 0.7.
  size_t half_count = 0;
  // Number of them that have opaque pixels near them, and the share of these pixels whose light is
  // nearer to alpha times the light of the opaque ones than to this light itself. Pixels that are
  // much darker than either do not count: they show another surface, such as a shadow, and black
  // remains black if it is multiplied.
  size_t edge_count = 0;
  double multiplied_share = 0;
};

// Measures an image that has alpha. The result has no image_name.
AlphaFacts MeasureAlpha(const RadianceEncoding& encoding, const StoredImage& image,
                        const ChannelUse& use);

}  // namespace lf
