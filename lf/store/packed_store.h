// LF images from a packed store (packed/packed_store_file.h).
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/codec/lf_image_codec.h"
#include "lf/core/result.h"
#include "lf/imageio/image_file.h"
#include "lf/packed/packed_store_file.h"
#include "lf/store/display_curve.h"
#include "lf/store/lf_image_store.h"
#include "lf/store/radiance_conversion.h"

namespace lf {

// Decodes what was recorded (recorded_image.h), and makes radiance of it as FolderStore does of
// files: where the codes are without loss, the same bits.
// In memory it has 32 bytes for each LF image of the light field, and a connection to the file for
// each thread that was loading at the same time. While one image loads, its code, its stored values
// and the result are in memory together.
// Keeps a reference to `light_field`, which must outlive it.
class PackedStore : public LfImageStore {
 public:
  // light_field.folder is the store; its LF images are found by their names, so that it may be the
  // store's own light field or another, such as a package's. kInput: packed/packed_store_file.h.
  static Result<std::unique_ptr<PackedStore>> Open(const LightField& light_field, Mosaics mosaics);

  // The pixels of `rect`, cut to the image. kInput as LfImageStore says, naming store and image:
  // what is not in the store, pixels beyond those that were coded, damage.
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override;
  // An LF image without a code, which was missing or broken when the store was made, was not left
  // out on purpose.
  bool IsPartial() const override;
  bool Keeps(LfImageId id, const PixelRect& rect) const override;
  // Whether there is a code, by the store's table.
  bool IsThere(LfImageId id) const override { return codes_[id.value].bytes > 0; }
  uint64_t StoredBytes(LfImageId id) const override { return codes_[id.value].bytes; }
  // What the store's table says of an LF image.
  const PackedCode& CodeOf(LfImageId id) const { return codes_[id.value]; }

 private:
  // What one load needs, and serves others.
  struct Loading {
    PackedCodeReader reader;
    DecodedPart decoded;
    DecodedPart mask;
    ImagePart part;  // what is made radiance of
    Image<float> floats;
    LfPixels mosaic;  // before it becomes RGB
  };

  PackedStore(const LightField& light_field, Mosaics mosaics, std::vector<PackedCode> codes);
  Result<void> LoadRecorded(Loading* loading, LfImageId id, const PixelRect& rect,
                            LfPixels* pixels) const;
  Result<std::unique_ptr<Loading>> TakeLoading() const;
  void GiveBack(std::unique_ptr<Loading> loading) const;

  const LightField& light_field_;
  const RadianceTables tables_;  // for images without a gain of their own
  const Mosaics mosaics_;
  const std::vector<PackedCode> codes_;  // as light_field.cameras
  std::optional<DisplayCurve> curve_;    // where there are codes along it
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Loading>> loadings_;  // as many as were at the same time
};

}  // namespace lf
