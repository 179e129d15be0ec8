// SPDX-License-Identifier: Apache-2.0
// Corrects RGB pixels that were made from a mosaic, for the mean of many LF images.
//
// A demosaicked value is a guess from the surroundings, and guesses have a bias: fine detail of a
// colour is lost where the colour was not recorded. In the mean over many LF images, noise and
// aliasing average out, but the bias stays. A correction exchanges the one for the other. It is a
// linear filter of 5 x 5 pixels, for each colour C and each place in the pattern of the mosaic:
//   V = D + sum_k w_k sum_q (D(q) - D) / 2^12, rounded half up
// D is the demosaicked value of the pixel, and D(q) those of the pixels at the distances (dx, dy)
// of group k (kGroups). Pixels that recorded C are made to stand out of their surroundings, and
// contribute more to those beside them. A constant picture does not change.
//
// The weights minimise
//   (1 - s) E|mean of V over the four places of the pattern - truth|^2 + s mean of E|V - truth|^2
// over LF images of one scene of lfsynth, the ground truth and a rendered shop
// (bench/mosaic_correction.cc makes them). s is the share of the second error that is left in an
// element: 1 if it has the ray of one LF image, or if all its rays come from the same place in the
// pattern, and about 1 / N if it has N rays from random places. kShares has the s of each strength;
// MosaicShareOf() of render/collect/mosaic_share.h finds the s of a frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/light_field/model/lf_pixels.h"

namespace lf {

inline constexpr int kStrongestCorrection = 4;

struct MosaicCorrection {
  // Shares s of the strengths 1, 2, ...
  static constexpr std::array<double, kStrongestCorrection> kShares = {0.3, 0.1, 0.03, 0.01};

  static constexpr int kReach_px = 2;
  static constexpr int kBits = 12;
  static constexpr int kGroupCount = 8;
  // |dx| and |dy| of the pixels of a group.
  static constexpr int kGroups[kGroupCount][2] = {{1, 0}, {2, 0}, {0, 1}, {1, 1},
                                                  {2, 1}, {0, 2}, {1, 2}, {2, 2}};
  using Weights = std::array<int16_t, kGroupCount>;
};

// The weights of the lanes of 4 pixels of a row, in which every second pixel has the same ones:
// [group][lane]. The lanes of rays have the weight 0.
using LaneWeights = std::array<std::array<int32_t, 16>, MosaicCorrection::kGroupCount>;

// Returns the weights w_k of colour `channel` of pixel (x, y) of an LF image whose mosaic had the
// pattern `recorded`, which is not kNone.
//   strength  1 to kStrongestCorrection
MosaicCorrection::Weights CorrectionWeights(int strength, BayerPattern recorded, int x, int y,
                                            int channel);

// Computes corrected pixels (LfPixels::recorded must not be kNone), row by row.
class MosaicCorrector {
 public:
  //   strength  1 to kStrongestCorrection
  //   pixels    RGB; must outlive the object
  MosaicCorrector(int strength, const LfPixels& pixels);

  // Returns row `y` of the corrected pixels, [width][LfPixels::kRgbLanes], until the next call. The
  // rows must be asked for in ascending order, one by one. Rows of `pixels` up to y + kReach_px
  // must be complete; those before y + kReach_px may have changed since the call for row y - 1.
  //
  // Pixels that are masked or not in `pixels` count as the pixel itself. A masked pixel stays
  // masked.
  const uint16_t* Row(int y);

 private:
  uint16_t* KeptRow(int y);  // returns the copy of a row, at its first pixel
  void CorrectWholeRow(int y);
  bool AnyMaskedAround(int x, int y);
  void CorrectPixel(int x, int y);

  const LfPixels& pixels_;
  std::array<std::array<MosaicCorrection::Weights, 3>, 2> weights_[2];  // [y % 2][x % 2][channel]
  std::array<LaneWeights, 2> lane_weights_;                             // [y % 2]
  size_t row_values_;           // number of values of a copied row, with columns beyond both ends
  int kept_ = 0;                // number of rows that were copied
  std::vector<uint16_t> rows_;  // a ring of the last copied rows
  std::vector<int32_t> sums_;   // of a block: AddRows()
  std::vector<uint16_t> corrected_;
};

// Computes the value of one colour of a pixel, literally.
//   column, row  of `pixels`; the pixel must not be masked
uint16_t CorrectedReference(int strength, const LfPixels& pixels, int column, int row, int channel);

}  // namespace lf
