// The intrinsics of transforms.json: keys that stand at the top level and may be overridden in
// each frame. Internal to capture.
#pragma once

#include <compare>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/capture/json_fields.h"
#include "lf/core/result.h"

namespace lf {

// As written; each may be missing.
struct IntrinsicsKeys {
  std::optional<double> fl_x, fl_y;                      // px
  std::optional<double> camera_angle_x, camera_angle_y;  // rad, the whole field of view
  std::optional<double> cx, cy;                          // px
  std::optional<double> w, h;                            // px

  friend auto operator<=>(const IntrinsicsKeys&, const IntrinsicsKeys&) = default;
};

// Every value in its range. kInput also for lens distortion and camera models other than the
// pinhole.
Result<IntrinsicsKeys> ReadIntrinsicsKeys(const JsonFields& fields);

// Key by key the frame's value, else the top level's. The focal length is fl_x, else that of
// camera_angle_x; fl_y, else that of camera_angle_y, else the one along x. The principal point is
// the image centre unless given.
// kInput: no size or no focal length. `fields` is for messages.
Result<Intrinsics> ResolveIntrinsics(const IntrinsicsKeys& frame, const IntrinsicsKeys& top,
                                     const JsonFields& fields);

}  // namespace lf
