// SPDX-License-Identifier: Apache-2.0
// Computes the thin-lens cameras of a path from its description: those of all frames, or of single
// frames when they are asked for.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/path/path_description.h"
#include "lf/core/result.h"

namespace lf {

// The cameras of a path. Each camera is computed when it is asked for, with the bits that
// EvaluatePath() gives it. Takes the memory of the description, however many frames the path has.
// Several threads may use it at the same time.
class PathFrames {
 public:
  // Computes the openings of all frames if the blades turn while the lens closes
  // (blade_rotation_per_stop_rad) and the opening changes. Computes nothing else.
  explicit PathFrames(PathDescription path);
  // Holds cameras that are known, such as those of another program's file.
  explicit PathFrames(CameraPath path);

  size_t frame_count() const { return frames().count; }
  FrameNumbers frames() const;
  double fps() const { return whole_.fps; }
  double unit_m() const { return whole_.unit_m; }
  bool has_focal_surface() const { return whole_.focal_surface.has_value(); }
  const std::optional<FocalSurfaceSource>& focal_surface() const { return whole_.focal_surface; }
  // Returns true if the path states recording times (its key `time`).
  bool moves_through_time() const { return described_ && described_->recording; }
  // Returns the radius of the widest opening among all frames, from which the rotation of closing
  // blades is counted; 0 if it does not depend on it.
  double widest_radius_w() const { return widest_radius_w_; }

  // Returns the camera at the time of one of the frames(). kInput: an error of
  // EvaluatePath() at this frame. There is none after Check() has succeeded.
  Result<RenderCamera> Camera(FrameId frame) const;
  // Returns the cameras of `count` frames from `begin` on, and of their instants, as a path of
  // their own. Errors are those that EvaluatePath() would return for these frames.
  Result<CameraPath> Some(FrameId begin, size_t count) const;
  // Returns the error that EvaluatePath() would return. Computes every camera, but keeps none.
  //   is_stopped  called about a hundred times a second; kInterrupted once it returns true. May be
  //               empty
  Result<void> Check(const std::function<bool()>& is_stopped) const;

 private:
  Result<RenderCamera> Instant(FrameId frame, int instant) const;
  Result<void> CheckAll(const std::function<bool()>& is_stopped,
                        const std::function<Result<void>(FrameId)>& check) const;
  Result<RenderCamera> CameraAtTime(FrameId frame, double time_s) const;

  std::optional<PathDescription> described_;  // unset: `whole_` has all cameras
  CameraPath whole_;  // has no cameras, but the properties of the whole path, if described_ is set
  double widest_radius_w_ = 0;
};

// Returns the cameras of all frames: the camera with index i, from 0, has the state at time i /
// fps. With a shutter, also returns the cameras of the instants of every frame, each with the state
// at its own time: all quantities move while a frame is exposed. The instants of the first frames
// may be before time 0, where speeds continue backwards and keyframes hold their first value.
// Elements are squares. The principal point is the centre of the plate, unless camera.shift moves
// the plate.
//
// kInput, with frame, time, quantity and its position in the file, if at some frame or instant
// - a quantity is out of its range: an aperture below 0, a focus distance of 0, a tilt of 90
// degrees;
// - the camera is at the point that it looks at, or looks along `up`;
// - the focus point, or the point of the focus plane on the optical axis, is not before the lens;
// - the horizontal field of view is almost 0 or 180 degrees;
// - the aperture is wider than 1e9 world units;
// - lens.breathing is true and the focus distance does not exceed the focal length.
Result<CameraPath> EvaluatePath(const PathFrames& path);

}  // namespace lf
