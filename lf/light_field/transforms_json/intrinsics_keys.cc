// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/transforms_json/intrinsics_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "lf/light_field/model/distinct_intrinsics.h"

namespace lf {
namespace {

constexpr double kMaxSize_px = 65536;
constexpr double kMaxPixelCount = 1 << 30;  // the limit of pixels/files/image_file.h

constexpr NumberRule kFocal = {"a number of pixels from 0.001 to 1e7",
                               [](double x) { return x >= 0.001 && x <= 1e7; }};
constexpr NumberRule kAngle = {"an angle in radians above 1e-6 and below pi",
                               [](double x) { return x > 1e-6 && x < 3.1415; }};
constexpr NumberRule kPrincipal = {"a number of pixels within +-1e7",
                                   [](double x) { return std::abs(x) <= 1e7; }};
constexpr NumberRule kSize = {"a whole number of pixels from 1 to 65536", [](double x) {
                                return x >= 1 && x <= kMaxSize_px && x == std::floor(x);
                              }};
constexpr NumberRule kSkew = {"a number of pixels within +-1e7",
                              [](double x) { return std::abs(x) <= 1e7; }};

constexpr NumberRule kVignetting = {"within +-1e6, such as [-0.3, 0.05, -0.1]",
                                    [](double x) { return std::abs(x) <= 1e6; }};

using Key = std::optional<double> IntrinsicsKeys::*;

// Returns the focal length along one axis, in pixels; none if no key states it. The frame's keys
// take precedence over those of the top level. At either level, the length takes precedence over
// the angle.
std::optional<double> Focal(const IntrinsicsKeys& frame, const IntrinsicsKeys& top, Key length,
                            Key angle, double size_px) {
  for (const IntrinsicsKeys* keys : {&frame, &top}) {
    if (keys->*length) return keys->*length;
    if (keys->*angle) return 0.5 * size_px / std::tan(0.5 * *(keys->*angle));
  }
  return std::nullopt;
}

// Reads a calibration matrix
//
//   [[fl_x, lf_skew, cx], [0, fl_y, cy], [0, 0, 1]]
//
// or its nine numbers in one list, under one of the names that other programs give it. Keys that
// state one of its numbers by itself take precedence.
Result<void> ReadMatrix(const JsonFields& fields, IntrinsicsKeys* keys) {
  for (const char* const name : {"K", "intrinsic_matrix"}) {
    if (!fields.Has(name)) continue;
    const bool is_flat = fields.ListSize(name).value_or(0) == 9;
    const auto matrix =
        is_flat ? fields.Numbers(name, 9, 9, kPrincipal) : fields.Matrix(name, 3, 3, 3, kPrincipal);
    if (!matrix) return matrix.error();
    const std::vector<double> k = matrix->value_or(std::vector<double>(9));
    if (k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1 || !kFocal.holds(k[0]) ||
        !kFocal.holds(k[4]))
      return fields.Wrong(name, "[[fx, skew, cx], [0, fy, cy], [0, 0, 1]], in pixels");
    const std::pair<Key, double> values[] = {{&IntrinsicsKeys::fl_x, k[0]},
                                             {&IntrinsicsKeys::fl_y, k[4]},
                                             {&IntrinsicsKeys::cx, k[2]},
                                             {&IntrinsicsKeys::cy, k[5]}};
    for (const auto& [key, value] : values)
      if (!(keys->*key)) keys->*key = value;
    if (!keys->lf_skew && k[1] != 0) keys->lf_skew = k[1];
    return {};
  }
  return {};
}

}  // namespace

uint64_t HashOfIntrinsicsKeys(const IntrinsicsKeys& keys) {
  constexpr double kMissing = 1e300;  // stands for a missing key; no key can have this value
  const DistortionKeys& distortion = keys.distortion;
  constexpr size_t kOthers = 14;
  std::array<double, kOthers + std::tuple_size_v<decltype(DistortionKeys::values)>> numbers = {
      static_cast<double>(distortion.camera_model.value_or(UINT8_MAX)),
      distortion.is_fisheye ? *distortion.is_fisheye : kMissing};
  size_t i = 2;
  for (const std::optional<double>& key :
       {keys.fl_x, keys.fl_y, keys.camera_angle_x, keys.camera_angle_y, keys.cx, keys.cy, keys.w,
        keys.h, keys.lf_skew})
    numbers[i++] = key.value_or(kMissing);
  for (size_t v = 0; v < 3; ++v)
    numbers[i++] = keys.lf_vignetting ? (*keys.lf_vignetting)[v] : kMissing;
  for (const std::optional<double>& value : distortion.values)
    numbers[i++] = value.value_or(kMissing);
  return HashOfNumbers(numbers);
}

Result<IntrinsicsKeys> ReadIntrinsicsKeys(const JsonFields& fields) {
  IntrinsicsKeys keys;
  LF_ASSIGN_OR_RETURN(keys.distortion, ReadDistortionKeys(fields));
  const struct {
    const char* name;
    Key key;
    const NumberRule& rule;
  } table[] = {
      {"fl_x", &IntrinsicsKeys::fl_x, kFocal},
      {"fl_y", &IntrinsicsKeys::fl_y, kFocal},
      {"camera_angle_x", &IntrinsicsKeys::camera_angle_x, kAngle},
      {"camera_angle_y", &IntrinsicsKeys::camera_angle_y, kAngle},
      {"cx", &IntrinsicsKeys::cx, kPrincipal},
      {"cy", &IntrinsicsKeys::cy, kPrincipal},
      {"w", &IntrinsicsKeys::w, kSize},
      {"h", &IntrinsicsKeys::h, kSize},
      {"lf_skew", &IntrinsicsKeys::lf_skew, kSkew},
  };
  for (const auto& row : table) {
    LF_ASSIGN_OR_RETURN(keys.*row.key, fields.Number(row.name, row.rule));
  }
  LF_RETURN_IF_ERROR(ReadMatrix(fields, &keys));
  LF_ASSIGN_OR_RETURN(const std::optional<std::vector<double>> vignetting,
                      fields.Numbers("lf_vignetting", 3, 3, kVignetting));
  if (vignetting) {
    keys.lf_vignetting.emplace();
    std::copy(vignetting->begin(), vignetting->end(), keys.lf_vignetting->begin());
  }
  return keys;
}

Result<Intrinsics> ResolveIntrinsics(const IntrinsicsKeys& frame, const IntrinsicsKeys& top,
                                     const SizeSource& default_size, const JsonFields& fields) {
  const auto value = [&](Key key) { return frame.*key ? frame.*key : top.*key; };
  std::optional<double> width = value(&IntrinsicsKeys::w);
  std::optional<double> height = value(&IntrinsicsKeys::h);
  if (!width || !height) {
    using Size = std::array<int, 2>;
    LF_ASSIGN_OR_RETURN(const Size size, default_size());
    if (!width) width = size[0];
    if (!height) height = size[1];
  }
  if (*width * *height > kMaxPixelCount)
    return fields.Fault(fmt::format(
        "the images have {} x {} pixels: expected at most 2^30 pixels in total", *width, *height));

  const std::optional<double> fx =
      Focal(frame, top, &IntrinsicsKeys::fl_x, &IntrinsicsKeys::camera_angle_x, *width);
  if (!fx)
    return fields.Fault(
        "the focal length is missing: add \"fl_x\" in pixels or \"camera_angle_x\" in radians");
  const std::optional<double> fy =
      Focal(frame, top, &IntrinsicsKeys::fl_y, &IntrinsicsKeys::camera_angle_y, *height);

  Intrinsics intrinsics;
  intrinsics.width_px = static_cast<int>(*width);
  intrinsics.height_px = static_cast<int>(*height);
  intrinsics.fx_px = *fx;
  intrinsics.fy_px = fy.value_or(*fx);
  intrinsics.cx_px = value(&IntrinsicsKeys::cx).value_or(*width / 2);
  intrinsics.cy_px = value(&IntrinsicsKeys::cy).value_or(*height / 2);
  intrinsics.skew_px = value(&IntrinsicsKeys::lf_skew).value_or(0);
  LF_ASSIGN_OR_RETURN(intrinsics.distortion,
                      ResolveDistortion(frame.distortion, top.distortion, fields));
  const auto& vignetting = frame.lf_vignetting ? frame.lf_vignetting : top.lf_vignetting;
  if (vignetting) intrinsics.vignetting.v = *vignetting;
  if (!IsFalloff(intrinsics)) {
    const FalloffRange range = FalloffRangeOf(intrinsics);
    return fields.Fault(
        fmt::format("\"lf_vignetting\" is [{}], which multiplies the light by {:.3g} to {:.3g} in "
                    "images of {} x {} pixels: expected factors from 1/64 to 64 everywhere in the "
                    "image (r is the distance from the principal point, in halves of the diagonal)",
                    fmt::join(intrinsics.vignetting.v, ", "), range.min, range.max,
                    intrinsics.width_px, intrinsics.height_px));
  }
  return intrinsics;
}

}  // namespace lf
