// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/views/view_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/analysis/rectified/rectified_view.h"
#include "lf/densify/camera_plane.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

// A number that depends linearly on a position.
struct Trend {
  double at_0 = 0;
  double per_w = 0;
  double worst = 0;  // largest difference from the trend

  double At(double position_w) const { return at_0 + per_w * position_w; }
};

// Fits a trend by least squares.
Trend TrendOf(const std::vector<double>& positions_w, const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  double mean_w = 0, mean = 0, square = 0, product = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    mean_w += positions_w[i] / count;
    mean += values[i] / count;
  }
  for (size_t i = 0; i < values.size(); ++i) {
    square += (positions_w[i] - mean_w) * (positions_w[i] - mean_w);
    product += (positions_w[i] - mean_w) * (values[i] - mean);
  }
  Trend trend;
  trend.per_w = square > 0 ? product / square : 0;
  trend.at_0 = mean - trend.per_w * mean_w;
  for (size_t i = 0; i < values.size(); ++i)
    trend.worst = std::max(trend.worst, std::abs(values[i] - trend.At(positions_w[i])));
  return trend;
}

// The principal points of LF cameras as trends of their positions.
struct PrincipalPoints {
  Trend x, y;
  bool AreEven() const { return std::max(x.worst, y.worst) <= RectifiedRays::kSame_px; }
};

PrincipalPoints PrincipalPointsOf(const LightField& light_field,
                                  const std::vector<Vec2>& points_w) {
  std::vector<double> x_w, y_w, cx, cy;
  for (size_t i = 0; i < points_w.size(); ++i) {
    const Intrinsics& k = light_field.intrinsics[light_field.cameras[i].intrinsics_index];
    x_w.push_back(points_w[i].x());
    y_w.push_back(points_w[i].y());
    cx.push_back(k.cx_px);
    cy.push_back(k.cy_px);
  }
  return {TrendOf(x_w, cx), TrendOf(y_w, cy)};
}

}  // namespace

Result<ViewGrid> ViewGrid::Make(const LightField& light_field, int columns, int rows) {
  if (std::min(columns, rows) < 1 || std::max(columns, rows) > kMostViewsAcross)
    return UsageError(fmt::format("a grid of {} x {} views: expected 1 to {} columns and rows",
                                  columns, rows, kMostViewsAcross));
  LF_ASSIGN_OR_RETURN(const CameraPlane plane, CameraPlaneOf(light_field));
  if (plane.is_unrolled)
    return InputError(fmt::format(
        "LF cameras look up to {:.0f} degrees away from their mean direction, but the views of a "
        "grid look in one direction: expected at most {:.0f} degrees ({{lfimport exclude}} leaves "
        "LF "
        "images out)",
        plane.widest_deg, kMostTurn_deg));
  ViewGrid grid;
  grid.columns_ = columns;
  grid.rows_ = rows;
  grid.cam_from_world_ = plane.mean_cam_from_world;
  Vec2 least = plane.points.front(), most = plane.points.front();
  for (const Vec2& point : plane.points) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  const Vec2 extent = most - least;
  grid.step_w_ = {columns > 1 ? extent.x() / (columns - 1) : 0,
                  rows > 1 ? extent.y() / (rows - 1) : 0};
  grid.first_w_ = {columns > 1 ? least.x() : (least.x() + most.x()) / 2,
                   rows > 1 ? least.y() : (least.y() + most.y()) / 2};
  // Virtual LF images may be larger than photographs, so that they hold what a lens sees.
  const LfImageId middle = MiddleCamera(
      light_field, [&](LfImageId id) { return !light_field.cameras[id.value].is_virtual; });
  grid.k_ = PinholeOf(light_field.Camera(middle).intrinsics);
  grid.k_.skew_px = 0;
  if (const PrincipalPoints points = PrincipalPointsOf(light_field, plane.points);
      points.AreEven()) {
    grid.k_.cx_px = points.x.at_0;
    grid.k_.cy_px = points.y.at_0;
    grid.principal_px_per_w_ = {points.x.per_w, points.y.per_w};
  }
  grid.FindRecorded(light_field, plane.points);
  return grid;
}

void ViewGrid::FindRecorded(const LightField& light_field, const std::vector<Vec2>& points_w) {
  recorded_.resize(size());
  // Each LF image of a bracket shows only the pixels that are not clipped in it.
  if (light_field.encoding.masks_clipped) return;
  double step_w = std::numeric_limits<double>::infinity();
  for (const double step : {step_w_.x(), step_w_.y()})
    if (step > 0) step_w = std::min(step_w, step);
  // A single view has no step; the distance between LF cameras takes its place.
  if (!std::isfinite(step_w)) step_w = MedianSpacing(light_field);
  std::vector<double> away_w(size(), kCoincident * step_w);
  for (uint32_t i = 0; i < points_w.size(); ++i) {
    if (light_field.cameras[i].is_virtual) continue;
    const auto nearest = [](double offset_w, double step, int count) {
      return step > 0 ? std::clamp(static_cast<int>(std::lround(offset_w / step)), 0, count - 1)
                      : 0;
    };
    const int column = nearest(points_w[i].x() - first_w_.x(), step_w_.x(), columns_);
    const int row = nearest(points_w[i].y() - first_w_.y(), step_w_.y(), rows_);
    const size_t view =
        static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
    const double distance_w =
        (light_field.Camera(LfImageId{i}).CentreWorld() - Camera(view).CentreWorld()).norm();
    if (distance_w > away_w[view]) continue;
    away_w[view] = distance_w;
    recorded_[view] = LfImageId{i};
  }
}

Vec2 ViewGrid::Position_w(size_t view) const {
  return first_w_ + Vec2(column_of(view) * step_w_.x(), row_of(view) * step_w_.y());
}

PinholeCamera ViewGrid::Camera(size_t view) const {
  const Vec2 at_w = Position_w(view);
  PinholeCamera camera = {k_, cam_from_world_};
  camera.intrinsics.cx_px += principal_px_per_w_.x() * at_w.x();
  camera.intrinsics.cy_px += principal_px_per_w_.y() * at_w.y();
  camera.cam_from_world.translation -= Vec3(at_w.x(), at_w.y(), 0);
  return camera;
}

}  // namespace lf
