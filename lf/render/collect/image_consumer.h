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

  // Returns the rank of the order before which the object needs no LF image any more, like
  // FrameProgress::ranks_done.
  virtual uint32_t ranks_done() const = 0;
  // Returns the bounds of the pixels that the object needs of the LF image at `rank`; empty if it
  // needs none. Any thread may call this, for LF images that have not been passed to Take() yet.
  virtual PixelRect RectOf(LfImageId id, uint32_t rank) const = 0;
  // Processes the LF images of a batch, given by ascending ranks. Must ignore those before
  // ranks_done(), which it may have processed already. The others have at least the pixels that
  // RectOf() returned. All LF images that are not given, at ranks before rank_end, are broken or
  // not needed.
  virtual void Take(std::span<const BatchImage> images, uint32_t rank_end) = 0;
};

}  // namespace lf
