// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lf/rebinning/kept_pixels.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// A store that loads LF images from kept pixels, which must outlive it. It loads only the LF images
// of KeptPixels::images().
class KeptStore : public LfImageStore {
 public:
  explicit KeptStore(const KeptPixels& kept) : kept_(kept) {}

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    kept_.Load(id, rect, pixels);
    return {};
  }
  bool LoadsDepths() const override { return true; }

 private:
  const KeptPixels& kept_;
};

}  // namespace lf
