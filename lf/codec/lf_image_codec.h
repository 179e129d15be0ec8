// The pixels of one image to bytes and back (thesis 2.5, 4.2.2). Knows nothing of light fields.
// The format, with an example: doc/formats/lf_image.md. Why it is so, with figures: doc/codec.md.
//
// An image is cut into tiles. A tile becomes planes, the planes are wavelet transformed, their
// coefficients quantised and packed into bytes, and these compressed by zstd. The approximations of
// all tiles come first in the code, then level after level of details. The same image and settings
// give the same bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Stored values, 8 or 16 bits: [height][width][1] grey or mosaic, [height][width][3] R, G, B.
using CodecPixels = std::variant<Image<uint8_t>, Image<uint16_t>>;

enum class PixelLayout : uint8_t {
  kGrey = 0,
  kMosaic = 1,  // a Bayer pattern; which one does not matter
  kRgb = 2,
};

enum class CodecProfile : uint8_t {
  // The thesis's: planes of equal colour (Figure 4.6), averaging Haar transform, one threshold for
  // all details, the range of an image's coefficients mapped to `quantizer` values.
  kThesis = 0,
  // 5/3 wavelets; uniform quantisers with a dead zone, one step for each band, such that all bands
  // give the same error per coefficient.
  kDefault = 1,
  // The same wavelets in whole numbers, nothing dropped.
  kLossless = 2,
};

struct CodecSettings {
  CodecProfile profile = CodecProfile::kDefault;
  int levels = 4;  // 1 to 5; the thesis's best is 1
  // Detail coefficients below this become 0; in stored values. kThesis: of the averaging transform.
  // kDefault: of the transform scaled to unit norm; the quantiser's step is one and a half times as
  // wide. Not of kLossless.
  double threshold = 3;
  // kThesis only: how many values a coefficient may have, 2 to 65536; above 256 they take two bytes
  // each.
  int quantizer = 256;
};

// kUsage: settings out of their ranges, named as the options of lfcompressor are.
Result<void> CheckSettings(const CodecSettings& settings);

// `pixels` of at least 1x1 and at most 2^30 pixels; the channels must be those of the layout. The
// settings must be valid.
std::string EncodeImage(const CodecPixels& pixels, PixelLayout layout,
                        const CodecSettings& settings);

// What a code says of itself.
struct CodeInfo {
  int width = 0;
  int height = 0;
  PixelLayout layout = PixelLayout::kGrey;
  int bits = 8;  // 8 or 16
  CodecProfile profile = CodecProfile::kDefault;
  int levels = 0;
};

// kInput, without a name: no code, of a newer version, damaged, more than 2^30 pixels, or shorter
// than its own table of contents. Reads the head alone.
Result<CodeInfo> ReadCodeInfo(std::string_view code);

struct DecodedPart {
  CodecPixels pixels;
  PixelRect rect;  // where they lie in the image
};

// The pixels of the tiles that hold `wanted`, which is some within the image. The memory of
// part->pixels is used again if it has the same type. Bytes that were written by something else may
// give any picture, or an error; never more memory than the tiles' pixels take, several times.
// kInput, without a name: as ReadCodeInfo(), or damage within the tiles.
Result<void> DecodeImage(std::string_view code, const PixelRect& wanted, DecodedPart* part);
// All of it.
Result<void> DecodeImage(std::string_view code, DecodedPart* part);

}  // namespace lf
