// SPDX-License-Identifier: Apache-2.0
// The lens distortion of transforms.json: camera_model and its parameters. They are keys of the top
// level; each frame may override any of them. Internal to this folder.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "lf/camera/distortion.h"
#include "lf/core/result.h"
#include "lf/light_field/transforms_json/json_fields.h"

namespace lf {

// Returns the keys of the parameters of a model, in the order of Distortion::parameters.
std::span<const char* const> ParameterKeys(DistortionModel model);

// A camera model as COLMAP and nerfstudio name it. Its parameters are the first parameter_count
// keys of ParameterKeys(model); the remaining parameters are 0.
struct CameraModelName {
  const char* name;
  DistortionModel model;
  size_t parameter_count;
};

// Returns the name with which a distortion is written: PINHOLE, OPENCV, FULL_OPENCV,
// OPENCV_FISHEYE, FOV, DIVISION, EUCM, THIN_PRISM_FISHEYE, RAD_TAN_THIN_PRISM_FISHEYE or BROWN.
// parameter_count is the number of parameters to write; OPENCV has k3 only if it is not 0.
CameraModelName CameraModelOf(const Distortion& distortion);

// The keys of the top level or of one frame, as written; nullopt for a missing key.
struct DistortionKeys {
  std::optional<uint8_t> camera_model;  // index into kModels of distortion_keys.cc
  std::optional<bool> is_fisheye;       // key of a file for instant-ngp
  // The parameters, in the order of kKeys in distortion_keys.cc.
  std::array<std::optional<double>, 19> values;

  friend bool operator==(const DistortionKeys&, const DistortionKeys&) = default;
};

// Reads the keys. kInput: a value of another type, an unknown camera model, a parameter beyond
// +-1e6, an omega outside [0, 3.1415).
Result<DistortionKeys> ReadDistortionKeys(const JsonFields& fields);

// Returns the distortion of a frame. Takes each key from the frame, or from the top level if the
// frame lacks it; a parameter that both lack is 0. A missing camera_model means OPENCV, or
// OPENCV_FISHEYE if is_fisheye is true. Radial-tangential and division models whose parameters are
// all 0, and EUCM with alpha 0, become kNone. kInput: a nonzero parameter that the model does not
// have, an is_fisheye that contradicts the model, a FOV without omega, an alpha or beta of EUCM out
// of range. `fields` is for messages.
Result<Distortion> ResolveDistortion(const DistortionKeys& frame, const DistortionKeys& top,
                                     const JsonFields& fields);

}  // namespace lf
