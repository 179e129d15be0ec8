// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/codec/tile_bands.h"

#include <algorithm>

namespace lf {

bool IsDoubled(const CodeHead& head, int depth) {
  return head.info.profile == CodecProfile::kDefault && depth <= kMostDoublings;
}

int FirstDepth(const CodeHead& head) { return head.info.layout == PixelLayout::kMosaic ? 2 : 1; }

PlaneExtent ComponentSize(const CodeHead& head, int component, PlaneExtent tile) {
  if (head.info.layout != PixelLayout::kMosaic) return tile;
  const auto band = static_cast<Band>(component);
  return {BandWidth(band, tile.width), BandHeight(band, tile.height)};
}

PlaneExtent LowSize(PlaneExtent size, int levels) {
  for (int i = 0; i < levels; ++i) size = {LowCount(size.width), LowCount(size.height)};
  return size;
}

size_t DetailCount(PlaneExtent size) { return size.count() - LowSize(size, 1).count(); }

int StripCountOf(const CodeHead& head, PlaneExtent tile, int resolution) {
  // The first component is the largest.
  const PlaneExtent size = ComponentSize(head, 0, tile);
  return StripCount(LowSize(size, head.info.levels + 1 - std::max(resolution, 1)).width);
}

Rounding RoundingOf(const CodeHead& head, int resolution) {
  return resolution == 0 || head.info.profile == CodecProfile::kLossless ? Rounding::kNearest
                                                                         : Rounding::kDeadZone;
}

int StepIndex(const CodeHead& head, int component, int resolution, bool is_diagonal) {
  const int first = component * (1 + 2 * head.info.levels);
  return resolution == 0 ? first : first + 2 * resolution - 1 + (is_diagonal ? 1 : 0);
}

}  // namespace lf
