// SPDX-License-Identifier: Apache-2.0
// Writes depth maps as files (doc/focus.md).
#pragma once

#include <filesystem>
#include <optional>

#include "lf/analysis/depth/depth_map.h"
#include "lf/core/image.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"

namespace lf {

enum class DepthFormat {
  // An EXR file with the sharp picture R G B (half, linear light), Z (float, world units along the
  // optical axis; infinity where unknown) and confidence (half).
  kExr,
  // A portable float map with Z as in EXR, rows from below, little-endian, as Middlebury's.
  kPfm,
  // A point cloud in binary PLY: x y z in the world (float), red green blue (sRGB), confidence
  // (float), of the elements whose depth is known.
  kPly,
  // A grey picture of 1 / Z for people: the nearest distance of the range is white, the farthest
  // and unknown elements are black.
  kPng,
};

// Returns the format of the extension .exr, .pfm, .ply or .png; nullopt for others.
std::optional<DepthFormat> DepthFormatOf(const std::filesystem::path& file);

// Writes the file atomically; its extension must be that of a format.
//   picture  the developed sharp picture of the map
//   is_filled  true: unknown elements have their filled depth
// kOutput: the file cannot be written.
Result<void> WriteDepth(const std::filesystem::path& file, const DepthMap& map,
                        const DevelopedFrame& picture, bool is_filled);

}  // namespace lf
