// SPDX-License-Identifier: Apache-2.0
// The interface of code, such as rebinning, that receives the LF images that are loaded for the
// plates.
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

  // Returns the place of the order before which the object needs no LF image any more, like
  // FrameProgress::places_done.
  virtual uint32_t places_done() const = 0;
  // Returns the bounds of the pixels that the object needs of the LF image at `place`; empty if it
  // needs none. Any thread may call this, for LF images that have not been passed to Take() yet.
  virtual PixelRect RectOf(LfImageId id, uint32_t place) const = 0;
  // Processes the LF images of a batch, given by ascending places. Must ignore those before
  // places_done(), which it may have processed already. The others have at least the pixels that
  // RectOf() returned. All LF images that are not given, at places before place_end, are broken or
  // not needed.
  virtual void Take(std::span<const BatchImage> images, uint32_t place_end) = 0;
};

}  // namespace lf
