// SPDX-License-Identifier: Apache-2.0
// Moves a light field into another world: scaled, rotated and translated.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "lf/core/geometry.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Maps a point x_a of world a to x_b = scale * rotation * x_a + translation in world b; scale > 0.
struct Similarity {
  double scale = 1;
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();
};

// Parses 16 numbers, the rows of a 4x4 matrix, separated by blanks, line ends, commas, semicolons
// or brackets, as in text files of CloudCompare and NumPy, or in JSON. A matrix within 1e-3 of a
// scale times a rotation is replaced by the nearest such matrix, because files often have few
// digits.
// kInput: another count; numbers beyond 1e12; a last row other than 0 0 0 1; a mirrored axis;
// shear; different scales along the axes; a scale outside 1e-9 to 1e9. The message does not name
// the place in the file; the caller adds it.
Result<Similarity> ParseSimilarity(std::string_view text);

// Parses the text itself if it states a similarity (ParseSimilarity()), otherwise the file of that
// name, which may have at most 64 KiB.
Result<Similarity> ReadSimilarity(const std::string& text_or_file);
// Returns the similarity of the options --transform ("": none) and --scale of programs, which
// scales after the transform.
Result<Similarity> ReadSimilarity(const std::string& text_or_file, double scale);

// Returns the pose in world b of a camera whose pose in world a is given. Camera coordinates grow
// by the scale, so that the camera still sees every point at the same pixel.
RigidTransform PoseIn(const Similarity& b_from_a, const RigidTransform& cam_from_a);

// Returns the similarity that maps world b back to world a.
Similarity InverseOf(const Similarity& b_from_a);

// Transforms poses and depth range from world a to world b, so that pixels still see the same
// points. unit_m is unchanged. kInput: a camera position beyond 1e12.
Result<void> Transform(const Similarity& b_from_a, LightField* light_field);

}  // namespace lf
