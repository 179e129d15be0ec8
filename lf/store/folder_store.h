// Loose image files, as the calibration names them.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/imageio/image_file.h"
#include "lf/store/lf_image_store.h"
#include "lf/store/radiance_conversion.h"

namespace lf {

// Reads PNG, JPEG, TIFF, EXR and camera raw files (imageio/image_file.h) and turns their values
// into radiance as LightField::encoding says:
//   - integers through its table, of 8 or 16 bits; floats are radiance already, and quantised;
//   - with a Bayer pattern a file has one channel, and gives a mosaic, or RGB pixels made of it
//     (demosaic.h); without, it is RGB, or grey, which counts for all three;
//   - by RadianceEncoding::alpha, pixels whose alpha is below one half are masked, or all are
//   composed
//     with the background (opacities.h); pixels that are 0 in the first channel of the image's mask
//     file are masked. Further channels are not used;
//   - pictures and masks are taken as stored, or turned by 90 degrees as their orientation tag says
//     where the calibration is of the turned picture (capture/image_fit.h).
// While one image loads, the file, its stored values and the result are in memory together; the
// memory of the stored values is kept for the next.
// Keeps a reference to `light_field`, which must outlive it.
class FolderStore : public LfImageStore {
 public:
  explicit FolderStore(const LightField& light_field, Mosaics mosaics = Mosaics::kAsRecorded);

  // The pixels of `rect`, cut to the image. kInput as LfImageStore says, and also: levels
  // (lf_black_level, lf_white_level) beyond the file's bits, a mask of another size, a camera raw
  // file of another Bayer pattern.
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override;
  bool IsThere(LfImageId id) const override;
  uint64_t StoredBytes(LfImageId id) const override;
  // Of the image's file; a mask file is not read ahead.
  void Announce(LfImageId id) const override;

 private:
  // What one load needs, whose memory serves others.
  struct Loading {
    ImagePart part;   // stored values
    LfPixels mosaic;  // before it becomes RGB
  };

  Result<void> LoadBy(Loading* loading, LfImageId id, const PixelRect& rect,
                      LfPixels* pixels) const;
  // Pixels as recorded.
  Result<void> LoadRecorded(ImagePart* part, LfImageId id, const PixelRect& rect,
                            LfPixels* pixels) const;
  std::unique_ptr<Loading> TakeLoading() const;
  void GiveBack(std::unique_ptr<Loading> loading) const;

  const LightField& light_field_;
  const RadianceTables tables_;  // for images without a gain of their own
  const Mosaics mosaics_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Loading>> loadings_;  // as many as were at the same time
};

}  // namespace lf
