// Another world for the same light field: scaled, turned and moved.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lf/capture/light_field.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// x_b = scale * rotation * x_a + translation; scale > 0.
struct Similarity {
  double scale = 1;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();
};

// 16 numbers, the rows of a 4x4 matrix, separated by blanks, lines, commas, semicolons or brackets:
// the text files of CloudCompare and NumPy, lists in JSON.
// A matrix within 1e-3 of a scale times a rotation is taken as the nearest such one, since files
// are often written with few digits.
// kInput, with what is wrong but without the place: another count, numbers beyond 1e12, a last row
// other than 0 0 0 1, a mirrored axis, shear, different scales along the axes.
Result<Similarity> ParseSimilarity(std::string_view text);

// The same of a file of at most 64 KiB, if `text` is not the 16 numbers itself.
Result<Similarity> ReadSimilarity(const std::string& text_or_file);

// Moves the light field to the world b: poses and depth range; pixels see what they saw. unit_m is
// left as it is. kInput: a position beyond 1e12.
Result<void> Transform(const Similarity& b_from_a, LightField* light_field);

}  // namespace lf
