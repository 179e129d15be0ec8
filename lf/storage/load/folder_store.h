// SPDX-License-Identifier: Apache-2.0
// Reads LF images from separate image files, as the calibration names them.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "lf/light_field/model/light_field.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/lf_image_store.h"
#include "lf/storage/load/radiance_conversion.h"

namespace lf {

// Reads image files of every format (pixels/files/image_file.h) and converts their values to
// radiance as LightField::encoding says:
//   - Integers of 8 or 16 bits are converted by a table (RadianceTables). Floats are radiance
//     already, and are quantised.
//   - With a Bayer pattern, a file has one channel. The store returns it as a mosaic, or as RGB
//     pixels computed from the mosaic (demosaic.h). Without a pattern, a file is RGB, or grey,
//     which counts for all colours.
//   - RadianceEncoding::alpha decides whether pixels with an alpha below one half are masked, or
//     all pixels are composed with the background (opacities.h). Pixels that are 0 in the first
//     channel of the image's mask file are masked; its further channels are ignored. Brackets mask
//     more pixels (light_field/model/brackets.h).
//   - Pictures and masks are taken as stored, or rotated by 90 degrees as their orientation tag
//     says if the calibration belongs to the rotated picture (light_field/model/image_fit.h).
// While one image loads, the file, its stored values and the result are in memory together. The
// memory of the stored values is reused for the next image.
// Keeps a reference to `light_field`, which must outlive the store.
class FolderStore : public LfImageStore {
 public:
  explicit FolderStore(const LightField& light_field, Mosaics mosaics = Mosaics::kAsRecorded);
  // Frees the picture that the views of the light field share (pixels/files/picture_view.h).
  ~FolderStore() override;
  FolderStore(const FolderStore&) = delete;
  FolderStore& operator=(const FolderStore&) = delete;

  // Loads the pixels of `rect`, clipped to the image. kInput as LfImageStore says, and if the
  // levels (lf_black_level, lf_white_level) exceed the file's bits, a mask file has another size
  // than the image, or the file's channels or its kind (camera raw) contradict lf_bayer.
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override;
  Result<void> LoadByRows(LfImageId id, const PixelRect& rect, LfPixels* pixels,
                          const RowsLoaded& rows_loaded) const override;
  // Reduces JPEG files without a mask and without a quarter turn, by 2, 4 or 8.
  Result<int> LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                          LfPixels* pixels) const override;
  bool IsThere(LfImageId id) const override;
  uint64_t StoredBytes(LfImageId id) const override;
  // Announces the image's file, but not its mask file.
  void Announce(LfImageId id) const override;

 private:
  // Buffers of one load, which are reused for later loads.
  struct Loading {
    ImagePart part;   // stored values of the image file
    LfPixels mosaic;  // the mosaic that is converted to RGB
  };

  Result<void> LoadBy(Loading* loading, LfImageId id, const PixelRect& rect,
                      const RowsLoaded& rows_loaded, LfPixels* pixels) const;
  // Loads the pixels as recorded, without demosaicing.
  //   rows_loaded  may be null
  Result<void> LoadRecorded(ImagePart* part, LfImageId id, const PixelRect& rect,
                            const RowsLoaded& rows_loaded, LfPixels* pixels) const;
  bool MayMask(LfImageId id) const;
  Result<int> LoadReducedBy(Loading* loading, LfImageId id, int divisor, LfPixels* pixels) const;
  std::unique_ptr<Loading> TakeLoading() const;
  void GiveBack(std::unique_ptr<Loading> loading) const;

  const LightField& light_field_;
  const RadianceTables tables_;  // for LF images of gain 1
  const Mosaics mosaics_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Loading>> loadings_;  // buffers that no load uses now
};

}  // namespace lf
