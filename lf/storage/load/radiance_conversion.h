// SPDX-License-Identifier: Apache-2.0
// Converts stored values of image files to radiance, a whole picture at a time.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// RadianceTable() of each colour [colour][8-bit value], in the form that the conversion of 8-bit
// RGB uses: the entries of a pixel's three colours, combined with |, are the four lanes R, G, B, 1
// of LfPixels.
using LaneTable = std::array<std::array<uint64_t, 256>, 3>;

// Tables that convert stored values of 8 and 16 bits to radiance, for one encoding and the gains of
// one LF image. A table is empty if integers of its number of bits cannot hold the black and white
// level.
class RadianceTables {
 public:
  RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains);
  // Makes only the tables for files with `bits` bits per value; the other tables stay empty.
  RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains, int bits);

  // These functions return the table of a channel; null if it is empty. The channels share one
  // table if all gains are equal.
  const uint16_t* of_8bit(int channel) const { return TableOf(of_8bit_, channel); }
  const uint16_t* of_16bit(int channel) const { return TableOf(of_16bit_, channel); }
  const LaneTable& lanes() const { return lanes_; }

 private:
  using Tables = std::vector<std::vector<uint16_t>>;  // one table for all channels, or one for each
  static const uint16_t* TableOf(const Tables& tables, int channel) {
    if (tables.empty()) return nullptr;
    return tables[tables.size() == 1 ? 0 : static_cast<size_t>(channel)].data();
  }

  Tables of_8bit_;
  Tables of_16bit_;
  LaneTable lanes_{};
};

using RowsDone = std::function<void(int row_count)>;

// Computes the radiance of pixels->rect, which lies in part.rect. Integers are converted by tables,
// floats are quantised; if the camera has a falloff, every pixel is converted as QuantizeRadiance()
// does. Writes all lanes, and masks nothing. Integers of the part must be able to hold the black
// and white level.
//   colours    number of channels that are used: 1 (grey or mosaic) or 3 (R, G, B)
//   plain      the tables for gain 1; tables for other gains are made when needed
//   camera     LF camera whose gains are used
//   k          intrinsics of the camera, for the falloff
//   rows_done  called with the number of complete rows, after the last row and sometimes earlier;
//              may be null
void ConvertRadiance(const ImagePart& part, int colours, const RadianceTables& plain,
                     const RadianceEncoding& encoding, const LfCamera& camera, const Intrinsics& k,
                     LfPixels* pixels, const RowsDone& rows_done = nullptr);

}  // namespace lf
