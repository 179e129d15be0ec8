// SPDX-License-Identifier: Apache-2.0
// Finds what a pixel of one LF image shows in another one, with the distortion of both lenses.
#pragma once

#include <array>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/densify/pair_map.h"

namespace lf {

// The ideal positions of the pixels of an LF image, which they would have without lens distortion.
struct IdealPositions {
  explicit IdealPositions(const PinholeCamera& camera);

  // [height][width][2]: x, y. Empty without distortion: the positions are the centres of the
  // pixels. NaN if no ray arrives at a pixel.
  Image<float> positions;

  Vec2 At(int x, int y) const {
    if (positions.empty()) return {x + 0.5, y + 0.5};
    return {positions.at(x, y, 0), positions.at(x, y, 1)};
  }
};

class PixelPlaces {
 public:
  PixelPlaces(const PinholeCamera& from, const PinholeCamera& to);

  // A position in the image of `to`, where whole numbers are centres of pixels. NaN if that camera
  // does not see the point.
  struct Place {
    float x = 0, y = 0;
  };
  //   ideal_x, ideal_y  IdealPositions::At() of a pixel of `from`
  //   inverse_depth           along the optical axis of `from`
  Place At(float ideal_x, float ideal_y, float inverse_depth) const;

  // A linear map of small offsets from places to offsets in the image of `from`, of points at one
  // inverse depth around its middle. It is that of the whole image: LF images may be rolled and of
  // different scales, but are hardly warped otherwise.
  struct Offsets {
    std::array<float, 4> m = {1, 0, 0, 1};  // row by row
    float X(float x, float y) const { return m[0] * x + m[1] * y; }
    float Y(float x, float y) const { return m[2] * x + m[3] * y; }
  };
  Offsets OffsetsIn(const IdealPositions& of_from, int width_px, int height_px,
                    float inverse_depth) const;

 private:
  PairMap map_;                            // between the cameras without distortion
  std::optional<DistortionMap> distorts_;  // set if the lens of `to` has distortion
  Intrinsics to_;
};

}  // namespace lf
