// SPDX-License-Identifier: Apache-2.0
// Loops over the pixels of a row, which the synthesis of virtual LF images spends its time with.
// Internal to this folder.
#pragma once

#include <cstdint>
#include <span>

#include "lf/core/image.h"
#include "lf/densify/pair_map.h"
#include "lf/light_field/model/lf_pixels.h"

namespace lf {

// Projects pixels of a row, whose depths are numbers of a DepthPlane, to another camera.
//   numbers  of the pixels x_begin, x_begin + 1 ...
//   y        row of the pixels
//   first    inverse depth of the number 0; `step` is added for each number
// Writes the position of each pixel, less half a pixel, and its inverse depth in the other camera.
// A pixel behind the camera gets positions below -1.
void ProjectRow(const PairMap& map, const uint16_t* numbers, int x_begin, int y, int count,
                float first, float step, float* u_px, float* v_px, float* depths);

// Positions in one image of points that a row of pixels of another image shows.
inline constexpr int kChunk = 64;        // pixels that are computed at once
inline constexpr int32_t kOutside = -1;  // instead of a pixel
struct SeenPoints {
  alignas(64) float u_px[kChunk], v_px[kChunk];
  alignas(64) float depth[kChunk];    // inverse depth of the point, for the camera of the image
  alignas(64) int32_t pixel[kChunk];  // y * width + x of the pixel around the place, or kOutside
};
// Finds the places of the centres of the pixels x_begin, x_begin + 1 ... of row y.
//   depths  inverse depths of the points
//   width, height  size of the image, less than 2^31 pixels
//   count   at most kChunk
void SeeRow(const PairMap& map, int x_begin, int y, int count, const float* depths, int width,
            int height, SeenPoints* seen);

// Agreement of two inverse depths whose difference is `error` tolerances: 1 if it is 0, 0 from 2
// on. (Tukey's biweight, with its power of a polynomial instead of an exponential function, which
// has other bits on other machines.)
inline float AgreementOf(float error) {
  const float squares = 1 - 0.25f * error * error;
  const float left = squares > 0 ? squares : 0;
  return left * left * left;
}

// Adds the votes of an image with this weight to those for the depths of points. It votes for a
// point with the weight times AgreementOf() of its depth, and against one that it sees through.
//   there   inverse depth that the image has at each place
//   errors  receives `there` less the depth of the point, in tolerances
void AddVotes(const SeenPoints& seen, const float* there, int count, float per_tolerance,
              float weight, float* errors, float* votes);

// Colours of the points of a chunk in an image.
struct PointColours {
  alignas(64) float lanes[kChunk][LfPixels::kRgbLanes];
  bool is_shown[kChunk];  // false: the image does not show the point, and its lanes are unspecified
};
// Interpolates as SampleBicubic() at the places of some points of a chunk.
//   pixels      numbers of these points in the chunk
//   has_masked  false: no pixel of `light` is masked
void SampleRow(const Image<uint16_t>& light, bool has_masked, const SeenPoints& seen,
               std::span<const int> pixels, PointColours* colours);

}  // namespace lf
