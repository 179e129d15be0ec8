// SPDX-License-Identifier: Apache-2.0
// Loads LF images from a packed store (storage/packed/packed_store_file.h).
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/display_curve.h"
#include "lf/storage/load/lf_image_store.h"
#include "lf/storage/load/radiance_conversion.h"
#include "lf/storage/load/reference_cache.h"
#include "lf/storage/packed/packed_planes.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

// Decodes the recorded values (recorded_image.h) and converts them to radiance as FolderStore does
// for files. After lossless encoding, both stores give the same bits, unless floats were rounded to
// half floats. Takes 32 bytes of memory for each LF image of the light field, and opens the file as
// many times as threads have loaded at the same time. While one image loads, its encoded bytes, its
// stored values and the result are in memory together. If LF images are predicted, also the stored
// values of their reference images are (reference_cache.h). Keeps a reference to `light_field`,
// which must outlive the store.
class PackedStore : public LfImageStore {
 public:
  // Opens the file light_field.folder. LF images are found in it by name, so that `light_field` may
  // be the store's own light field or another one, such as that of a package. kInput as
  // FindCodes() and ReadDisplayLevels().
  //   reduction  LF images will only be loaded reduced by this or a multiple, so that parts of the
  //              store with more resolution need not be there
  static Result<std::unique_ptr<PackedStore>> Open(const LightField& light_field, Mosaics mosaics,
                                                   StoreContent content = StoreContent::kPixels,
                                                   int reduction = 1);

  // Loads the pixels of `rect`, clipped to the image. kInput as LfImageStore says, naming store and
  // image: the image is not in the store, the pixels lie beyond those that were encoded, or the
  // store is damaged. A message about a damaged reference image names both.
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override;
  // Reduces by the largest power of two that divides `divisor` and that the encoded image can be
  // reduced by, and reads and decodes only the front of the encoded image. A mosaic that is loaded
  // as RGB is reduced as well. Image files are reduced as FolderStore reduces them. Loads a whole
  // LF image if it has masks or opacities, depths, floats or the profile kThesis, if it is
  // predicted, and if a store of an earlier build has no fronts.
  Result<int> LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                          LfPixels* pixels) const override;
  bool LoadsDepths() const override { return densified_.has_value(); }
  bool IsPartial() const override;
  // As PackedCode::Keeps(). If a mosaic is loaded as RGB, the pixels beside `rect` from which its
  // colours are made must also be kept.
  bool Keeps(LfImageId id, const PixelRect& rect) const override;
  // Returns true if the store's table lists encoded pixels, and the parts that have them are there.
  bool IsThere(LfImageId id) const override {
    return codes_[id.value].bytes > 0 && codes_[id.value].missing_parts <= unneeded_parts_;
  }
  uint64_t StoredBytes(LfImageId id) const override { return codes_[id.value].bytes; }
  uint64_t ReferenceBytes() const override { return references_ ? references_->AllBytes() : 0; }
  void LimitReferences(uint64_t most_bytes) override {
    if (references_) references_->Limit(most_bytes);
  }
  // Returns the entry of the store's table for an LF image.
  const PackedCode& CodeOf(LfImageId id) const { return codes_[id.value]; }

 private:
  // Buffers of one load, which are reused for later loads.
  struct Loading {
    PackedCodeReader reader;
    DecodedPart decoded;
    DecodedPart mask;
    ImagePart part;  // the stored values that are converted to radiance
    Image<float> floats;
    LfPixels mosaic;                                         // the mosaic that is converted to RGB
    std::optional<PackedPlaneReader> planes = std::nullopt;  // opened when planes are first loaded
  };

  PackedStore(const LightField& light_field, Mosaics mosaics, std::vector<PackedCode> codes);
  int FrontsLeftOut(int divisor) const;
  Result<void> LoadRecorded(Loading* loading, LfImageId id, const PixelRect& rect,
                            LfPixels* pixels) const;
  void Convert(Loading* loading, StoredValues values, const PixelRect& coded,
               const RadianceEncoding& encoding, const LfCamera& camera, const Intrinsics& k,
               LfPixels* pixels) const;
  Result<int> LoadReducedBy(Loading* loading, LfImageId id, int divisor, LfPixels* pixels) const;
  Result<void> LoadDepths(Loading* loading, LfImageId id, LfDepths* depths) const;
  Result<void> LoadTrust(Loading* loading, LfImageId id, LfPixels* pixels) const;
  Result<PackedPlaneReader*> PlanesOf(Loading* loading) const;
  Result<std::unique_ptr<Loading>> TakeLoading() const;
  void GiveBack(std::unique_ptr<Loading> loading) const;

  const LightField& light_field_;
  const RadianceTables tables_;  // for LF images of gain 1
  const Mosaics mosaics_;
  const std::vector<PackedCode> codes_;  // entry of each LF image, in the order of their ids
  int unneeded_parts_ = 0;               // number of the store's finest parts that are not needed
  std::optional<DisplayCurve> curve_;    // set if any LF image is encoded as kDisplay16
  std::optional<DensifiedPlan> densified_;      // set if Load() loads depths and trust
  std::unique_ptr<ReferenceCache> references_;  // null if no LF image of the store is predicted
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Loading>> loadings_;  // buffers that no load uses now
};

}  // namespace lf
