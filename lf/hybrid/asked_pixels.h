// Which pixels of LF images the rebinned rays of one frame are made of. Known from calibrations
// alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/hybrid/lens_gaps.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"

namespace lf {

// Frames that rays are kept of for pictures of an unfinished render, where they collect, too.
enum class Previews {
  kAuto,  // of those that collect more than kPreviewedFrom LF images: fewer are there soon
  kOn,
  kOff,
};
// "auto", "on", "off"
const char* NameOf(Previews previews);
inline constexpr size_t kPreviewedFrom = 256;
// Number of LF images of a frame whose rays are kept for that: they are all over its lens
// (thesis 4.2.1).
inline constexpr size_t kPreviewImages = 64;

// Queries are looked at anew before the LF images at these places: 0 and the powers of
// four times kDecisionPlaces (collector/collect.h). The last one up to `place`.
uint32_t PhaseOf(uint32_t place);

class AskedPixels {
 public:
  //   collects  whether the frame collects rays, too
  AskedPixels(const LensGaps& gaps, bool collects, Previews previews);

  // Returns whether the frame asks for rays of any LF image.
  bool AsksForAny() const { return asks_in_the_end_ || IsPreviewed(0); }
  bool asks_in_the_end() const { return asks_in_the_end_; }
  // Returns whether rays are kept for a picture of the unfinished frame, as it is when the LF
  // images before that phase (PhaseOf()) are collected.
  bool IsPreviewed(uint32_t phase) const { return is_previewed_ && phase < changes_until_; }

  // A camera whose lens holds all rays that are asked for, to select LF images by.
  const RenderCamera& camera() const { return camera_; }

  // Returns the bounds of the pixels whose rays may be kept; empty: none.
  //   overlap  of the LF image
  PixelRect RectOf(const LfCamera& lf_camera, const ImageOverlap& overlap, uint32_t place,
                   const SelectOptions& select) const;

 private:
  RenderCamera camera_;
  bool asks_in_the_end_;
  bool is_previewed_;
  uint32_t changes_until_;
  uint32_t previewed_until_;  // place
};

// Returns the pixels that are read of an LF image so that all of `rect` can be rebinned: some more
// around it, cut to the image.
//   around_px  PixelsAround() (rebinning/rebin_image.h) of a mosaic
PixelRect GrownBy(const PixelRect& rect, int around_px, const Intrinsics& image);

}  // namespace lf
