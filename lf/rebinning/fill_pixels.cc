// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/fill_pixels.h"

#include <algorithm>

#include "lf/core/check.h"
#include "lf/rebinning/fill_rows.h"

namespace lf {
namespace {

// Number of times that an unknown pixel takes the mean of its neighbours, in each reduced picture.
// Twice as many change frames by less than 0.1 dB, except for less light beside lamps.
constexpr int kSweeps = 8;

int Half(int size) { return (size + 1) / 2; }

// Sums of 2 x 2 pixels, each multiplied by its weight.
Image<float> Sums(const Image<float>& plane, const Image<float>& weight) {
  Image<float> sums(Half(plane.width()), Half(plane.height()));
  const int pairs = plane.width() / 2;
  for (int y = 0; y < plane.height(); ++y) {
    const float* __restrict const from = plane.row(y);
    const float* __restrict const w = weight.row(y);
    float* __restrict const to = sums.row(y / 2);
    for (int x = 0; x < pairs; ++x)
      to[x] += from[2 * x] * w[2 * x] + from[2 * x + 1] * w[2 * x + 1];
    if (plane.width() % 2 != 0) to[pairs] += from[2 * pairs] * w[2 * pairs];
  }
  return sums;
}

// Returns the means of the known pixels of 2 x 2.
//   counts  numbers of the known pixels
Image<float> Means(const Image<float>& plane, const Image<float>& weight,
                   const Image<float>& counts) {
  Image<float> means = Sums(plane, weight);
  for (size_t i = 0; i < means.pixels().size(); ++i)
    means.pixels()[i] /= std::max(counts.pixels()[i], 1.0F);
  return means;
}

// Gives each unknown pixel of a row its value between reduced pixels. The two values are mixed by
// products, because compilers do not vectorize a choice between them.
//   between  [Half(width) + 2], a row of reduced pixels between two more
void TakeRow(const float* __restrict between, const float* __restrict weight, int width,
             float* __restrict to) {
  const int pairs = width / 2;
  for (int i = 0; i < pairs; ++i) {
    const float even = 0.25F * between[i] + 0.75F * between[i + 1];
    const float odd = 0.75F * between[i + 1] + 0.25F * between[i + 2];
    const float even_weight = weight[2 * i], odd_weight = weight[2 * i + 1];
    to[2 * i] = even_weight * to[2 * i] + (1 - even_weight) * even;
    to[2 * i + 1] = odd_weight * to[2 * i + 1] + (1 - odd_weight) * odd;
  }
  if (width % 2 != 0 && weight[width - 1] == 0)
    to[width - 1] = 0.25F * between[pairs] + 0.75F * between[pairs + 1];
}

// Gives each unknown pixel the value of the reduced picture.
void TakeFrom(const Image<float>& reduced, const Image<float>& weight, Image<float>* plane) {
  std::vector<float> between(static_cast<size_t>(reduced.width()) + 2);  // with both borders
  for (int y = 0; y < plane->height(); ++y) {
    const float* const near = reduced.row(y / 2);
    const float* const far =
        reduced.row(std::clamp(y / 2 + (y % 2 == 0 ? -1 : 1), 0, reduced.height() - 1));
    for (int x = 0; x < reduced.width(); ++x)
      between[static_cast<size_t>(x) + 1] = 0.75F * near[x] + 0.25F * far[x];
    between.front() = between[1];
    between.back() = between[between.size() - 2];
    TakeRow(between.data(), weight.row(y), plane->width(), plane->row(y));
  }
}

// Sweeps downwards and upwards in turns, so that values spread far in the direction of the sweep.
void Relax(const Image<float>& weight, Image<float>* plane) {
  const int width = plane->width(), height = plane->height();
  std::vector<float> row(static_cast<size_t>(width) + 2);
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int i = 0; i < height; ++i) {
      const int y = sweep % 2 == 0 ? i : height - 1 - i;
      float* const to = plane->row(y);
      std::copy_n(to, width, row.begin() + 1);
      row.front() = row[1];
      row.back() = row[static_cast<size_t>(width)];
      RelaxRow(plane->row(std::max(y - 1, 0)), plane->row(std::min(y + 1, height - 1)), row.data(),
               weight.row(y), width, to);
    }
}

}  // namespace

void FillPixels(std::vector<Image<float>>* planes, const Image<float>& weight) {
  if (std::all_of(weight.pixels().begin(), weight.pixels().end(), [](float w) { return w > 0; }))
    return;
  if (weight.width() == 1 && weight.height() == 1) {
    for (Image<float>& plane : *planes) plane.at(0, 0) = 0;
    return;
  }
  const Image<float> counts = Sums(weight, weight);
  Image<float> reduced_weight = counts;
  for (float& w : reduced_weight.pixels()) w = std::min(w, 1.0F);
  std::vector<Image<float>> reduced;
  for (const Image<float>& plane : *planes) {
    LF_CHECK(plane.width() == weight.width() && plane.height() == weight.height());
    reduced.push_back(Means(plane, weight, counts));
  }
  FillPixels(&reduced, reduced_weight);
  for (size_t i = 0; i < planes->size(); ++i) {
    TakeFrom(reduced[i], weight, &(*planes)[i]);
    Relax(weight, &(*planes)[i]);
  }
}

}  // namespace lf
