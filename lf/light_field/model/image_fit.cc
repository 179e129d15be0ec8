// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/image_fit.h"

#include <fmt/format.h>

#include <cmath>

#include "lf/pixels/files/upright.h"

namespace lf {
namespace {

// Returns a remedy for a picture that does not have the calibrated size.
std::string Advice(const ImageFileInfo& info, bool is_mosaic, const Intrinsics& k) {
  if (info.width == k.height_px && info.height == k.width_px)
    return is_mosaic ? "mosaics cannot be rotated: calibrate them as they are stored"
                     : "it is rotated by 90 degrees, without an orientation tag: use the images "
                       "that were calibrated";
  const double factor = static_cast<double>(info.width) / k.width_px;
  // Undistortion cuts off some pixels on each side and roughly keeps the aspect ratio.
  constexpr double kLeastOfCrops = 0.9;
  if (factor >= kLeastOfCrops && factor < 1 && info.height <= k.height_px)
    return fmt::format(
        "{} columns and {} rows are missing: it is cropped, as undistortion does, or resized by "
        "{:.4g}: use the images that were calibrated, or the calibration of these",
        k.width_px - info.width, k.height_px - info.height, factor);
  if (std::abs(k.height_px * factor - info.height) <= 1)
    return fmt::format(
        "it is resized by {:.4g}: use the images that were calibrated, or multiply w, h, fl_x, "
        "fl_y, cx, cy and lf_skew in transforms.json by {:.4g}",
        factor, factor);
  return "it is cropped, or of another camera: use the images that were calibrated";
}

}  // namespace

Result<ImageFit> FitToCalibration(const ImageFileInfo& info, bool is_mosaic,
                                  const Intrinsics& calibrated, const std::string& name) {
  if (info.width == calibrated.width_px && info.height == calibrated.height_px)
    return ImageFit::kAsStored;
  if (!is_mosaic && TurnsByQuarter(info.orientation) && info.width == calibrated.height_px &&
      info.height == calibrated.width_px)
    return ImageFit::kTurned;
  return InputError(fmt::format("{}: has {} x {} pixels, but the calibration says {} x {}; {}",
                                name, info.width, info.height, calibrated.width_px,
                                calibrated.height_px, Advice(info, is_mosaic, calibrated)));
}

}  // namespace lf
