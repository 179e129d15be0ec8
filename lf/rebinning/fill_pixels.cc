// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/fill_pixels.h"

#include <algorithm>

#include "lf/core/check.h"

namespace lf {
namespace {

struct Level {
  Image<float> values;  // means of the known pixels
  Image<float> weight;  // 1: known, 0: not
};

// Returns the level of half the width and height, rounded up.
Level Reduced(const Image<float>& values, const Image<float>& weight) {
  const int width = (values.width() + 1) / 2, height = (values.height() + 1) / 2;
  const int channels = values.channels();
  Level level{Image<float>(width, height, channels), Image<float>(width, height)};
  for (int y = 0; y < values.height(); ++y)
    for (int x = 0; x < values.width(); ++x) {
      const float w = weight.at(x, y);
      if (w == 0) continue;
      level.weight.at(x / 2, y / 2) += w;
      const float* const from = values.row(y) + static_cast<size_t>(x) * channels;
      float* const to = level.values.row(y / 2) + static_cast<size_t>(x / 2) * channels;
      for (int c = 0; c < channels; ++c) to[c] += w * from[c];
    }
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float& w = level.weight.at(x, y);
      if (w == 0) continue;
      float* const to = level.values.row(y) + static_cast<size_t>(x) * channels;
      for (int c = 0; c < channels; ++c) to[c] /= w;
      w = std::min(w, 1.0F);
    }
  return level;
}

// A place between two reduced pixels: the index of the first, and the part of the second.
struct Between {
  int first;
  int second;
  float part;
};
Between PlaceIn(int reduced_size, int place) {
  const int first = (place + 1) / 2 - 1;
  return {std::max(first, 0), std::min(first + 1, reduced_size - 1),
          place % 2 == 0 ? 0.75F : 0.25F};
}

// Gives each unknown pixel the value of the reduced picture.
void TakeFrom(const Image<float>& reduced, const Image<float>& weight, Image<float>* values) {
  const int channels = values->channels();
  for (int y = 0; y < values->height(); ++y) {
    const Between down = PlaceIn(reduced.height(), y);
    const float* const above = reduced.row(down.first);
    const float* const below = reduced.row(down.second);
    for (int x = 0; x < values->width(); ++x) {
      const float w = weight.at(x, y);
      if (w > 0) continue;
      const Between across = PlaceIn(reduced.width(), x);
      const size_t left = static_cast<size_t>(across.first) * channels;
      const size_t right = static_cast<size_t>(across.second) * channels;
      float* const to = values->row(y) + static_cast<size_t>(x) * channels;
      for (int c = 0; c < channels; ++c) {
        const float upper = above[left + c] + across.part * (above[right + c] - above[left + c]);
        const float lower = below[left + c] + across.part * (below[right + c] - below[left + c]);
        to[c] = upper + down.part * (lower - upper);
      }
    }
  }
}

}  // namespace

void FillPixels(Image<float>* values, const Image<float>& weight) {
  LF_CHECK(values->width() == weight.width() && values->height() == weight.height());
  if (std::all_of(weight.pixels().begin(), weight.pixels().end(), [](float w) { return w >= 1; }))
    return;
  if (values->width() == 1 && values->height() == 1) {
    if (weight.at(0, 0) == 0) std::fill(values->pixels().begin(), values->pixels().end(), 0.0F);
    return;
  }
  Level reduced = Reduced(*values, weight);
  FillPixels(&reduced.values, reduced.weight);
  TakeFrom(reduced.values, weight, values);
}

}  // namespace lf
