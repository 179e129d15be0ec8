// The camera models of COLMAP. Internal to colmap.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"

namespace lf {

struct ColmapCameraModel {
  std::string_view name;
  int number;           // in cameras.bin
  int parameter_count;  // 0: not supported

  bool is_supported() const { return parameter_count > 0; }
};

inline constexpr int kMaxColmapParameterCount = 16;

// By the number of cameras.bin, or the name of cameras.txt. kInput, naming the model and saying
// what to do, if it is unknown or cannot be expressed as a Distortion.
Result<ColmapCameraModel> FindColmapCameraModel(int32_t number);
Result<ColmapCameraModel> FindColmapCameraModel(std::string_view name);

// Focal length, principal point and distortion from the parameters, in COLMAP's order. A distortion
// that bends nothing becomes DistortionModel::kNone.
// kInput: a size of 0 or beyond 65536, more than 2^30 pixels, a number that is not finite or out of
// range (the message has no place: the caller knows it).
//   parameters  model.parameter_count numbers
Result<Intrinsics> IntrinsicsOfColmap(const ColmapCameraModel& model, uint64_t width,
                                      uint64_t height, std::span<const double> parameters);

}  // namespace lf
