// LF images on their way into a packed store: as stored, not as radiance, so that the encoding may
// be applied when they are loaded, by the same code as to loose files (packed_store.h).
#pragma once

#include <cstdint>

#include "lf/capture/light_field.h"
#include "lf/codec/lf_image_codec.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/packed/packed_store_writer.h"

namespace lf {

struct RecordedImage {
  // Of `rect`: grey, a mosaic, or R, G, B; further channels of a file are left out.
  CodecPixels pixels;
  PixelLayout layout = PixelLayout::kGrey;
  // kUint8 or kUint16; kHalf: of float files, as integers in order (ordered_half.h).
  StoredValues values = StoredValues::kUint8;
  PixelRect rect;
  Image<uint8_t> mask;  // empty: nothing is masked; else [height][width]: 0 masked, 255
  // These take the place of the mask if alpha is light (opacities.h); empty: all is opaque.
  Image<uint16_t> opacities;
  bool is_rounded = false;    // a float that half cannot hold exactly: it is the nearest half
  uint64_t source_bytes = 0;  // of the image's file and its mask's
};

// The pixels of `rect`, cut to the image, as the calibration has them (turned upright), not
// composed with a background. What is masked by alpha or mask file (folder_store.h) is in the mask.
// Floats become half floats, rounded to nearest where they are not; no light where they are NaN.
// Loaded again they are quantised as the floats themselves would be.
// kInput: as FolderStore::Load(); nothing of `rect` lies in the image.
Result<RecordedImage> ReadRecordedImage(const LightField& light_field, LfImageId id,
                                        const PixelRect& rect);

// RecordedImage::source_bytes, without reading the image; 0: it is not there.
uint64_t SourceBytesOf(const LightField& light_field, LfImageId id);

// The pixels that a store must hold so that those of `rect` can be loaded: of mosaics some more,
// which RGB pixels are made from.
PixelRect RectToRecord(const LightField& light_field, LfImageId id, const PixelRect& rect);

// Its codes: of the pixels by `settings`, of mask or opacities without loss.
CodedImage CodeOf(const RecordedImage& image, const CodecSettings& settings);

}  // namespace lf
