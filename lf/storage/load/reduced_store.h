// SPDX-License-Identifier: Apache-2.0
// Loads the LF images of a reduced light field (light_field/model/reduction.h). Internal to this
// folder.
#pragma once

#include <memory>

#include "lf/core/result.h"
#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Returns pixels that are the means of squares of divisor x divisor pixels. A pixel is masked if
// more than half of its square is, otherwise it is the mean of the others. Pixels on the right and
// below that fill no square are cut off, but at least one pixel is left.
//   pixels  a whole LF image in RGB
LfPixels MeansOfSquares(const LfPixels& pixels, int divisor);

// Loads LF images from another store, which has them as they were recorded, by its LoadReduced(),
// and reduces the result further to the divisor of the light field. Load() always loads a whole
// reduced LF image. Mosaics become RGB.
class ReducedStore : public LfImageStore {
 public:
  // Opens the store of the recorded LF images. `light_field` is reduced, and need not outlive the
  // store. Errors as OpenStore().
  static Result<std::unique_ptr<LfImageStore>> Open(const LightField& light_field);

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override;
  Result<int> LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                          LfPixels* pixels) const override;
  bool IsThere(LfImageId id) const override { return recorded_store_->IsThere(id); }
  bool IsPartial() const override { return recorded_store_->IsPartial(); }
  bool Keeps(LfImageId id, const PixelRect& rect) const override;
  uint64_t ReferenceBytes() const override { return recorded_store_->ReferenceBytes(); }
  void LimitReferences(uint64_t most_bytes) override {
    recorded_store_->LimitReferences(most_bytes);
  }
  uint64_t StoredBytes(LfImageId id) const override { return recorded_store_->StoredBytes(id); }
  void Announce(LfImageId id) const override { recorded_store_->Announce(id); }

 private:
  explicit ReducedStore(const LightField& light_field);

  const int divisor_;
  const LightField recorded_;
  std::unique_ptr<LfImageStore> recorded_store_;
};

}  // namespace lf
