// SPDX-License-Identifier: Apache-2.0
// The head of an encoded image: the fields before its table of contents (doc/formats/lf_image.md,
// "Head"). Internal to this folder.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/pixels/codec/lf_image_codec.h"

namespace lf {

inline constexpr long long kMostPixels = 1LL << 30;
inline constexpr int kMostLevels = 5;
// The encoder makes tiles of 1024x1024 pixels, a size chosen by measurement (doc/codec.md). The
// decoder reads tiles of any size from 2^kLeastTileBits to 2^kMostTileBits.
inline constexpr int kTileBits = 10;
inline constexpr int kLeastTileBits = 6, kMostTileBits = 12;
inline constexpr uint64_t kMostReferenceCount = 4;

struct CodeHead {
  CodeInfo info;
  // Tiles have 2^tile_bits x 2^tile_bits pixels; those at the right and lower border may be
  // smaller.
  int tile_bits = kTileBits;

  // The profiles kDefault and kLossless use these fields.
  int coefficient_bytes = 2;  // size of a coefficient, 2 or 4
  int fraction_bits = 0;      // fraction bits that pixel values get before the first transform
  // Quantiser steps by component. Each component has one step for its approximation, then two for
  // each level from the coarsest to the finest: the first is for the two subbands that are high in
  // one direction, the second for the subband that is high in both.
  std::vector<int32_t> steps;

  // Bytes that describe how the image is predicted from others (prediction_code.h), in the encoded
  // image that the head was read from; empty if it is not.
  std::string_view prediction;
  bool is_predicted() const { return info.reference_count > 0; }

  // The profile kThesis uses these fields.
  int quantizer = 256;  // CodecSettings::quantizer
  // Coefficients that the quantiser's first and last value stand for, in units of 2^-kHaarBits
  // (haar.h).
  int64_t low = 0;
  int64_t high = 0;

  int tile_size() const { return 1 << tile_bits; }
  int columns() const { return (info.width + tile_size() - 1) / tile_size(); }
  int rows() const { return (info.height + tile_size() - 1) / tile_size(); }
  size_t tile_count() const { return static_cast<size_t>(columns()) * rows(); }
  // Returns the pixels of a tile. Tiles are numbered row by row, from 0 to tile_count() - 1.
  PixelRect TileRect(size_t tile) const;

  // Number of planes that are transformed independently: 1 for grey, 3 for RGB, 4 for a mosaic.
  int components() const;
  int StepCount() const { return components() * (1 + 2 * info.levels); }
};

int ChannelsOf(PixelLayout layout);  // number of channels of a pixel

void AppendHead(const CodeHead& head, std::string* code);
// Reads the head from the front of `code` and removes it there. kInput if `code` is no encoded
// image, or if its head is damaged or was written by a newer version; the message does not name the
// file.
Result<CodeHead> TakeHead(std::string_view* code);

}  // namespace lf
