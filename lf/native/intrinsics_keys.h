// The intrinsics of transforms.json: keys that stand at the top level and may be overridden in
// each frame. Internal to native.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/native/distortion_keys.h"
#include "lf/native/json_fields.h"

namespace lf {

// As written; each may be missing.
struct IntrinsicsKeys {
  std::optional<double> fl_x, fl_y;                      // px
  std::optional<double> camera_angle_x, camera_angle_y;  // rad, the whole field of view
  std::optional<double> cx, cy;                          // px
  std::optional<double> w, h;                            // px
  std::optional<double> lf_skew;                         // px
  std::optional<std::array<double, 3>> lf_vignetting;
  DistortionKeys distortion;

  friend bool operator==(const IntrinsicsKeys&, const IntrinsicsKeys&) = default;
};

// Of equal keys the same.
uint64_t HashOfIntrinsicsKeys(const IntrinsicsKeys& keys);

// Every value in its range.
Result<IntrinsicsKeys> ReadIntrinsicsKeys(const JsonFields& fields);

// Key by key the frame's value, else the top level's. The focal length is fl_x, else that of
// camera_angle_x; fl_y, else that of camera_angle_y, else the one along x. The principal point is
// the image centre unless given.
//   default_size  [width, height], asked for where neither gives w or h; its error is returned
//   fields        for messages
// kInput: no focal length, a distortion that is unclear (ResolveDistortion), a vignetting that
// leaves no light somewhere in the image.
using SizeSource = std::function<Result<std::array<int, 2>>()>;
Result<Intrinsics> ResolveIntrinsics(const IntrinsicsKeys& frame, const IntrinsicsKeys& top,
                                     const SizeSource& default_size, const JsonFields& fields);

}  // namespace lf
