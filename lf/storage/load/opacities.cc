// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/opacities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "lf/core/check.h"

namespace lf {
namespace {

template <class T>
uint16_t OpacityOf(T alpha) {
  uint32_t of_16_bits = 0;
  if constexpr (std::is_floating_point_v<T>)
    of_16_bits =
        alpha > 0 ? static_cast<uint32_t>(std::lround(65535 * std::min<double>(alpha, 1))) : 0;
  else
    of_16_bits = sizeof(T) == 1 ? uint32_t{alpha} * 257 : alpha;
  return static_cast<uint16_t>(1 + std::min<uint32_t>(of_16_bits, kMostOpacity));
}

constexpr uint32_t kOpacityRange = LfPixels::kOpaque - LfPixels::kTransparent;

// Stores the opacity a / kMostOpacity in the colour lanes of a pixel that is not masked, and 1 in
// its ray lane.
void StoreOpacity(uint32_t a, uint16_t* lanes) {
  const uint32_t v = LfPixels::kTransparent + (a * kOpacityRange + kMostOpacity / 2) / kMostOpacity;
  std::fill_n(lanes, LfPixels::kRayLane, static_cast<uint16_t>(v));
  lanes[LfPixels::kRayLane] = 1;
}

}  // namespace

Result<Image<uint16_t>> ReadOpacities(const LightField& light_field, LfImageId id,
                                      const ImagePart& part, const ChannelUse& use,
                                      const PixelRect& rect) {
  LF_CHECK(use.alpha && Intersection(rect, part.rect) == rect);
  Image<uint16_t> opacities(rect.width(), rect.height(), 1);
  if (rect.empty()) return opacities;
  std::visit(
      [&](const auto& stored) {
        const int channels = stored.channels();
        for (int y = rect.y_begin; y < rect.y_end; ++y) {
          const auto* alpha = stored.row(y - part.rect.y_begin) +
                              static_cast<size_t>(rect.x_begin - part.rect.x_begin) * channels +
                              *use.alpha;
          uint16_t* out = opacities.row(y - rect.y_begin);
          for (int x = 0; x < rect.width(); ++x, alpha += channels) out[x] = OpacityOf(*alpha);
        }
      },
      part.image);
  LF_RETURN_IF_ERROR(ForEachMasked(light_field, id, part, use, rect, [&](int x, int y) {
    opacities.at(x - rect.x_begin, y - rect.y_begin) = kMaskedOpacity;
  }));
  return opacities;
}

void ComposeWithBackground(const Image<uint16_t>& opacities, const PixelRect& opacities_rect,
                           const RadianceEncoding& encoding, LfPixels* pixels) {
  LF_CHECK(encoding.AlphaIsLight() && pixels->bayer == BayerPattern::kNone);
  const PixelRect& rect = pixels->rect;
  LF_CHECK(Intersection(rect, opacities_rect) == rect);
  const bool is_straight = *encoding.alpha == AlphaMeaning::kStraight;
  const auto pedestal = static_cast<uint32_t>(encoding.pedestal);
  std::array<uint32_t, 3> background;
  for (size_t c = 0; c < 3; ++c)
    background[c] = QuantizeRadiance(encoding, encoding.Background()[c], 1);
  const uint64_t most = QuantizeRadiance(encoding, encoding.max_radiance, 1);
  const bool has_opacity = encoding.HasOpacity();
  if (has_opacity) pixels->opacity.Resize(rect.width(), rect.height(), LfPixels::kRgbLanes);
  for (int y = 0; y < rect.height(); ++y) {
    const uint16_t* opacity = opacities.row(y + rect.y_begin - opacities_rect.y_begin) +
                              (rect.x_begin - opacities_rect.x_begin);
    uint16_t* lanes = pixels->radiance.row(y);
    uint16_t* kept = has_opacity ? pixels->opacity.row(y) : nullptr;
    for (int x = 0; x < rect.width(); ++x, ++opacity, lanes += LfPixels::kRgbLanes) {
      if (*opacity == kMaskedOpacity) {
        pixels->Mask(x, y);
        continue;
      }
      const uint32_t a = *opacity - 1u;
      if (has_opacity) StoreOpacity(a, kept + static_cast<ptrdiff_t>(x) * LfPixels::kRgbLanes);
      if (a == kMostOpacity) continue;
      for (size_t c = 0; c < 3; ++c) {
        const uint64_t own =
            is_straight ? uint64_t{lanes[c]} * a : uint64_t{lanes[c]} * kMostOpacity;
        const uint64_t behind =
            uint64_t{is_straight ? background[c] : background[c] - pedestal} * (kMostOpacity - a);
        lanes[c] =
            static_cast<uint16_t>(std::min((own + behind + kMostOpacity / 2) / kMostOpacity, most));
      }
    }
  }
}

void SetOpaque(LfPixels* pixels) {
  LF_CHECK(pixels->bayer == BayerPattern::kNone);
  pixels->opacity.Resize(pixels->rect.width(), pixels->rect.height(), LfPixels::kRgbLanes);
  const LargeVector<uint16_t>& radiance = pixels->radiance.pixels();
  for (size_t i = 0; i < radiance.size(); i += LfPixels::kRgbLanes) {
    uint16_t* const lanes = pixels->opacity.pixels().data() + i;
    if (radiance[i + LfPixels::kRayLane] == 0)
      std::fill_n(lanes, LfPixels::kRgbLanes, uint16_t{0});
    else
      StoreOpacity(kMostOpacity, lanes);
  }
}

}  // namespace lf
