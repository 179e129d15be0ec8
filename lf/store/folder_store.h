// Loose image files, as the calibration names them.
#pragma once

#include "lf/capture/light_field.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// Keeps a reference to `light_field`, which must outlive it.
class FolderStore : public LfImageStore {
 public:
  explicit FolderStore(const LightField& light_field);

  Result<LfPixels> Load(LfImageId id, const PixelRect& rect) const override;

 private:
  const LightField& light_field_;
  // v by stored value, for images without a gain of their own.
  std::vector<uint16_t> table_8bit_;
  std::vector<uint16_t> table_16bit_;
};

}  // namespace lf
