// SPDX-License-Identifier: Apache-2.0
// Pixels in memory: [height][width][channels], with `stride` values from one row to the next.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "lf/core/check.h"
#include "lf/core/large_vector.h"

namespace lf {

// Shows the pixels of an Image, or of any other memory, but does not own them. A view may be
// copied, but must not outlive the pixels.
template <class T>
struct ImageView {
  T* data = nullptr;
  int width = 0;
  int height = 0;
  int channels = 1;
  size_t stride = 0;  // number of values from one row to the next

  T* row(int y) const {
    LF_DCHECK(y >= 0 && y < height);
    return data + static_cast<size_t>(y) * stride;
  }
  T& at(int x, int y, int channel = 0) const {
    LF_DCHECK(x >= 0 && x < width && channel >= 0 && channel < channels);
    return row(y)[static_cast<size_t>(x) * channels + channel];
  }
  bool empty() const { return width == 0 || height == 0; }
  operator ImageView<const T>() const  // NOLINT: implicit, as T* converts to const T*
      requires(!std::is_const_v<T>) {
    return {data, width, height, channels, stride};
  }
};

// Owns its pixels. The pixel at x = 0, y = 0 is the upper left one.
template <class T>
class Image {
 public:
  Image() = default;
  Image(int width, int height, int channels = 1, T fill = T{})
      : width_(width), height_(height), channels_(channels) {
    LF_CHECK(width >= 0 && height >= 0 && channels >= 1);
    pixels_.assign(static_cast<size_t>(width) * height * channels, fill);
  }

  // Changes the size, in the same memory if that is large enough. If the image has no more values
  // than before, it keeps the first ones in their order in memory; otherwise all are unspecified.
  void Resize(int width, int height, int channels) {
    LF_CHECK(width >= 0 && height >= 0 && channels >= 1);
    const size_t count = static_cast<size_t>(width) * height * channels;
    if (count > pixels_.capacity()) {
      // A vector that grows by itself would copy the old pixels. The room beyond `count` avoids
      // that the memory is replaced again for an image that is a little larger.
      const size_t room = std::max(count, pixels_.capacity() + pixels_.capacity() / 2);
      pixels_.clear();
      pixels_.reserve(room);
    }
    pixels_.resize(count);
    width_ = width;
    height_ = height;
    channels_ = channels;
  }

  int width() const { return width_; }
  int height() const { return height_; }
  int channels() const { return channels_; }
  bool empty() const { return pixels_.empty(); }
  size_t size_bytes() const { return pixels_.size() * sizeof(T); }
  const LargeVector<T>& pixels() const { return pixels_; }
  LargeVector<T>& pixels() { return pixels_; }

  ImageView<T> view() {
    return {pixels_.data(), width_, height_, channels_, static_cast<size_t>(width_) * channels_};
  }
  ImageView<const T> view() const {
    return {pixels_.data(), width_, height_, channels_, static_cast<size_t>(width_) * channels_};
  }
  T* row(int y) { return view().row(y); }
  const T* row(int y) const { return view().row(y); }
  T& at(int x, int y, int channel = 0) { return view().at(x, y, channel); }
  const T& at(int x, int y, int channel = 0) const { return view().at(x, y, channel); }

 private:
  int width_ = 0;
  int height_ = 0;
  int channels_ = 1;
  LargeVector<T> pixels_;
};

// Colour filter of a mosaic sensor. A name lists the channels of the upper left 2 x 2 pixels, row
// by row. kNone: there is no filter, and every pixel has all channels.
enum class BayerPattern : uint8_t { kNone, kRggb, kBggr, kGrbg, kGbrg };

// Returns the channel (0 R, 1 G, 2 B) that a mosaic records at pixel (x, y). Must not be called for
// kNone.
inline int BayerChannel(BayerPattern pattern, int x, int y) {
  constexpr uint8_t kChannels[5][4] = {
      {0, 0, 0, 0}, {0, 1, 1, 2}, {2, 1, 1, 0}, {1, 0, 2, 1}, {1, 2, 0, 1}};
  return kChannels[static_cast<int>(pattern)][(y & 1) * 2 + (x & 1)];
}

}  // namespace lf
