// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/defocus.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"

namespace lf {
namespace {

// The inverse depth of the focus plane along the rays of an LF camera. Along the direction (x, y,
// 1) in camera axes, the plane n . X = h has the inverse depth n . (x, y, 1) / h.
class FocusDepths {
 public:
  FocusDepths(const PinholeCamera& lf_camera, const Plane& focus_plane)
      : intrinsics_(lf_camera.intrinsics), map_(lf_camera.intrinsics.distortion) {
    const Vec3 normal = lf_camera.cam_from_world.rotation * focus_plane.normal;
    const double offset_w = focus_plane.offset_w + normal.dot(lf_camera.cam_from_world.translation);
    of_ideal_ = lf_camera.intrinsics.InverseMatrix().transpose() * (normal / offset_w);
  }

  // Writes the inverse depths at the centres of the pixels [x_begin, x_begin + row.size()) of row
  // y. They are exact at every kStep-th pixel, and linear between.
  void OfRow(int x_begin, int y, std::span<float> row) const {
    const int count = static_cast<int>(row.size());
    double from = At(x_begin, y);
    for (int begin = 0; begin < count; begin += kStep) {
      const double to = At(x_begin + begin + kStep, y);
      for (int i = begin; i < std::min(count, begin + kStep); ++i)
        row[static_cast<size_t>(i)] = static_cast<float>(from + (to - from) * (i - begin) / kStep);
      from = to;
    }
  }

 private:
  static constexpr int kStep = 16;

  double At(int x, int y) const {
    Vec3 ideal(x + 0.5, y + 0.5, 1);
    if (intrinsics_.has_distortion())
      ideal = IdealPosition(intrinsics_, map_, x + 0.5, y + 0.5).value_or(ideal);
    return of_ideal_.dot(ideal) / ideal.z();
  }

  const Intrinsics& intrinsics_;
  const DistortionMap map_;
  Vec3 of_ideal_;
};

// Returns the mean focal length.
double FocalPx(const Intrinsics& k) { return std::sqrt(std::abs(k.fx_px * k.fy_px)); }

}  // namespace

double DefocusUnitPx(int divisor, const Intrinsics& lf_camera, const Intrinsics& frame) {
  return std::max({1.0, static_cast<double>(divisor), FocalPx(lf_camera) / FocalPx(frame)});
}

NearbyDepths NearbyDepthsOf(const LfDepths& depths) {
  NearbyDepths nearby;
  nearby.depths.least = depths.least;
  nearby.depths.greatest = depths.greatest;
  nearby.depths.divisor = depths.divisor;
  const Image<uint16_t>& numbers = depths.numbers;
  if (numbers.empty()) return nearby;
  const int width = numbers.width(), height = numbers.height();
  nearby.least = Image<uint16_t>(width, height);
  nearby.greatest = Image<uint16_t>(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      uint16_t least = UINT16_MAX, greatest = 0;
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
          least = std::min(least, numbers.at(u, v));
          greatest = std::max(greatest, numbers.at(u, v));
        }
      nearby.least.at(x, y) = least;
      nearby.greatest.at(x, y) = least == LfDepths::kUnknown ? LfDepths::kUnknown : greatest;
    }
  return nearby;
}

LfPixels DefocusOf(const NearbyDepths& nearby, const PinholeCamera& lf_camera,
                   const Plane& focus_plane, double camera_distance_w, double unit_px,
                   const PixelRect& rect, LfPixels memory) {
  LfPixels defocus = std::move(memory);
  defocus.Reset(rect, BayerPattern::kNone);
  const FocusDepths focus(lf_camera, focus_plane);
  const Intrinsics& k = lf_camera.intrinsics;
  // Converts differences of inverse depth to shares of (kOutOfFocus - kInFocus).
  const auto scale =
      static_cast<float>(FocalPx(k) * camera_distance_w / unit_px / (kOutOfFocus - kInFocus));
  constexpr auto kBegin = static_cast<float>(kInFocus / (kOutOfFocus - kInFocus));
  constexpr auto kRange = static_cast<float>(LfPixels::kOpaque - LfPixels::kTransparent);
  const auto step = static_cast<float>((nearby.depths.greatest - nearby.depths.least) / 65534);
  const auto first = static_cast<float>(nearby.depths.least);
  const int divisor = nearby.depths.divisor;
  std::vector<float> focus_of_row(static_cast<size_t>(rect.width()));
  for (int y = rect.y_begin; y < rect.y_end; ++y) {
    focus.OfRow(rect.x_begin, y, focus_of_row);
    uint16_t* lanes = defocus.radiance.view().row(y - rect.y_begin);
    // Column of the plane, and number of pixels that are left in it.
    int column = rect.x_begin / divisor, left = divisor - rect.x_begin % divisor;
    for (const float of_focus : focus_of_row) {
      const uint16_t least =
          nearby.empty() ? LfDepths::kUnknown : nearby.least.at(column, y / divisor);
      float share = 1;
      if (least != LfDepths::kUnknown) {
        const uint16_t greatest = nearby.greatest.at(column, y / divisor);
        const float at = of_focus - first;
        const float distance = std::max(static_cast<float>(greatest - 1) * step - at,
                                        at - static_cast<float>(least - 1) * step);
        // The comparison is false if the focus plane has no inverse depth.
        share = distance * scale - kBegin < 1 ? std::max(0.0F, distance * scale - kBegin) : 1;
      }
      const auto value = static_cast<uint16_t>(LfPixels::kTransparent + share * kRange + 0.5F);
      for (int lane = 0; lane < LfPixels::kRayLane; ++lane) *lanes++ = value;
      *lanes++ = 1;
      if (--left > 0) continue;
      ++column;
      left = divisor;
    }
  }
  return defocus;
}

}  // namespace lf
