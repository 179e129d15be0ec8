// Exact second moments of what LF images add to an element, for the standard error of the element's
// mean. They are kept for some elements that are spread over the plate.
//
// Rays of one LF image are similar: they are neighbouring pixels, or several samples of one pixel.
// The independent unit is therefore the LF image. Image i adds the sum S_i and the count W_i to an
// element and channel (film/plate/sensor_plate.h; with lens weights W_i is a sum of weights), and
//
//   m = sum S_i / sum W_i
//   variance of m = n / (n - 1) * sum (S_i - m W_i)^2 / (sum W_i)^2
//
// over the n LF images with W_i > 0: the variance of a ratio estimator (Cochran, Sampling
// Techniques, 1977, Sec. 6.4) in a large population.
//
// Moments are integers, so that they do not depend on the order in which LF images, threads, passes
// or interrupted runs add them. 128 bits always hold them: a plate counts up to 2^44 (doc/formats/
// plate.md) rays of up to 2^16 - 1, so that sum W_i <= 2^44 and sum S_i < 2^60, and a sum of
// products of numbers that are not negative is at most the product of their sums: sum S_i^2 <
// 2^120, sum S_i W_i < 2^104, sum W_i^2 <= 2^88. 64 bits would be too few: 300 rays of weight 255
// that one LF image adds to one element may come to S_i^2 > 2^64.
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

// One element and channel. The sums of S_i and W_i themselves are in the plate.
struct ElementMoments {
  UInt128 sum_squares = 0;    // sum of S_i^2
  UInt128 cross_sum = 0;      // sum of S_i W_i
  UInt128 count_squares = 0;  // sum of W_i^2
  uint32_t image_count = 0;   // n

  friend bool operator==(const ElementMoments&, const ElementMoments&) = default;
};

// Returns the standard error of the mean in units of the rays' values v; infinity if n < 2. It has
// the same bits on every machine.
//   total  sum S_i and sum W_i, from the plate
double StandardErrorOfMean(const ElementSum& total, const ElementMoments& moments);

class NoiseMoments {
 public:
  // Largest numbers of measured columns and rows, whatever the size of the plate.
  static constexpr int kMostColumns = 48;
  static constexpr int kMostRows = 32;
  static constexpr size_t kMostBytes =
      size_t{kMostColumns} * kMostRows * SensorPlate::kChannels * sizeof(ElementMoments);

  // Makes moments without plate and elements.
  NoiseMoments() = default;
  // Measures the elements in the middle of equal rectangles, into which a plate of this size is
  // cut.
  NoiseMoments(int plate_width, int plate_height);

  size_t size() const { return moments_.size() / SensorPlate::kChannels; }
  PlateElement ElementAt(size_t index) const;
  const ElementMoments& At(size_t index, int channel) const {
    return moments_[index * SensorPlate::kChannels + channel];
  }
  // Returns the indices of the elements that lie in `rect`, ascending.
  std::vector<size_t> IndicesIn(const PixelRect& rect) const;

  // Adds what one LF image added to an element, all at once. Threads may add to different elements
  // at the same time.
  void AddImage(size_t index, int channel, const ElementSum& of_image);

  // Returns columns, rows and the four moments of every element and channel as hexadecimal numbers
  // with a space between, at most 420 kB. Read() gets the same moments back.
  std::string Text() const;
  // Returns the moments of a plate from the text that was written for it. kInput if the text is of
  // another plate or damaged: numbers are missing, or cannot be the moments of what the plate
  // holds. The message says what is wrong and where in the text; the caller names the file.
  static Result<NoiseMoments> Read(std::string_view text, const SensorPlate& plate);

  friend bool operator==(const NoiseMoments&, const NoiseMoments&) = default;

 private:
  int plate_width_ = 0;
  int plate_height_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<ElementMoments> moments_;  // [rows][columns][channel]
};

// Finds out what each LF image adds to the measured elements of a rectangle, from their totals
// before and after it. One thread uses it.
class NoiseTally {
 public:
  //   moments  null: nothing is measured, elements() is empty
  NoiseTally(NoiseMoments* moments, const PixelRect& rect);

  std::span<const PlateElement> elements() const { return elements_; }

  // Takes the totals as they are before the first LF image. They are 0 if this is not called.
  //   total_of(i, channel)  gives the ElementSum of elements()[i]
  template <class TotalOf>
  void Start(const TotalOf& total_of) {
    for (size_t i = 0; i < elements_.size(); ++i)
      for (int c = 0; c < SensorPlate::kChannels; ++c) before_[i][c] = total_of(i, c);
  }

  // Adds what came since the last call to the moments, as one LF image.
  template <class TotalOf>
  void TakeImage(const TotalOf& total_of) {
    for (size_t i = 0; i < elements_.size(); ++i)
      for (int c = 0; c < SensorPlate::kChannels; ++c) {
        const ElementSum total = total_of(i, c), before = before_[i][c];
        if (total == before) continue;
        moments_->AddImage(indices_[i], c, {total.sum - before.sum, total.count - before.count});
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
