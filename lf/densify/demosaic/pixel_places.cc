// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/pixel_places.h"

#include <algorithm>
#include <cmath>

#include "lf/camera/ideal_pixels.h"
#include "lf/densify/working_image.h"

namespace lf {

IdealPositions::IdealPositions(const PinholeCamera& camera) {
  const Intrinsics& k = camera.intrinsics;
  if (!k.has_distortion()) return;
  positions = Image<float>(k.width_px, k.height_px, 2);
  const DistortionMap distortion(k.distortion);
  for (int y = 0; y < k.height_px; ++y)
    for (int x = 0; x < k.width_px; ++x) {
      const std::optional<Vec3> ideal = IdealPosition(k, distortion, x + 0.5, y + 0.5);
      const bool is_in_front = ideal && ideal->z() > 0;
      for (int i = 0; i < 2; ++i)
        positions.at(x, y, i) = is_in_front ? static_cast<float>((*ideal)[i] / ideal->z()) : NAN;
    }
}

PixelPlaces::PixelPlaces(const PinholeCamera& from, const PinholeCamera& to)
    : map_(MapBetween(WorkingCamera(from, 1), WorkingCamera(to, 1))), to_(to.intrinsics) {
  if (to_.has_distortion()) distorts_.emplace(to_.distortion);
}

PixelPlaces::Place PixelPlaces::At(float ideal_x, float ideal_y, float inverse_depth) const {
  const PairMap::Place ideal = map_.At(ideal_x, ideal_y, inverse_depth);
  if (!(ideal.w > 0)) return {NAN, NAN};
  if (!distorts_) return {ideal.u_px - 0.5F, ideal.v_px - 0.5F};
  const double y = (ideal.v_px - to_.cy_px) / to_.fy_px;
  const double x = (ideal.u_px - to_.cx_px - to_.skew_px * y) / to_.fx_px;
  const std::optional<Vec2> distorted = distorts_->Distort({x, y, 1});
  if (!distorted) return {NAN, NAN};
  return {static_cast<float>(to_.fx_px * distorted->x() + to_.skew_px * distorted->y() + to_.cx_px -
                             0.5),
          static_cast<float>(to_.fy_px * distorted->y() + to_.cy_px - 0.5)};
}

PixelPlaces::Offsets PixelPlaces::OffsetsIn(const IdealPositions& of_from, int width_px,
                                            int height_px, float inverse_depth) const {
  const int step = std::min({8, width_px / 4, height_px / 4});
  const int x = width_px / 2, y = height_px / 2;
  const auto place_of = [&](int column, int row) {
    const Vec2 ideal = of_from.At(column, row);
    const Place place =
        At(static_cast<float>(ideal.x()), static_cast<float>(ideal.y()), inverse_depth);
    return Vec2(place.x, place.y);
  };
  const Vec2 across = place_of(x + step, y) - place_of(x - step, y);
  const Vec2 down = place_of(x, y + step) - place_of(x, y - step);
  const double determinant = Cross(across, down), length = 2.0 * step;
  // A part of the square of `length`, below which the image of `to` is useless.
  if (!(std::abs(determinant) > 0.01 * length * length)) return {};
  return {{static_cast<float>(length * down.y() / determinant),
           static_cast<float>(-length * down.x() / determinant),
           static_cast<float>(-length * across.y() / determinant),
           static_cast<float>(length * across.x() / determinant)}};
}

}  // namespace lf
