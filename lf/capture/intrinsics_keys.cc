#include "lf/capture/intrinsics_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace lf {
namespace {

constexpr double kMaxSize_px = 65536;
constexpr double kMaxPixelCount = 1 << 30;  // as imageio/image_file.h

constexpr NumberRule kFocal = {"a number of pixels from 0.001 to 1e7",
                               [](double x) { return x >= 0.001 && x <= 1e7; }};
constexpr NumberRule kAngle = {"an angle in radians above 1e-6 and below pi",
                               [](double x) { return x > 1e-6 && x < 3.1415; }};
constexpr NumberRule kPrincipal = {"a number of pixels within +-1e7",
                                   [](double x) { return std::abs(x) <= 1e7; }};
constexpr NumberRule kSize = {"a whole number of pixels from 1 to 65536", [](double x) {
                                return x >= 1 && x <= kMaxSize_px && x == std::floor(x);
                              }};
constexpr NumberRule kAnyNumber = {"a number", [](double) { return true; }};

constexpr const char* kDistortionKeys[] = {"k1", "k2", "k3", "k4", "k5", "k6", "p1", "p2"};
constexpr const char* kPinholeModels[] = {"PINHOLE", "SIMPLE_PINHOLE", "OPENCV"};

Result<void> CheckIsPinhole(const JsonFields& fields) {
  constexpr const char* kAdvice =
      "lens distortion is not supported yet: undistort the images first (e.g. COLMAP "
      "image_undistorter)";
  for (const char* key : kDistortionKeys) {
    LF_ASSIGN_OR_RETURN(const std::optional<double> value, fields.Number(key, kAnyNumber));
    if (value.value_or(0) != 0)
      return fields.Fault(fmt::format("\"{}\" is {}: {}", key, *value, kAdvice));
  }
  LF_ASSIGN_OR_RETURN(const std::optional<bool> is_fisheye, fields.Bool("is_fisheye"));
  if (is_fisheye.value_or(false))
    return fields.Fault(fmt::format("\"is_fisheye\" is true: {}", kAdvice));

  LF_ASSIGN_OR_RETURN(const std::optional<std::string> model, fields.Text("camera_model"));
  if (model && std::find(std::begin(kPinholeModels), std::end(kPinholeModels), *model) ==
                   std::end(kPinholeModels))
    return fields.Wrong("camera_model",
                        "PINHOLE, SIMPLE_PINHOLE or OPENCV without distortion; other models must "
                        "be undistorted first (e.g. COLMAP image_undistorter)");
  return {};
}

using Key = std::optional<double> IntrinsicsKeys::*;

// The focal length along one axis: lengths before angles, the frame before the top level.
std::optional<double> Focal(const IntrinsicsKeys& frame, const IntrinsicsKeys& top, Key length,
                            Key angle, double size_px) {
  for (const IntrinsicsKeys* keys : {&frame, &top}) {
    if (keys->*length) return keys->*length;
    if (keys->*angle) return 0.5 * size_px / std::tan(0.5 * *(keys->*angle));
  }
  return std::nullopt;
}

}  // namespace

Result<IntrinsicsKeys> ReadIntrinsicsKeys(const JsonFields& fields) {
  LF_RETURN_IF_ERROR(CheckIsPinhole(fields));
  IntrinsicsKeys keys;
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
  };
  for (const auto& row : table) {
    LF_ASSIGN_OR_RETURN(keys.*row.key, fields.Number(row.name, row.rule));
  }
  return keys;
}

Result<Intrinsics> ResolveIntrinsics(const IntrinsicsKeys& frame, const IntrinsicsKeys& top,
                                     const JsonFields& fields) {
  const auto value = [&](Key key) { return frame.*key ? frame.*key : top.*key; };
  const std::optional<double> width = value(&IntrinsicsKeys::w);
  const std::optional<double> height = value(&IntrinsicsKeys::h);
  if (!width || !height)
    return fields.Fault(
        "the image size is missing: add \"w\" and \"h\", in pixels, at the top level "
        "(e.g. \"w\": 800, \"h\": 800)");
  if (*width * *height > kMaxPixelCount)
    return fields.Fault(
        fmt::format("images of {} x {} pixels are beyond the limit of 2^30", *width, *height));

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
  return intrinsics;
}

}  // namespace lf
