// Converts stored values of image files to radiance, a whole picture at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lf/light_field/model/lf_pixels.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/files/image_file.h"

namespace lf {

// RadianceTable() of each colour, in the form that the conversion of 8-bit RGB uses: the three
// words of a pixel's colours, combined with |, are the four lanes R, G, B, 1 of LfPixels.
using LaneTable = std::array<std::array<uint64_t, 256>, 3>;

// Tables of one encoding and of the gains of an image. A table is empty if the levels do not fit
// its number of bits.
class RadianceTables {
 public:
  RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains);
  // Makes only the tables for files with `bits` bits per value; the other tables stay empty.
  RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains, int bits);

  // Return null if the levels do not fit the number of bits. If all gains are equal, the channels
  // share a table.
  const uint16_t* of_8bit(int channel) const { return TableOf(of_8bit_, channel); }
  const uint16_t* of_16bit(int channel) const { return TableOf(of_16bit_, channel); }
  const LaneTable& lanes() const { return lanes_; }

 private:
  using Tables = std::vector<std::vector<uint16_t>>;  // one table, or one for each channel
  static const uint16_t* TableOf(const Tables& tables, int channel) {
    if (tables.empty()) return nullptr;
    return tables[tables.size() == 1 ? 0 : static_cast<size_t>(channel)].data();
  }

  Tables of_8bit_;
  Tables of_16bit_;
  LaneTable lanes_{};
};

// Computes the radiance of pixels->rect, which lies in part.rect. Integers are converted by tables,
// floats are quantised; if the camera has a falloff, every pixel is converted as QuantizeRadiance()
// does. Writes all lanes, and masks nothing. The levels must fit the integers.
//   colours  1: grey or mosaic; 3: the first three channels
//   plain    the tables of gain 1; tables for other gains are made when needed
//   camera   the gains are taken from it
//   k        intrinsics of the camera, for the falloff
void ConvertRadiance(const ImagePart& part, int colours, const RadianceTables& plain,
                     const RadianceEncoding& encoding, const LfCamera& camera, const Intrinsics& k,
                     LfPixels* pixels);

}  // namespace lf
