// SPDX-License-Identifier: Apache-2.0
// The colour spaces that frames in linear light may have: their primaries, and the conversion from
// the one that Develop() gives.
#pragma once

#include <optional>
#include <string_view>

#include "lf/core/geometry.h"
#include "lf/core/image.h"

namespace lf {

enum class ColourSpace {
  kRec709,   // "rec709": primaries of ITU-R BT.709 and sRGB, white D65; Develop() gives it
  kRec2020,  // "rec2020": primaries of ITU-R BT.2020, white D65
  kAcesCg,   // "acescg": primaries AP1 and white of S-2014-004 (ACEScg)
};

// Parses "rec709", "rec2020" or "acescg"; none for any other text.
std::optional<ColourSpace> ParseColourSpace(std::string_view name);
const char* NameOf(ColourSpace space);

// CIE 1931 chromaticities (x, y) of red, green, blue and white.
struct Primaries {
  Vec2 red;
  Vec2 green;
  Vec2 blue;
  Vec2 white;
};
Primaries PrimariesOf(ColourSpace space);

// Returns the matrix from linear light in one space to another. White stays white: if the white
// points differ, the light is adapted by Bradford's method,
//
//   M = Z_to^-1 B^-1 diag(B w_to / B w_from) B Z_from
//
// where Z_s converts RGB in space s to CIE XYZ, w_s is the XYZ of its white, and B is Bradford's
// cone matrix (Lam 1985; ICC.1:2022, Annex E).
Mat3 LinearFromLinear(const Primaries& to, const Primaries& from);

// Multiplies the first three channels of every pixel by a matrix.
void Multiply(const Mat3& matrix, Image<float>* rgb);

// Converts linear light [height][width][3] from kRec709 to another space; to kRec709 it stays as it
// is.
void ConvertFromRec709(ColourSpace to, Image<float>* rgb);

// Converts linear light [height][width][3 or more] to kRec709. Channels after the third stay.
void ConvertToRec709(ColourSpace from, Image<float>* rgb);

}  // namespace lf
