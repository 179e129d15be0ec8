// Stored values of image files into radiance, a whole picture at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lf/capture/lf_pixels.h"
#include "lf/capture/light_field.h"
#include "lf/capture/radiance.h"
#include "lf/imageio/image_file.h"

namespace lf {

// RadianceTable() by colour as the kernels want a pixel: the three words of its colours, combined
// with |, are the four lanes R, G, B, 1 of LfPixels.
using LaneTable = std::array<std::array<uint64_t, 256>, 3>;

// The tables of one encoding and of the gains of an image. Those of bits that the levels do not fit
// are empty.
class RadianceTables {
 public:
  RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains);
  // For files of one type alone; the others stay empty.
  RadianceTables(const RadianceEncoding& encoding, const ChannelGains& gains, int bits);

  // Equal gains share a table.
  const uint16_t* of_8bit(int channel) const { return TableOf(of_8bit_, channel); }
  const uint16_t* of_16bit(int channel) const { return TableOf(of_16bit_, channel); }
  const LaneTable& lanes() const { return lanes_; }

 private:
  using Tables = std::vector<std::vector<uint16_t>>;  // one, or one for each channel
  static const uint16_t* TableOf(const Tables& tables, int channel) {
    if (tables.empty()) return nullptr;
    return tables[tables.size() == 1 ? 0 : static_cast<size_t>(channel)].data();
  }

  Tables of_8bit_;
  Tables of_16bit_;
  LaneTable lanes_{};
};

// The radiance of pixels->rect, which lies in part.rect: through tables, floats quantised; by
// QuantizeRadiance() pixel by pixel where the camera has a falloff. All lanes are written, nothing
// is masked. The levels must fit the integers.
//   colours  1: grey or mosaic; 3: the first three channels
//   plain    the tables of gain 1; those of other gains are made
//   camera   for its gains
//   k        of the camera, for its falloff
void ConvertRadiance(const ImagePart& part, int colours, const RadianceTables& plain,
                     const RadianceEncoding& encoding, const LfCamera& camera, const Intrinsics& k,
                     LfPixels* pixels);

}  // namespace lf
