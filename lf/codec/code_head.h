// What stands before the coefficients (doc/formats/lf_image.md, "Head"). Internal to codec.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lf/codec/lf_image_codec.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

inline constexpr long long kMostPixels = 1LL << 30;
inline constexpr int kMostLevels = 5;
// Of tiles: 1024x1024 pixels, chosen by measurement (doc/codec.md). Others can be read.
inline constexpr int kTileBits = 10;
inline constexpr int kLeastTileBits = 6, kMostTileBits = 12;

struct CodeHead {
  CodeInfo info;
  int tile_bits = kTileBits;  // tiles have 2^tile_bits pixels a side, but for the last ones

  // Wavelets of kDefault and kLossless.
  int coefficient_bytes = 2;   // 2 or 4
  int fraction_bits = 0;       // of coefficients of the finest level
  std::vector<int32_t> steps;  // by component: approximation, then by level from the coarsest one
                               // on: of both bands high in one direction, of that high in both

  // kThesis.
  int quantizer = 256;
  int64_t low = 0;  // what the first and the last value stand for (haar.h)
  int64_t high = 0;

  int tile_size() const { return 1 << tile_bits; }
  int columns() const { return (info.width + tile_size() - 1) / tile_size(); }
  int rows() const { return (info.height + tile_size() - 1) / tile_size(); }
  size_t tile_count() const { return static_cast<size_t>(columns()) * rows(); }
  // Of tile 0 to tile_count(), row by row.
  PixelRect TileRect(size_t tile) const;

  // Planes that are transformed on their own.
  int components() const;
  int StepCount() const { return components() * (1 + 2 * info.levels); }
};

int ChannelsOf(PixelLayout layout);  // of pixels

void AppendHead(const CodeHead& head, std::string* code);
// Takes it from the front of `code`. kInput, without a name.
Result<CodeHead> TakeHead(std::string_view* code);

}  // namespace lf
