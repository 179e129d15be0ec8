// SPDX-License-Identifier: Apache-2.0
// The input of a packed store: all LF cameras of a light field, and which pixels are encoded.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/render/package/package.h"
#include "lf/storage/load/recorded_image.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {

class DemosaickedImages;

struct CompressSource {
  // The whole light field. Its encoding states the footprint of LF pixels, because that is measured
  // from a few LF images, which a store may leave out or change.
  LightField light_field;
  LightFieldIdentity whole;  // identity of `light_field`
  // Pixels to compress of each LF image; an empty rectangle: the LF image is left out. A store has
  // the LF cameras of all LF images, so that the order of LF images, lens weights and the choice of
  // rebinned rays are those of the whole light field.
  std::vector<PixelRect> rects;
  // Number of each LF image in the whole light field (PackedStorePlan::whole_ids); empty: 0, 1, 2,
  // ...
  std::vector<uint32_t> whole_ids = {};
  std::optional<StoreFilms> films = {};  // films that the packed store was encoded for

  // Makes the pixels of `light_field` of mosaics (demosaicked_images.h); null: they are recorded.
  std::shared_ptr<DemosaickedImages> demosaicked = {};

  // Returns true if the light field is a packed store, whose encoded images are copied.
  bool IsCopied() const { return !demosaicked && HoldsPackedStore(light_field); }
  // Returns the ids of the LF images that are not left out, ascending; there is at least one.
  std::vector<LfImageId> CompressedIds() const;
};

// Reads the pixels of an LF image that are compressed: those of its rectangle, and what a mosaic
// needs around them. Errors as ReadRecordedImage() or, if source.demosaicked is set,
// DemosaickedImages::Read().
Result<RecordedImage> ReadToCompress(const CompressSource& source, LfImageId id);

// Returns all LF images of the light field, with all their pixels; of a packed store, those that it
// has. kUsage: the light field is reduced, or a packed store that is densified, has parts of LF
// images alone, or was made from packages by an older program. kInput: the store is damaged.
// kOutput as MeasureFootprint(), which is called if the calibration does not state the footprint.
Result<CompressSource> SourceOfAll(LightField light_field);

// Returns the LF images from which frames of the packages take rays, and leaves out all others. If
// the light field is a packed store, those from which they are predicted are not left out.
//   light_field    the light field that the packages were made from
//   needed_pixels  true: of each LF image, only the bounds of the pixels that these frames need;
//                  false: all pixels
// The result has the radiance encoding of the packages, or of the packed store. kUsage: the
// packages are of different light fields, or none of their frames takes a ray; needed_pixels is
// true for a packed store; the errors of SourceOfAll(). kInput: `light_field` is another one than
// that of the packages. kOutput as SourceOfAll().
Result<CompressSource> SourceOfPackages(LightField light_field, std::span<const Package> packages,
                                        bool needed_pixels);

}  // namespace lf
