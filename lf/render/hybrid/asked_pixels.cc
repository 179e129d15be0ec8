// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/asked_pixels.h"

#include "lf/render/collect/collect.h"

namespace lf {

uint32_t PhaseOf(uint32_t rank) {
  if (rank < kDecisionRanks) return 0;
  uint32_t phase = kDecisionRanks;
  while (phase <= rank / 4) phase *= 4;
  return phase;
}

// camera_ is the widened camera of LensGaps::ReachedCamera() only if the finished frame needs
// rebinned rays. Previews do not widen it, so that no LF image is read for previews alone.
AskedPixels::AskedPixels(const LensGaps& gaps, bool collects, Previews previews)
    : camera_(gaps.asks_in_the_end() ? gaps.ReachedCamera() : gaps.camera()),
      asks_in_the_end_(gaps.asks_in_the_end()),
      is_previewed_(collects && previews != Previews::kOff &&
                    (previews == Previews::kOn || gaps.collected_count() > kPreviewedFrom)),
      changes_until_(gaps.changes_until()),
      previewed_until_(gaps.RankAfter(kPreviewImages)) {}

PixelRect AskedPixels::RectOf(const LfCamera& lf_camera, const ImageOverlap& overlap, uint32_t rank,
                              const SelectOptions& select) const {
  const bool is_for_preview = rank < previewed_until_ && IsPreviewed(PhaseOf(rank));
  if (!is_for_preview && !asks_in_the_end_) return {};
  return IsWithinAngle(lf_camera, camera_, select) ? overlap.Rect(camera_) : PixelRect();
}

PixelRect GrownBy(const PixelRect& rect, int around_px, const Intrinsics& image) {
  if (rect.empty()) return rect;
  return Intersection({rect.x_begin - around_px, rect.y_begin - around_px, rect.x_end + around_px,
                       rect.y_end + around_px},
                      {0, 0, image.width_px, image.height_px});
}

}  // namespace lf
