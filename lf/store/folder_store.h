// Loose image files, as the calibration names them.
#pragma once

#include <cstdint>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/store/lf_image_store.h"

namespace lf {

// Reads PNG, JPEG, TIFF, EXR and camera raw files (imageio/image_file.h) and turns their values
// into radiance as LightField::encoding says:
//   - integers through its table, of 8 or 16 bits; floats are radiance already, and quantised;
//   - with a Bayer pattern a file has one channel; without, it is RGB, or grey, which counts for
//     all three;
//   - pixels whose alpha is below one half are masked, and so are those that are 0 in the first
//     channel of the image's mask file. Further channels are not used;
//   - pictures and masks are taken as stored, or turned by 90 degrees as their orientation tag says
//     where the calibration is of the turned picture (capture/image_fit.h).
// While one image loads, the file, its stored values and the result are in memory together.
// Keeps a reference to `light_field`, which must outlive it.
class FolderStore : public LfImageStore {
 public:
  explicit FolderStore(const LightField& light_field);

  // The pixels of `rect`, cut to the image. kInput as LfImageStore says, and also: levels
  // (lf_black_level, lf_white_level) beyond the file's bits, a mask of another size, a camera raw
  // file of another Bayer pattern.
  Result<LfPixels> Load(LfImageId id, const PixelRect& rect) const override;
  // Of the image's file; a mask file is not read ahead.
  void Announce(LfImageId id) const override;

 private:
  const LightField& light_field_;
  // v by stored value, for images without a gain of their own. Empty where the levels do not fit.
  std::vector<uint16_t> table_8bit_;
  std::vector<uint16_t> table_16bit_;
};

}  // namespace lf
