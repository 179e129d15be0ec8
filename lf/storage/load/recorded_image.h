// SPDX-License-Identifier: Apache-2.0
// An LF image that will be written to a packed store. It holds stored values and not radiance: the
// light field's encoding is applied when the image is loaded from the store, by the code that also
// converts separate files (packed_store.h).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/pixels/codec/predicted_image.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {

// Values of a picture of opacities [height][width][1]. A pixel of value 0 is masked and sends no
// ray. A pixel of any other value o covers (o - 1) / kMostOpacity of the light behind it.
inline constexpr uint16_t kMaskedOpacity = 0;
inline constexpr uint16_t kMostOpacity = 65534;
inline constexpr uint16_t kOpaqueOpacity = kMostOpacity + 1;

struct RecordedImage {
  // Stored values of the pixels `rect`: grey, a mosaic, or R, G, B. Other channels are left out.
  CodecPixels pixels;
  PixelLayout layout = PixelLayout::kGrey;
  // kUint8 or kUint16; kHalf for float files, as ordered integers (ordered_half.h).
  StoredValues values = StoredValues::kUint8;
  PixelRect rect;
  Image<uint8_t> mask;  // [height][width]: 0 masked, 255 not masked; empty: no pixel is masked
  // Opacity of each pixel, which replaces the mask if alpha is light. Empty: every
  // pixel is opaque, or alpha is not light.
  Image<uint16_t> opacities;
  bool is_rounded = false;  // true if a float was no half float and was rounded to the nearest one
  uint64_t source_bytes = 0;  // size of the LF image's file and its mask file
};

// Reads the pixels of `rect`, clipped to the image, rotated if the calibration belongs to the
// rotated picture (light_field/model/image_fit.h), and not composed with a background. Pixels that
// are masked by alpha, the mask file (folder_store.h) or brackets (light_field/model/brackets.h)
// are 0 in the mask or the opacities. Floats become the nearest half floats, NaN becomes 0. When
// half floats are loaded, they are quantised as floats of image files are. kInput as
// FolderStore::Load(), if `rect` lies outside the image, and if half floats cannot hold the light:
// values from 65520 on that a small gain would make visible, or values that a large gain needs to
// be finer than half floats are near 0.
Result<RecordedImage> ReadRecordedImage(const LightField& light_field, LfImageId id,
                                        const PixelRect& rect);

// Returns RecordedImage::source_bytes without reading the image; 0 if the file does not exist.
uint64_t SourceBytesOf(const LightField& light_field, LfImageId id);

// Returns the pixels that a packed store must hold so that `rect` can be loaded. For mosaics they
// include the pixels around `rect` that demosaicing needs.
PixelRect RectToRecord(const LightField& light_field, LfImageId id, const PixelRect& rect);

// Encodes the pixels by `settings`, and the mask or the opacities losslessly.
CodedImage CodeOf(const RecordedImage& image, const CodecSettings& settings);
// kInterrupted: is_interrupted() returned true. It is called as by EncodeImage(), and may be empty.
Result<CodedImage> CodeOf(const RecordedImage& image, const CodecSettings& settings,
                          const std::function<bool()>& is_interrupted);

// Encodes the pixels relative to reference images of their layout and number type, which the caller
// names in CodedImage::references, and the mask or the opacities losslessly. Arguments are those of
// EncodePredicted(). kInterrupted as CodeOf(), but only before and after the pixels are encoded.
Result<CodedImage> CodeFrom(const RecordedImage& image, const CodecSettings& settings,
                            std::span<const Reference> references,
                            const PredictionSettings& prediction,
                            const std::function<bool()>& is_interrupted);

// Returns true if the LF image's file can be kept in place of its encoded pixels `rect`: they are
// all of its pixels, and the LF image is no view of a larger picture.
bool CanKeepFile(const LightField& light_field, LfImageId id, const PixelRect& rect);

// Returns the bytes of the LF image's file as its encoded image, with the encoded mask or
// opacities. nullopt if CanKeepFile() is false for the pixels of `image`. kInput: the file cannot
// be read. kInterrupted as CodeOf().
Result<std::optional<CodedImage>> FileAsCode(const LightField& light_field, LfImageId id,
                                             const RecordedImage& image,
                                             const std::function<bool()>& is_interrupted = {});

// Returns the file if there is one and it is at most as large as the encoded image; otherwise the
// encoded image.
CodedImage SmallerOf(CodedImage code, std::optional<CodedImage> file);

// Returns CodedImage::front_ends for an encoded image without a mask: those of all its resolutions
// but the finest. Errors are those of ResolutionEnds().
Result<std::vector<uint64_t>> FrontEndsOf(std::string_view code);

}  // namespace lf
