// SPDX-License-Identifier: Apache-2.0
// The camera models of COLMAP. Used by the readers of models, and of kapture.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"

namespace lf {

struct ColmapCameraModel {
  std::string_view name;
  int number;           // the model's number in cameras.bin
  int parameter_count;  // number of the model's parameters; 0: the model is not supported

  bool is_supported() const { return parameter_count > 0; }
};

inline constexpr int kMaxColmapParameterCount = 16;

// Finds a model by its number in cameras.bin or its name in cameras.txt. kInput if the model is
// unknown or cannot be expressed as a Distortion; the message names the model and a remedy.
Result<ColmapCameraModel> FindColmapCameraModel(int32_t number);
Result<ColmapCameraModel> FindColmapCameraModel(std::string_view name);

// Converts the parameters, in COLMAP's order, to focal length, principal point and distortion. A
// distortion whose parameters bend no ray becomes DistortionModel::kNone.
//   parameters  model.parameter_count numbers
// kInput: a width or height of 0 or above 65536, more than 2^30 pixels, a number that is not finite
// or out of range. The message does not name the place in the file; the caller adds it.
Result<Intrinsics> IntrinsicsOfColmap(const ColmapCameraModel& model, uint64_t width,
                                      uint64_t height, std::span<const double> parameters);

}  // namespace lf
