// The lens distortion of transforms.json: camera_model and its parameters, which stand at the top
// level and may be overridden in each frame, key by key. Internal to native.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "lf/camera/distortion.h"
#include "lf/core/result.h"
#include "lf/native/json_fields.h"

namespace lf {

// The key of every parameter of a model, in the order of Distortion::parameters.
std::span<const char* const> ParameterKeys(DistortionModel model);

// The camera model as COLMAP and nerfstudio name it. Its parameters are the first ones of
// ParameterKeys(model); those that follow are 0.
struct CameraModelName {
  const char* name;
  DistortionModel model;
  size_t parameter_count;
};

// The name a distortion is written with: PINHOLE, OPENCV, FULL_OPENCV, OPENCV_FISHEYE, FOV,
// DIVISION, EUCM, THIN_PRISM_FISHEYE or RAD_TAN_THIN_PRISM_FISHEYE. parameter_count is that of the
// parameters to be written; OPENCV has k3 only if it is not 0.
CameraModelName CameraModelOf(const Distortion& distortion);

// As written; each may be missing.
struct DistortionKeys {
  std::optional<uint8_t> camera_model;  // into the list of names
  std::optional<bool> is_fisheye;       // instant-ngp
  std::array<std::optional<double>, 19> values;

  friend bool operator==(const DistortionKeys&, const DistortionKeys&) = default;
};

// kInput: an unknown camera model, a parameter beyond +-1e6, an omega outside [0, pi).
Result<DistortionKeys> ReadDistortionKeys(const JsonFields& fields);

// Key by key the frame's value, else the top level's, else 0. Without a camera_model OPENCV, or
// OPENCV_FISHEYE with is_fisheye. Radial-tangential models whose parameters all are 0 have no
// distortion.
// kInput: a parameter that is not 0 and that the model does not have, an is_fisheye against the
// model, a FOV without omega. `fields` is for messages.
Result<Distortion> ResolveDistortion(const DistortionKeys& frame, const DistortionKeys& top,
                                     const JsonFields& fields);

}  // namespace lf
