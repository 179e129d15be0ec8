// The pixels of LF images that the rebinned rays of one frame are made of, computed from
// calibrations alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/hybrid/lens_gaps.h"
#include "lf/selection/overlap.h"
#include "lf/selection/select.h"

namespace lf {

// The frames for which rays are kept for previews, pictures of an unfinished render. Only a frame
// that also collects rays has previews.
enum class Previews {
  kAuto,  // frames that collect more than kPreviewedFrom LF images: others are finished soon
  kOn,
  kOff,
};
// Returns "auto", "on" or "off".
const char* NameOf(Previews previews);
inline constexpr size_t kPreviewedFrom = 256;
// Number of collected LF images of a frame whose rays are kept for previews. They are spread all
// over its lens (thesis 4.2.1).
inline constexpr size_t kPreviewImages = 64;

// Phases begin at place 0 and at kDecisionPlaces (render/collect/collect.h) times the powers of
// four: before the LF image at such a place, the queries of previews are updated. Returns the first
// place of the phase that contains `place`.
uint32_t PhaseOf(uint32_t place);

class AskedPixels {
 public:
  //   collects  true if the frame also collects rays
  AskedPixels(const LensGaps& gaps, bool collects, Previews previews);

  // Returns true if the frame asks for rays of any LF image.
  bool AsksForAny() const { return asks_in_the_end_ || IsPreviewed(0); }
  bool asks_in_the_end() const { return asks_in_the_end_; }
  // Returns true if rays are kept for a preview of the frame, as it is when the LF images before
  // the phase (PhaseOf()) are collected.
  bool IsPreviewed(uint32_t phase) const { return is_previewed_ && phase < changes_until_; }

  // A camera whose lens and plate contain all rays that are asked for; LF images are selected by
  // it.
  const RenderCamera& camera() const { return camera_; }

  // Returns the bounds of the pixels whose rays may be kept; empty if there are none.
  //   overlap  of the LF image
  //   place    of the LF image
  PixelRect RectOf(const LfCamera& lf_camera, const ImageOverlap& overlap, uint32_t place,
                   const SelectOptions& select) const;

 private:
  RenderCamera camera_;
  bool asks_in_the_end_;
  bool is_previewed_;
  uint32_t changes_until_;
  uint32_t previewed_until_;  // place behind the last LF image whose rays are kept for previews
};

// Returns the pixels of an LF image that must be read to rebin all of `rect`: `rect` with a margin,
// clipped to the image.
//   around_px  PixelsAround() (rebinning/rebin_image.h) of a mosaic
PixelRect GrownBy(const PixelRect& rect, int around_px, const Intrinsics& image);

}  // namespace lf
