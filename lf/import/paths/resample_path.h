// SPDX-License-Identifier: Apache-2.0
// Changes the number of frames of a camera path.
#pragma once

#include <cstdint>
#include <optional>

#include "lf/camera/path/camera_path.h"
#include "lf/core/result.h"

namespace lf {

// Returns the path with another frame rate, another number of frames, or both.
//   fps          alone, keeps the duration: the last frame is the last one that the old path
//                reaches
//   frame_count  spreads the frames evenly from the first camera to the last; the frame rate is
//                kept unless fps is set
// With several views of each moment (CameraPath::views), this holds for the moments: fps is their
// rate, their number is frame_count divided by the views, and each view is interpolated with the
// same view of the neighbouring moments.
// A new frame at the time of an old one has the same camera, bit for bit. Between old frames,
// positions follow a Catmull-Rom curve, rotations the shorter arc, and other numbers monotone
// cubics, as keyframes do (motion.h). The shutter is kept, with the instants of AddShutter().
// kUsage: more than kMostFrames frames, or more than kMostInstants instants; the number of views
// does not divide frame_count.
Result<CameraPath> ResamplePath(const CameraPath& path, std::optional<double> fps,
                                std::optional<uint32_t> frame_count);

// Gives a path a shutter. The cameras of its instants are interpolated between those of the frames,
// as by ResamplePath(); instants before the first frame or after the last one have its camera.
// kUsage: more than kMostInstants instants; the path has several views of each moment.
Result<void> AddShutter(const Shutter& shutter, CameraPath* path);

}  // namespace lf
