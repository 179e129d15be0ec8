// Moves a light field into another world: scaled, rotated and translated.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// x_b = scale * rotation * x_a + translation; scale > 0.
struct Similarity {
  double scale = 1;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();
};

// Parses 16 numbers, the rows of a 4x4 matrix, separated by blanks, lines, commas, semicolons or
// brackets: text files of CloudCompare and NumPy, or lists in JSON. A matrix within 1e-3 of a scale
// times a rotation is replaced by the nearest such matrix, since files are often written with few
// digits.
// kInput, without the place in the file: another count, numbers beyond 1e12, a last row other than
// 0 0 0 1, a mirrored axis, shear, different scales along the axes.
// other than 0 0 0 1, a mirrored axis, shear, different scales along the axes.
Result<Similarity> ParseSimilarity(std::string_view text);

// Parses the text itself if it is the 16 numbers, or else the file of that name, of at most 64 KiB.
Result<Similarity> ReadSimilarity(const std::string& text_or_file);

// Transforms poses and depth range from world a to world b; pixels see the same points. unit_m is
// unchanged. kInput: a position beyond 1e12.
Result<void> Transform(const Similarity& b_from_a, LightField* light_field);

}  // namespace lf
