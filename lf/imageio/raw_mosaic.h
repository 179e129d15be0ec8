// What a camera raw file says of its mosaic, read from its TIFF tags. Internal to this folder.
//
// Pixels come from LibRaw through OpenImageIO 2.4, which tells neither levels nor a usable pattern
// ("GMCY" for RGGB, "unknown" for the other three), and reads a null pointer where a raw file holds
// anything but a mosaic of 16-bit integers. So the tags are read here first, and only files that
// state such a mosaic go on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/imageio/image_probe.h"

namespace lf {

struct RawMosaic {
  // Of the pixels that LibRaw gives: the active area, where the file states one.
  int width = 0;
  int height = 0;
  BayerPattern bayer = BayerPattern::kNone;  // at their upper left; kNone: not told
  std::optional<double> black_level;         // the mean, where it differs between pixels
  std::optional<double> white_level;
};

// Whether a TIFF file is a camera raw file: a DNG, or one that leads with a thumbnail, which would
// pass as TIFF and show the thumbnail.
bool IsRawTiff(const ByteSource& source);

// kInput, for a file that IsRawTiff(): no mosaic of 2 x 2 pixels that repeat (colour already
// interpolated, X-Trans, or a kind of raw file that does not say); pixels that lie beyond the end
// of the file; more pixels than are read, or than the file can hold.
Result<RawMosaic> ReadRawMosaic(const ByteSource& source, const std::string& name);

}  // namespace lf
