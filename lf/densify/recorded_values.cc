// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/recorded_values.h"

#include <algorithm>
#include <array>

#include "lf/camera/vignetting.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/storage/load/ordered_half.h"

namespace lf {
namespace {

constexpr double kLargestGain = 1e6;  // limit of lf_gain

// Returns, for each radiance, the stored value whose radiance is nearest.
//   light  [stored value]: light before the gain, which never decreases
std::vector<uint16_t> NearestStored(const RadianceEncoding& encoding,
                                    const std::vector<double>& light, double gain) {
  std::vector<uint16_t> radiance_of(light.size());
  std::transform(light.begin(), light.end(), radiance_of.begin(),
                 [&](double x) { return QuantizeRadiance(encoding, x, gain); });
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

std::vector<uint16_t> StoredFloats(const RadianceEncoding& encoding, double gain) {
  std::vector<uint16_t> stored(65536);
  for (size_t v = 0; v < stored.size(); ++v)
    stored[v] = OrderedOfFloat(
        static_cast<float>((static_cast<double>(v) - encoding.pedestal) / encoding.Scale() / gain));
  return stored;
}

// Returns the largest gain that light in the range of 16-bit radiances can require.
double MostUsefulGain(const RadianceEncoding& encoding) {
  const double white =
      encoding.transfer == Transfer::kResponse ? encoding.response.back() : double{1};
  const double below = -LightTable(encoding, 16).front();
  return std::max({1.0, encoding.max_radiance / white,
                   below > 0 ? encoding.pedestal / encoding.Scale() / below : 0});
}

}  // namespace

ChannelGains GainsToHold(const LightField& light_field, std::span<const WeightedPoint> lf_images) {
  std::array<double, 3> most = {};
  for (const WeightedPoint& lf_image : lf_images) {
    const LfCamera& camera = light_field.cameras[lf_image.index];
    const double least_share = FalloffRangeOf(light_field.intrinsics[camera.intrinsics_index]).min;
    for (size_t c = 0; c < most.size(); ++c)
      most[c] = std::max(most[c], camera.gain[c] / least_share);
  }
  const double useful = std::min(kLargestGain, MostUsefulGain(light_field.encoding));
  ChannelGains gains;
  for (size_t c = 0; c < most.size(); ++c) gains[c] = static_cast<float>(std::min(most[c], useful));
  return gains;
}

StoredKind KindToHold(const StoredKind& a, const StoredKind& b) {
  const auto holds_more = [](StoredValues values) {
    return values == StoredValues::kHalf ? 2 : values == StoredValues::kUint8 ? 0 : 1;
  };
  return {holds_more(a.values) >= holds_more(b.values) ? a.values : b.values,
          a.layout == PixelLayout::kGrey ? b.layout : a.layout};
}

RecordedValues::RecordedValues(const RadianceEncoding& encoding, const StoredKind& kind)
    : encoding_(encoding),
      kind_(kind),
      has_opacity_(encoding.AlphaIsLight() && kind.layout != PixelLayout::kMosaic),
      is_straight_(has_opacity_ && *encoding.alpha == AlphaMeaning::kStraight) {
  if (kind.values != StoredValues::kHalf)
    light_ = LightTable(encoding, kind.values == StoredValues::kUint8 ? 8 : 16);
}

std::vector<uint16_t> RecordedValues::StoredOf(double gain) const {
  return light_.empty() ? StoredFloats(encoding_, gain) : NearestStored(encoding_, light_, gain);
}

uint16_t RecordedValues::StoredOpacity(uint16_t opacity) const {
  if (kind_.values != StoredValues::kUint8) return opacity;
  // The alphas of 8-bit files have 257 times their value, at most kMostOpacity.
  constexpr uint32_t kStep = 257;
  const uint32_t steps = (opacity - 1u + kStep / 2) / kStep;
  return static_cast<uint16_t>(1 + std::min<uint32_t>(steps * kStep, kMostOpacity));
}

RecordedImage RecordedValues::Of(const Image<uint16_t>& light, const ChannelGains& gains) const {
  std::array<std::vector<uint16_t>, 3> tables = {StoredOf(gains[0])};
  for (size_t c = 1; c < tables.size(); ++c)
    tables[c] = gains[c] == gains[0] ? tables[0] : StoredOf(gains[c]);
  const uint16_t black = QuantizeRadiance(encoding_, 0, 1);
  // The light of a straight colour is black + (colour - black) * opacity.
  const auto stored_of = [&](const uint16_t* pixel, int c, uint16_t opacity) {
    int v = pixel[c];
    if (is_straight_ && opacity != kOpaqueOpacity) {
      const double share = (opacity - 1.0) / kMostOpacity;
      v = share > 0 ? static_cast<int>(std::clamp(black + (v - black) / share + 0.5, 0.0, 65535.0))
                    : black;
    }
    return tables[static_cast<size_t>(c)][static_cast<size_t>(v)];
  };
  const int channels = kind_.layout == PixelLayout::kRgb ? 3 : 1;
  RecordedImage image;
  image.layout = kind_.layout;
  image.values = kind_.values;
  image.rect = {0, 0, light.width(), light.height()};
  Image<uint16_t> values(light.width(), light.height(), channels);
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x) {
      const uint16_t* pixel = &light.at(x, y);
      uint16_t opacity = pixel[LfPixels::kRayLane];
      if (has_opacity_) {
        if (opacity != kMaskedOpacity) opacity = StoredOpacity(opacity);
        if (opacity != kOpaqueOpacity && image.opacities.empty())
          image.opacities = Image<uint16_t>(light.width(), light.height(), 1, kOpaqueOpacity);
        if (!image.opacities.empty()) image.opacities.at(x, y) = opacity;
        if (opacity == kMaskedOpacity) continue;
      } else if (opacity == 0) {
        if (image.mask.empty()) image.mask = Image<uint8_t>(light.width(), light.height(), 1, 255);
        image.mask.at(x, y) = 0;
        continue;
      }
      if (kind_.layout == PixelLayout::kRgb)
        for (int c = 0; c < 3; ++c) values.at(x, y, c) = stored_of(pixel, c, opacity);
      else
        values.at(x, y) = stored_of(
            pixel, kind_.layout == PixelLayout::kMosaic ? BayerChannel(encoding_.bayer, x, y) : 1,
            opacity);
    }
  if (kind_.values == StoredValues::kUint8) {
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
