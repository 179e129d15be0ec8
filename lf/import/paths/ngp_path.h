// SPDX-License-Identifier: Apache-2.0
// Reads and writes camera paths of instant-ngp, base_cam.json (doc/formats/foreign_paths.md):
//
//   {"path": [{"R": [x, y, z, w], "T": [x, y, z], "slice": 0, "scale": 1.5, "fov": 50.625,
//              "aperture_size": 0, "timestamp": 0.5}, ...],
//    "loop": false, "spline_order": 3, "duration_seconds": 1}
//
// A point x of a transforms.json is at 0.33 x + 0.5 in instant-ngp's space, where its coordinates
// y, z, x are the axes. The camera's axes are right, down, forward. fov is the vertical field of
// view in degrees, slice + scale the focus distance and aperture_size the radius of the lens.
// Internal to this folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "lf/core/result.h"
#include "lf/import/paths/foreign_path.h"

namespace lf {

// The space of instant-ngp: scale and offset.
struct NgpSpace {
  double scale = 0.33;
  Vec3 offset = Vec3::Constant(0.5);
};

// Returns the similarity from the world to a space.
Similarity NgpFromWorld(const NgpSpace& space);

// Returns the space that the options state or, for what they do not state, the keys `scale` and
// `offset` of the first transforms.json among options.light_field and that beside `file`.
Result<NgpSpace> NgpSpaceFor(const std::filesystem::path& file, const PathOptions& options);

// Reads a text, evaluates the curve through the keyframes at frames i / n of the duration, as
// instant-ngp films it, and undoes the space. A file that we wrote states scale, offset, resolution
// and frames; its keyframes are the frames.
//   space  used if the file states none
// kInput names the file and the frame, the value found and what was expected.
Result<ForeignPath> ParseNgpPath(std::string_view text, const std::filesystem::path& file,
                                 const PathOptions& options, const NgpSpace& space);
Result<ForeignPath> ReadNgpPath(const std::filesystem::path& file, const PathOptions& options);

// Returns the text of a file whose keyframes are the cameras of the frames: instant-ngp films them
// if it is asked for as many frames. Focus and diameter of the lens are kept; blades and tilt,
// which instant-ngp does not have, stand in our keys only.
std::string NgpText(const CameraPath& path, const NgpSpace& space);

}  // namespace lf
