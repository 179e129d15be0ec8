// A second user of the LF images that are loaded for the plates, such as rebinned rays.
#pragma once

#include <cstdint>
#include <span>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/render/collect/collect_batch.h"

namespace lf {

class ImageConsumer {
 public:
  virtual ~ImageConsumer() = default;

  // All LF images at places before this one are taken, as in FrameProgress.
  virtual uint32_t places_done() const = 0;
  // Returns the pixels that it needs of the LF image at that place; empty: none. Any thread may
  // ask, for images that are yet to come.
  virtual PixelRect RectOf(LfImageId id, uint32_t place) const = 0;
  // Takes the LF images of a batch, by ascending places from places_done() on, with at least the
  // pixels that RectOf() gave. All other images before place_end are not needed, or broken.
  virtual void Take(std::span<const BatchImage> images, uint32_t place_end) = 0;
};

}  // namespace lf
