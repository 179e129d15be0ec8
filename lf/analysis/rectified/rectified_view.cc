// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/rectified/rectified_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lf/core/catmull_rom.h"
#include "lf/light_field/model/lf_light.h"

namespace lf {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
// Number of pixels around a position that the cubics read, on either side.
constexpr int kMargin = 2;

// The pixel before a position, and the way from its centre to the position.
struct Between {
  int pixel = 0;
  double t = 0;
};
Between BetweenPixels(double at_px) {
  const double from_centre = at_px - 0.5;
  Between between = {static_cast<int>(std::floor(from_centre)), 0};
  between.t = from_centre - between.pixel;
  if (between.t < RectifiedRays::kSame_px) between.t = 0;
  if (between.t > 1 - RectifiedRays::kSame_px) between = {between.pixel + 1, 0};
  return between;
}

// Adds weighted pixels. The sum is NaN if a pixel with a weight is missing.
class WeightedSum {
 public:
  WeightedSum(const Image<float>& light, const PixelRect& rect) : light_(light), rect_(rect) {}

  void Add(int x, int y, double weight) {
    if (weight == 0) return;
    if (!rect_.Contains(x, y)) {
      sum_.fill(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    for (int c = 0; c < 3; ++c)
      sum_[static_cast<size_t>(c)] += weight * light_.at(x - rect_.x_begin, y - rect_.y_begin, c);
  }
  bool is_complete() const { return !std::isnan(sum_[0]); }
  void CopyTo(float* rgb) const {
    for (size_t c = 0; c < 3; ++c) rgb[c] = static_cast<float>(sum_[c]);
  }

 private:
  const Image<float>& light_;
  const PixelRect& rect_;
  std::array<double, 3> sum_ = {};
};

WeightedSum Cubic(const Image<float>& light, const PixelRect& rect, const Between& x,
                  const Between& y) {
  const std::array<double, 4> across = CatmullRomWeights(x.t), down = CatmullRomWeights(y.t);
  WeightedSum sum(light, rect);
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      sum.Add(x.pixel - 1 + column, y.pixel - 1 + row,
              across[static_cast<size_t>(column)] * down[static_cast<size_t>(row)]);
  return sum;
}

WeightedSum Linear(const Image<float>& light, const PixelRect& rect, const Between& x,
                   const Between& y) {
  WeightedSum sum(light, rect);
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 2; ++column)
      sum.Add(x.pixel + column, y.pixel + row,
              (column == 0 ? 1 - x.t : x.t) * (row == 0 ? 1 - y.t : y.t));
  return sum;
}

}  // namespace

Intrinsics PinholeOf(const Intrinsics& k) {
  return {k.fx_px, k.fy_px, k.cx_px, k.cy_px, k.skew_px, k.width_px, k.height_px};
}

RectifiedRays::RectifiedRays(const PinholeCamera& lf_camera, const Mat3& view_rotation,
                             const Intrinsics& view)
    : lf_(lf_camera.intrinsics),
      view_(view),
      lf_from_view_(lf_camera.cam_from_world.rotation * view_rotation.transpose()),
      inverse_(view.InverseMatrix()),
      map_(lf_camera.intrinsics.distortion),
      is_same_(FindSame()) {}

bool RectifiedRays::FindSame() const {
  if (lf_.has_distortion() || lf_.width_px != view_.width_px || lf_.height_px != view_.height_px)
    return false;
  for (const double x_share : {0.0, 0.5, 1.0})
    for (const double y_share : {0.0, 0.5, 1.0}) {
      const Vec2 at_px(x_share * view_.width_px, y_share * view_.height_px);
      const std::optional<Vec2> recorded_px = RecordedAt(at_px.x(), at_px.y());
      if (!recorded_px || (*recorded_px - at_px).norm() > kSame_px) return false;
    }
  return true;
}

std::optional<Vec2> RectifiedRays::RecordedAt(double x_px, double y_px) const {
  const std::optional<Vec2> distorted =
      map_.Distort(lf_from_view_ * (inverse_ * Vec3(x_px, y_px, 1)));
  if (!distorted) return std::nullopt;
  return Vec2(lf_.fx_px * distorted->x() + lf_.skew_px * distorted->y() + lf_.cx_px,
              lf_.fy_px * distorted->y() + lf_.cy_px);
}

PixelRect RectifiedRays::PixelsFor(const PixelRect& rect, double shift_px) const {
  const PixelRect whole = {0, 0, lf_.width_px, lf_.height_px};
  double left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      const std::optional<Vec2> at_px = RecordedAt(x + 0.5 + shift_px, y + 0.5);
      if (!at_px || !(std::abs(at_px->x()) < 1e9 && std::abs(at_px->y()) < 1e9)) continue;
      left = std::min(left, at_px->x());
      right = std::max(right, at_px->x());
      top = std::min(top, at_px->y());
      bottom = std::max(bottom, at_px->y());
    }
  if (!(left <= right)) return {};
  const auto before = [](double at) { return static_cast<int>(std::floor(at)) - kMargin; };
  const auto behind = [](double at) { return static_cast<int>(std::ceil(at)) + kMargin; };
  return Intersection({before(left), before(top), behind(right), behind(bottom)}, whole);
}

void SampleLight(const Image<float>& light, const PixelRect& rect, const Vec2& at_px, float* rgb) {
  std::fill_n(rgb, 3, kNone);
  // Beyond the outermost pixel centres, the LF image has no value.
  if (!(at_px.x() > rect.x_begin && at_px.x() < rect.x_end && at_px.y() > rect.y_begin &&
        at_px.y() < rect.y_end))
    return;
  const Between x = BetweenPixels(at_px.x()), y = BetweenPixels(at_px.y());
  const WeightedSum cubic = Cubic(light, rect, x, y);
  if (cubic.is_complete())
    cubic.CopyTo(rgb);
  else
    Linear(light, rect, x, y).CopyTo(rgb);
}

Result<Image<float>> LoadRectified(const LightField& light_field, const LfImageStore& store,
                                   LfImageId id, const RectifiedRays& rays, const PixelRect& rect,
                                   double shift_px) {
  Image<float> view(rect.width(), rect.height(), 3, kNone);
  const bool is_copied = rays.IsSame() && shift_px == 0;
  const PixelRect needed = is_copied ? rect : rays.PixelsFor(rect, shift_px);
  if (needed.empty()) return view;
  LF_ASSIGN_OR_RETURN(
      const LfPixels pixels,
      LoadWithoutThrowing(store, id, needed, light_field.image_names[id.value], {}));
  const Image<float> light = LightOf(pixels, light_field.encoding, kNone);
  for (int y = rect.y_begin; y < rect.y_end; ++y)
    for (int x = rect.x_begin; x < rect.x_end; ++x) {
      float* const to = &view.at(x - rect.x_begin, y - rect.y_begin, 0);
      if (is_copied) {
        std::copy_n(&light.at(x - pixels.rect.x_begin, y - pixels.rect.y_begin, 0), 3, to);
      } else if (const auto at_px = rays.RecordedAt(x + 0.5 + shift_px, y + 0.5)) {
        SampleLight(light, pixels.rect, *at_px, to);
      }
    }
  return view;
}

}  // namespace lf
