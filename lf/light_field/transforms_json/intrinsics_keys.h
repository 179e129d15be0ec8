// SPDX-License-Identifier: Apache-2.0
// The intrinsics of transforms.json: keys of the top level, which each frame may override. Internal
// to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/light_field/transforms_json/distortion_keys.h"
#include "lf/light_field/transforms_json/json_fields.h"

namespace lf {

// The keys of the top level or of one frame, as written; nullopt for a missing key.
struct IntrinsicsKeys {
  std::optional<double> fl_x, fl_y;                      // focal lengths, px
  std::optional<double> camera_angle_x, camera_angle_y;  // whole field of view along x and y, rad
  std::optional<double> cx, cy;                          // principal point, px
  std::optional<double> w, h;                            // size of the image, px
  std::optional<double> lf_skew;                         // skew of the calibration matrix, px
  std::optional<std::array<double, 3>> lf_vignetting;    // Vignetting::v
  DistortionKeys distortion;

  friend bool operator==(const IntrinsicsKeys&, const IntrinsicsKeys&) = default;
};

// Returns equal hashes for equal keys.
uint64_t HashOfIntrinsicsKeys(const IntrinsicsKeys& keys);

// Reads the keys. Focal lengths, principal point and skew may be stated by a 3x3 matrix "K" or
// "intrinsic_matrix" instead. kInput if a value has another type or is out of its range.
Result<IntrinsicsKeys> ReadIntrinsicsKeys(const JsonFields& fields);

// Returns the intrinsics of a frame. Takes each key from the frame, or from the top level if the
// frame lacks it. The focal length along x is computed from the first of these keys that exists:
// fl_x of the frame, camera_angle_x of the frame, fl_x of the top level, camera_angle_x of the top
// level. The focal length along y is computed from the corresponding keys; without them, it equals
// the focal length along x. The principal point is the image centre by default.
//   default_size  returns [width, height]; called if w or h is missing; its error is returned
//   fields        for messages
// kInput: no focal length; an invalid distortion (ResolveDistortion()); more than 2^30 pixels; a
// vignetting that is no falloff (IsFalloff()).
using SizeSource = std::function<Result<std::array<int, 2>>()>;
Result<Intrinsics> ResolveIntrinsics(const IntrinsicsKeys& frame, const IntrinsicsKeys& top,
                                     const SizeSource& default_size, const JsonFields& fields);

}  // namespace lf
