// Stored values of image files into radiance, a whole picture at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lf/capture/lf_pixels.h"
#include "lf/capture/radiance.h"
#include "lf/imageio/image_file.h"

namespace lf {

// RadianceTable() by colour as the kernels want a pixel: the three words of its colours, combined
// with |, are the four lanes R, G, B, 1 of LfPixels.
using LaneTable = std::array<std::array<uint64_t, 256>, 3>;

// The tables of one encoding and gain. Those of bits that the levels do not fit are empty.
class RadianceTables {
 public:
  RadianceTables(const RadianceEncoding& encoding, double gain);
  // For files of one type alone; the others stay empty.
  RadianceTables(const RadianceEncoding& encoding, double gain, int bits);

  const std::vector<uint16_t>& of_8bit() const { return of_8bit_; }
  const std::vector<uint16_t>& of_16bit() const { return of_16bit_; }
  const LaneTable& lanes() const { return lanes_; }

 private:
  std::vector<uint16_t> of_8bit_;
  std::vector<uint16_t> of_16bit_;
  LaneTable lanes_{};
};

// The radiance of pixels->rect, which lies in part.rect: through tables, floats quantised. All
// lanes are written, nothing is masked. The levels must fit the integers.
//   colours  1: grey or mosaic; 3: the first three channels
//   plain    the tables of gain 1; those of another gain are made
void ConvertRadiance(const ImagePart& part, int colours, const RadianceTables& plain,
                     const RadianceEncoding& encoding, double gain, LfPixels* pixels);

}  // namespace lf
