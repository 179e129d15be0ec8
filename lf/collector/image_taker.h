// Something beside the plates that LF images are read for, out of the same queue.
#pragma once

#include <cstdint>
#include <span>

#include "lf/collector/collect_batch.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"

namespace lf {

class ImageTaker {
 public:
  virtual ~ImageTaker() = default;

  // All LF images at places before it are taken; as FrameProgress.
  virtual uint32_t places_done() const = 0;
  // The pixels that it wants of the LF image at that place; empty: none. Any thread may ask, for
  // images yet to come.
  virtual PixelRect RectOf(LfImageId id, uint32_t place) const = 0;
  // LF images of a batch, by ascending places from places_done() on, with at least these pixels;
  // all others before place_end are not wanted, or broken.
  virtual void Take(std::span<const BatchImage> images, uint32_t place_end) = 0;
};

}  // namespace lf
