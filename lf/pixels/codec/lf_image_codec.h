// SPDX-License-Identifier: Apache-2.0
// Encodes the pixels of one image into bytes and decodes them (thesis 2.5, 4.2.2); knows nothing of
// light fields. doc/formats/lf_image.md describes the format with an example, doc/codec.md gives
// the reasons for it with measurements.
//
// The encoder cuts an image into tiles and each tile into planes. It wavelet transforms the planes,
// quantises the coefficients, packs them into bytes and compresses these with zstd. The encoded
// image holds the approximations of all tiles first, then one level of details after the other,
// from the coarsest to the finest.
// Encoding is deterministic: equal images and settings give equal bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// The values that an encoded image stores, of 8 or 16 bits: [height][width][1] for grey or a
// mosaic, [height][width][3] for R, G, B.
using CodecPixels = std::variant<Image<uint8_t>, Image<uint16_t>>;

enum class PixelLayout : uint8_t {
  kGrey = 0,
  kMosaic = 1,  // a Bayer mosaic of any pattern
  kRgb = 2,
};

enum class CodecProfile : uint8_t {
  // The thesis's profile: planes of equal colour (Figure 4.6), averaging Haar transform, one
  // threshold for all details, the range of an image's coefficients mapped to
  // CodecSettings::quantizer values.
  kThesis = 0,
  // 5/3 wavelets; uniform quantisers with a dead zone. The step of each subband is chosen such that
  // an error of one step causes the same error in the image whatever the subband is.
  kDefault = 1,
  // The wavelets of kDefault without quantisation: nothing is lost.
  kLossless = 2,
};

// How coefficients become bytes. Both are exact.
enum class Entropy : uint8_t {
  kPacked = 0,    // several in a byte, compressed by zstd
  kContexts = 1,  // each by a distribution that its neighbours predict: 3 to 29 % fewer bytes, but
                  // decoding takes two to three times as long. kThesis does not have it
};

struct CodecSettings {
  CodecProfile profile = CodecProfile::kDefault;
  int levels = 4;  // number of wavelet levels, 1 to 5; the thesis found 1 to be best
  // Detail coefficients whose magnitude is below this value become 0. It is 0 to 65535, in units of
  // stored values. kThesis compares coefficients of the averaging transform. kDefault compares
  // coefficients of the transform scaled to unit norm, and its quantiser's step is 1.5 times the
  // threshold. kLossless ignores it.
  double threshold = 3;
  // Used by kThesis only: the number of values that a coefficient may have, 2 to 65536. Above 256,
  // each coefficient takes two bytes.
  int quantizer = 256;
  Entropy entropy = Entropy::kPacked;
};

// Returns kUsage if a setting is out of its range; the message names the option of lfcompressor
// that sets it.
Result<void> CheckSettings(const CodecSettings& settings);

// Returns the encoded image. `pixels` must have at least 1x1 and at most 2^30 pixels, and the
// number of channels of the layout. CheckSettings() must accept the settings.
std::string EncodeImage(const CodecPixels& pixels, PixelLayout layout,
                        const CodecSettings& settings);
// Encodes an image that may take seconds. kInterrupted: is_interrupted() returned true.
//   is_interrupted  called by this thread before each tile is transformed, and before each packet
//                   is compressed; may be empty
Result<std::string> EncodeImage(const CodecPixels& pixels, PixelLayout layout,
                                const CodecSettings& settings,
                                const std::function<bool()>& is_interrupted);

// Properties of an encoded image, as its head states them.
struct CodeInfo {
  int width = 0;
  int height = 0;
  PixelLayout layout = PixelLayout::kGrey;
  int bits = 8;  // bits of a stored value, 8 or 16
  CodecProfile profile = CodecProfile::kDefault;
  int levels = 0;
  Entropy entropy = Entropy::kPacked;
  // Number of other images from which it is predicted. It can only be decoded with their pixels
  // (predicted_image.h) unless this is 0.
  int reference_count = 0;
};

// Reads only the head. Returns kInput, with a message that does not name the file, if `code` is no
// encoded image, was written by a newer version, has a damaged head or more than 2^30 pixels, or
// is too short for its table of contents.
Result<CodeInfo> ReadCodeInfo(std::string_view code);

struct DecodedPart {
  CodecPixels pixels;
  PixelRect rect;  // position of the pixels in the image
};

// Decodes the tiles that overlap `wanted`, which must contain a pixel of the image. Reuses the
// memory of part->pixels if it has the right type. If another program wrote `code`, the result may
// be any picture or an error, but decoding never needs more memory than a few times the pixels of
// these tiles. Returns kInput, with a message that does not name the file, if ReadCodeInfo() does,
// if the image is predicted from others, or if the table of contents or one of these tiles is
// damaged.
Result<void> DecodeImage(std::string_view code, const PixelRect& wanted, DecodedPart* part);
// Decodes the whole image.
Result<void> DecodeImage(std::string_view code, DecodedPart* part);

// The following functions make a smaller picture of the front of an encoded image alone: `code` may
// be cut off at ResolutionEnds()[ResolutionFor()] bytes.

// Returns the largest reduction that DecodeReduced() can make, a power of 2: 1 if it can make none,
// as for kThesis and for predicted images.
int LargestReduction(const CodeInfo& info);
// Returns the number of the last resolution (doc/formats/lf_image.md) that DecodeReduced() reads.
//   reduction  from 2 to LargestReduction(), a power of 2
int ResolutionFor(const CodeInfo& info, int reduction);
// Returns for each resolution the number of bytes at the front of the encoded image that contain it
// and all coarser ones; ascending. kInput as ReadCodeInfo().
Result<std::vector<uint64_t>> ResolutionEnds(std::string_view code);
// Decodes the whole image at a reduced size: each pixel is about the mean of a square of reduction
// x reduction pixels. Pixels that fill no square are cut off on the right and below. Is 29 to 36 dB
// near the mean (doc/codec.md, "Smaller pictures").
//   pixels  [height / reduction][width / reduction][channels]: 1 for grey, 3 for RGB, and 4 for a
//           mosaic: the means of the pixels at (even, even), (odd, even), (even, odd) and (odd,
//           odd) columns and rows
// Errors are those of DecodeImage().
Result<void> DecodeReduced(std::string_view code, int reduction, CodecPixels* pixels);

}  // namespace lf
