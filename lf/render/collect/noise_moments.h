// SPDX-License-Identifier: Apache-2.0
// Exact second moments of the sums and counts that LF images add to an element. The standard error
// of the element's mean is computed from them. Moments are kept for some elements, spread evenly
// over the plate.
//
// Rays of one LF image are similar: they are neighbouring pixels, or several samples of one pixel.
// The independent unit is therefore the LF image. LF image i adds the sum S_i and the count W_i to
// an element and channel (film/plate/sensor_plate.h; with lens weights W_i is a sum of weights),
// and
//
//   m = sum S_i / sum W_i
//   variance of m = n / (n - 1) * sum (S_i - m W_i)^2 / (sum W_i)^2
//
// where the sums are over the n LF images with W_i > 0. This is the variance of a ratio estimator
// (Cochran, Sampling Techniques, 1977, Sec. 6.4) in a large population.
//
// Moments are integers, so that they do not depend on the order in which LF images, threads, passes
// or interrupted runs add them. 128 bits always suffice: a plate counts up to 2^44 rays
// (doc/formats/plate.md) with values up to 2^16 - 1, so that sum W_i <= 2^44 and sum S_i < 2^60. A
// sum of products of non-negative numbers is at most the product of their sums, so that sum S_i^2 <
// 2^120, sum S_i W_i < 2^104, sum W_i^2 <= 2^88. 64 bits would be too few: if one LF image adds 300
// rays of weight 255 to an element, S_i^2 may exceed 2^64.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/film/plate/tile_grid.h"

namespace lf {

using UInt128 = unsigned __int128;

// Virtual LF images (LfCamera::is_virtual) are not independent, because they were made from
// recorded ones. All sums of the formula are therefore over the recorded LF images alone; the sums
// and counts of virtual ones are kept to be subtracted from those of the plate.

// The moments of one element and channel, to which LF image i adds the sum S_i of its rays' values
// and the count W_i of its rays. The plate has the sums of S_i and W_i over all LF images.
struct ElementMoments {
  UInt128 sum_squares = 0;    // sum over LF images of S_i^2 (S_i: sum of its ray values)
  UInt128 cross_sum = 0;      // sum over LF images of S_i W_i (W_i: count of its rays)
  UInt128 count_squares = 0;  // sum over LF images of W_i^2
  uint32_t image_count = 0;   // number n of LF images with W_i > 0
  ElementSum of_virtual =
      {};  // sum and count of all virtual LF images; the rest is of recorded ones

  friend bool operator==(const ElementMoments&, const ElementMoments&) = default;
};

// Returns the standard error of an element's mean (the root of the variance of m above), in units
// of the rays' values v; infinity if moments.image_count is below 2. The result has the same bits
// on every machine.
//   total  the element's sum and count in the plate: those of all LF images together
double StandardErrorOfMean(const ElementSum& total, const ElementMoments& moments);

class NoiseMoments {
 public:
  // Largest numbers of columns and rows of measured elements.
  static constexpr int kMostColumns = 48;
  static constexpr int kMostRows = 32;
  static constexpr size_t kMostBytes =
      size_t{kMostColumns} * kMostRows * SensorPlate::kChannels * sizeof(ElementMoments);

  // Makes moments that measure no element.
  NoiseMoments() = default;
  // Divides a plate of this size into equal rectangles, and measures the element in the middle of
  // each.
  NoiseMoments(int plate_width, int plate_height);

  size_t size() const { return moments_.size() / SensorPlate::kChannels; }
  PlateElement ElementAt(size_t index) const;
  const ElementMoments& At(size_t index, int channel) const {
    return moments_[index * SensorPlate::kChannels + channel];
  }
  // Returns the indices of the measured elements that lie in `rect`, ascending.
  std::vector<size_t> IndicesIn(const PixelRect& rect) const;

  // Adds the moments of one recorded LF image to an element and channel. Must be called once for
  // each LF image that adds something there, with the total that it adds. Several threads may call
  // it at the same time, for different elements.
  void AddImage(size_t index, int channel, const ElementSum& of_image);
  // Adds the sum and count of one virtual LF image to an element and channel, in the same way.
  void AddVirtual(size_t index, int channel, const ElementSum& of_image);

  // Returns the moments as text, at most 650 kB: hexadecimal numbers separated by one space. The
  // numbers are columns, rows, and the first four members of ElementMoments for every element and
  // channel. If there are virtual LF images, the sum and count of `of_virtual` follow for every
  // element and channel. Read() restores the same moments.
  std::string Text() const;
  // Returns the moments of a plate from the text that Text() returned for it. kInput if the text is
  // damaged or belongs to another plate: numbers are missing, or cannot be moments of the sums and
  // counts in the plate. The message says which number is wrong; the caller adds the name of the
  // file.
  static Result<NoiseMoments> Read(std::string_view text, const SensorPlate& plate);

  friend bool operator==(const NoiseMoments&, const NoiseMoments&) = default;

 private:
  bool HasVirtual() const;  // true if a virtual LF image added something

  int plate_width_ = 0;
  int plate_height_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<ElementMoments> moments_;  // [rows][columns][channel]
};

// Finds what each LF image adds to the measured elements of a rectangle, as the difference of their
// totals before and after the LF image. Only one thread may use an object.
class NoiseTally {
 public:
  //   moments  null: nothing is measured, and elements() is empty
  NoiseTally(NoiseMoments* moments, const PixelRect& rect);

  std::span<const PlateElement> elements() const { return elements_; }

  // Stores the totals before the first LF image. Without this call, they are 0.
  //   total_of(i, channel)  returns the ElementSum of elements()[i]
  template <class TotalOf>
  void Start(const TotalOf& total_of) {
    for (size_t i = 0; i < elements_.size(); ++i)
      for (int c = 0; c < SensorPlate::kChannels; ++c) before_[i][c] = total_of(i, c);
  }

  // Adds to the moments, as one LF image, what the totals have gained since the last call.
  template <class TotalOf>
  void TakeImage(bool is_virtual, const TotalOf& total_of) {
    for (size_t i = 0; i < elements_.size(); ++i)
      for (int c = 0; c < SensorPlate::kChannels; ++c) {
        const ElementSum total = total_of(i, c), before = before_[i][c];
        if (total == before) continue;
        const ElementSum gained = {total.sum - before.sum, total.count - before.count};
        if (is_virtual)
          moments_->AddVirtual(indices_[i], c, gained);
        else
          moments_->AddImage(indices_[i], c, gained);
        before_[i][c] = total;
      }
  }

 private:
  NoiseMoments* moments_;
  std::vector<size_t> indices_;
  std::vector<PlateElement> elements_;
  std::vector<std::array<ElementSum, SensorPlate::kChannels>> before_;
};

}  // namespace lf
