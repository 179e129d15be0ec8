// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/recorded_values.h"

#include <algorithm>

#include "lf/light_field/model/lf_pixels.h"
#include "lf/storage/load/ordered_half.h"

namespace lf {
namespace {

// Returns, for each radiance, the stored value whose radiance is nearest. `radiance_of` never
// decreases.
std::vector<uint16_t> NearestStored(const std::vector<uint16_t>& radiance_of) {
  std::vector<uint16_t> stored(65536);
  size_t above = 0;  // the first stored value that is not darker
  for (size_t v = 0; v < stored.size(); ++v) {
    while (above < radiance_of.size() && radiance_of[above] < v) ++above;
    const bool is_below_nearer = above == radiance_of.size() ||
                                 (above > 0 && v - radiance_of[above - 1] < radiance_of[above] - v);
    stored[v] = static_cast<uint16_t>(is_below_nearer ? above - 1 : above);
  }
  return stored;
}

std::vector<uint16_t> StoredFloats(const RadianceEncoding& encoding) {
  std::vector<uint16_t> stored(65536);
  for (size_t v = 0; v < stored.size(); ++v)
    stored[v] = OrderedOfFloat(
        static_cast<float>((static_cast<double>(v) - encoding.pedestal) / encoding.Scale()));
  return stored;
}

}  // namespace

RecordedValues::RecordedValues(const RadianceEncoding& encoding, StoredValues values,
                               PixelLayout layout)
    : encoding_(encoding), values_(values), layout_(layout) {
  if (values == StoredValues::kHalf)
    stored_ = StoredFloats(encoding);
  else
    stored_ = NearestStored(RadianceTable(encoding, values == StoredValues::kUint8 ? 8 : 16, 1));
}

RecordedImage RecordedValues::Of(const Image<uint16_t>& light) const {
  const int channels = layout_ == PixelLayout::kRgb ? 3 : 1;
  RecordedImage image;
  image.layout = layout_;
  image.values = values_;
  image.rect = {0, 0, light.width(), light.height()};
  Image<uint16_t> values(light.width(), light.height(), channels);
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x) {
      const uint16_t* pixel = &light.at(x, y);
      if (pixel[LfPixels::kRayLane] == 0) {
        if (image.mask.empty()) image.mask = Image<uint8_t>(light.width(), light.height(), 1, 255);
        image.mask.at(x, y) = 0;
        continue;
      }
      if (layout_ == PixelLayout::kRgb)
        for (int c = 0; c < 3; ++c) values.at(x, y, c) = stored_[pixel[c]];
      else
        values.at(x, y) =
            stored_[pixel[layout_ == PixelLayout::kMosaic ? BayerChannel(encoding_.bayer, x, y)
                                                          : 1]];
    }
  if (values_ == StoredValues::kUint8) {
    Image<uint8_t> bytes(light.width(), light.height(), channels);
    std::transform(values.pixels().begin(), values.pixels().end(), bytes.pixels().begin(),
                   [](uint16_t value) { return static_cast<uint8_t>(value); });
    image.pixels = std::move(bytes);
  } else {
    image.pixels = std::move(values);
  }
  return image;
}

}  // namespace lf
