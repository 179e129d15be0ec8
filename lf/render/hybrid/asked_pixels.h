// SPDX-License-Identifier: Apache-2.0
// Finds the pixels of LF images from which the rebinned rays of one frame are made. Needs only the
// calibration of the LF cameras, no pixels.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/hybrid/lens_gaps.h"
#include "lf/render/settings/rebin_settings.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"

namespace lf {

// For the previews of a frame, rebinned rays are kept only from the LF images up to the
// kPreviewImages-th one that the frame collects, in the order in which LF images are taken. With
// ImageOrder::kSpread, these LF images are spread over the whole lens (thesis 4.2.1).
inline constexpr size_t kPreviewImages = 64;

// Returns the first rank of the phase that contains `rank`. A rank is a position in the order of
// the LF images, from 0. Phases divide this order: they begin at rank 0 and at kDecisionRanks
// (render/collect/collect.h) times the powers of four. At the beginning of each phase, the queries
// of the previews (the rays to be interpolated for them, rebinning/frame_queries.h) are updated.
uint32_t PhaseOf(uint32_t rank);

class AskedPixels {
 public:
  //   collects  true if the frame also collects rays
  AskedPixels(const LensGaps& gaps, bool collects, Previews previews);

  // Returns true if the frame needs rebinned rays, for its final picture or for a preview.
  bool AsksForAny() const { return asks_in_the_end_ || IsPreviewed(0); }
  bool asks_in_the_end() const { return asks_in_the_end_; }
  // Returns true if rays are kept for previews in the phase that begins at rank `phase`.
  bool IsPreviewed(uint32_t phase) const { return is_previewed_ && phase < changes_until_; }

  // A camera whose lens and plate contain all rebinned rays that the finished frame needs; the
  // frame's own camera if it needs none. Selection uses it to find the LF images with such rays.
  const RenderCamera& camera() const { return camera_; }

  // Returns the bounds of those pixels of an LF image whose rays may be kept; empty if no ray may
  // be kept.
  //   overlap, rank  the ImageOverlap of this LF image, and its rank in the order
  PixelRect RectOf(const LfCamera& lf_camera, const ImageOverlap& overlap, uint32_t rank,
                   const SelectOptions& select) const;

 private:
  RenderCamera camera_;
  bool asks_in_the_end_;
  bool is_previewed_;
  uint32_t changes_until_;
  uint32_t previewed_until_;  // rank after the last LF image whose rays are kept for previews
};

// Returns the rectangle of an LF image that must be read to rebin the pixels of `rect`: `rect` with
// a margin on all sides, clipped to the image.
//   around_px  width of the margin: the result of PixelsAround() (rebinning/rebin_image.h) for a
//              mosaic
PixelRect GrownBy(const PixelRect& rect, int around_px, const Intrinsics& image);

}  // namespace lf
