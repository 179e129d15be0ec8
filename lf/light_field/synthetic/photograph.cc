// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/synthetic/photograph.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/hood.h"
#include "lf/camera/ideal_pixels.h"

namespace lf {
namespace {

// The rays of a camera's pixels. The camera's matrix is inverted only once.
class PixelRays {
 public:
  explicit PixelRays(const PinholeCamera& camera)
      : intrinsics_(camera.intrinsics),
        centre_(camera.CentreWorld()),
        world_from_pixel_(camera.cam_from_world.rotation.transpose() *
                          camera.intrinsics.InverseMatrix()),
        pixel_angle_(1 / std::sqrt(std::abs(camera.intrinsics.fx_px * camera.intrinsics.fy_px))) {
    if (intrinsics_.has_distortion()) distortion_.emplace(intrinsics_.distortion);
  }

  bool has_distortion() const { return distortion_.has_value(); }

  // Returns the ray through a position of the picture; none if the lens lets no ray through.
  std::optional<Ray> Through(double x_px, double y_px) const {
    if (!distortion_) return Ray{centre_, world_from_pixel_ * Vec3(x_px, y_px, 1)};
    const std::optional<Vec3> position = IdealPosition(intrinsics_, *distortion_, x_px, y_px);
    if (!position) return std::nullopt;
    return Ray{centre_, world_from_pixel_ * *position};
  }
  // Returns the footprint of one of `samples` squares that tile a pixel.
  Footprint FootprintOf(int samples) const {
    return FootprintOfPixel(pixel_angle_ / std::sqrt(static_cast<double>(samples)));
  }

 private:
  Intrinsics intrinsics_;
  std::optional<DistortionMap> distortion_;
  Vec3 centre_;
  Mat3 world_from_pixel_;
  double pixel_angle_;
};

// Returns the smallest n for which n x n samples are not fewer than `samples`.
int SideOf(int samples) { return static_cast<int>(std::ceil(std::sqrt(std::max(1, samples)))); }

// Returns n x n points of the unit square that form a slightly rotated grid: there is one point in
// each cell of the n x n grid, and one in each of n^2 rows and n^2 columns. Their mean is the
// centre, and x and y are uncorrelated, so that averaging over them blurs equally in all
// directions.
std::vector<Vec2> SquarePoints(int side) {
  std::vector<Vec2> points;
  const double n = side;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i)
      points.emplace_back((i + (j + 0.5) / n) / n, (j + (n - i - 0.5) / n) / n);
  return points;
}

// Returns true if there is an edge between two neighbouring pixels: they show different surfaces,
// or differ by more than kShare of the brighter one. kDark prevents edges from noise that is too
// dark to be seen.
bool IsEdge(const Scene::Sight& a, const Scene::Sight& b) {
  if (a.shape != b.shape) return true;
  constexpr double kShare = 0.4, kDark = 0.1;
  return ((a.radiance - b.radiance).abs() > kShare * (a.radiance.max(b.radiance) + kDark)).any();
}

// Divides the picture into tiles and finds, for each tile, the sector of the scene that its rays
// may meet.
class Tiles {
 public:
  Tiles(const Scene& scene, const PixelRays& rays, int width, int height)
      : side_((std::max(width, height) + kAcross - 1) / kAcross),
        columns_((width + side_ - 1) / side_),
        rows_((height + side_ - 1) / side_) {
    for (int row = 0; row < rows_; ++row)
      for (int column = 0; column < columns_; ++column) {
        const std::optional<Cone> cone = ConeOf(rays, column * side_, row * side_);
        sectors_.push_back(cone ? std::optional(scene.SectorOf(*cone)) : std::nullopt);
      }
  }

  // Returns the sector of the tile that contains a pixel of the picture, or a pixel next to the
  // picture; null if the tile has none.
  const Scene::Sector* At(int x, int y) const {
    const int column = std::clamp(x / side_, 0, columns_ - 1);
    const int row = std::clamp(y / side_, 0, rows_ - 1);
    const std::optional<Scene::Sector>& sector =
        sectors_[static_cast<size_t>(row) * static_cast<size_t>(columns_) +
                 static_cast<size_t>(column)];
    return sector ? &*sector : nullptr;
  }

 private:
  static constexpr int kAcross = 32;   // number of tiles along the longer side of the picture
  static constexpr double kBow = 1.1;  // factor of a cone's sine, for distorted edges of tiles
  // Width of the border of a tile that its cone contains: one pixel for the neighbouring pixels,
  // kGlowReach footprints of a pixel, and a safety margin.
  static constexpr double kMargin_px = 1 + kGlowReach * kFootprintPerSide + 0.5;

  // Returns a cone around all rays of a tile; none unless all tested positions of the tile have
  // rays.
  std::optional<Cone> ConeOf(const PixelRays& rays, int x, int y) const {
    const std::optional<Ray> axis = rays.Through(x + 0.5 * side_, y + 0.5 * side_);
    if (!axis) return std::nullopt;
    Cone cone{axis->origin, axis->direction.normalized(), std::numeric_limits<double>::infinity()};
    const double xs[] = {x - kMargin_px, x + 0.5 * side_, x + side_ + kMargin_px};
    const double ys[] = {y - kMargin_px, y + 0.5 * side_, y + side_ + kMargin_px};
    for (const double border_x : xs)
      for (const double border_y : ys) {
        const std::optional<Ray> border = rays.Through(border_x, border_y);
        if (!border) return std::nullopt;
        cone.sine =
            std::max(cone.sine, border->direction.normalized().cross(cone.direction).norm());
      }
    // Distortion makes the edges of a tile curved between the tested points.
    if (rays.has_distortion()) cone.sine *= kBow;
    return cone;
  }

  int side_;
  int columns_;
  int rows_;
  std::vector<std::optional<Scene::Sector>> sectors_;
};

// LookAlongRow() returns the surfaces and radiances seen by the rays through the pixel centres of
// row y, from one pixel left of the picture to one pixel right of it.
using SightRow = std::vector<Scene::Sight>;
SightRow LookAlongRow(const Scene& scene, const PixelRays& rays, const Tiles& tiles, int width,
                      int y) {
  SightRow row;
  row.reserve(static_cast<size_t>(width) + 2);
  const Footprint footprint = rays.FootprintOf(1);
  for (int x = -1; x <= width; ++x) {
    const std::optional<Ray> ray = rays.Through(x + 0.5, y + 0.5);
    row.push_back(ray ? scene.SightAlong(*ray, footprint, tiles.At(x, y)) : Scene::Sight());
  }
  return row;
}

// Radiance of R, G, B, and opacity: the share of rays that hit a surface.
using Rgba = Eigen::Array4d;

// Returns the light and opacity that one ray adds to a picture.
Rgba LightOf(const Scene::Sight& sight, Surroundings surroundings) {
  if (surroundings == Surroundings::kTransparent && sight.shape == Hit::kNothing)
    return Rgba::Zero();
  return {sight.radiance[0], sight.radiance[1], sight.radiance[2], 1};
}

Rgba MeanOverPixel(const Scene& scene, const PixelRays& rays, const Tiles& tiles,
                   const std::vector<Vec2>& points, int x, int y, Surroundings surroundings) {
  const auto count = static_cast<int>(points.size());
  const Footprint footprint = rays.FootprintOf(count);
  Rgba sum = Rgba::Zero();
  for (const Vec2& point : points)
    if (const std::optional<Ray> ray = rays.Through(x + point.x(), y + point.y()))
      sum += LightOf(scene.SightAlong(*ray, footprint, tiles.At(x, y)), surroundings);
  return sum / count;
}

int ChannelsOf(Surroundings surroundings) {
  return surroundings == Surroundings::kTransparent ? 4 : 3;
}

void Store(const Rgba& light, int x, int y, Image<float>* picture) {
  for (int channel = 0; channel < picture->channels(); ++channel)
    picture->at(x, y, channel) = static_cast<float>(light[channel]);
}

}  // namespace

Image<float> Photograph(const Scene& scene, const PinholeCamera& camera, int samples,
                        Surroundings surroundings) {
  const int width = camera.intrinsics.width_px, height = camera.intrinsics.height_px;
  const PixelRays rays(camera);
  const Tiles tiles(scene, rays, width, height);
  const std::vector<Vec2> points = SquarePoints(SideOf(samples));
  Image<float> picture(width, height, ChannelsOf(surroundings));
  SightRow above = LookAlongRow(scene, rays, tiles, width, -1);
  SightRow row = LookAlongRow(scene, rays, tiles, width, 0);
  for (int y = 0; y < height; ++y) {
    SightRow below = LookAlongRow(scene, rays, tiles, width, y + 1);
    for (int x = 0; x < width; ++x) {
      const size_t i = static_cast<size_t>(x) + 1;
      const bool edge = IsEdge(row[i], row[i - 1]) || IsEdge(row[i], row[i + 1]) ||
                        IsEdge(row[i], above[i]) || IsEdge(row[i], below[i]);
      const Rgba light = edge && points.size() > 1
                             ? MeanOverPixel(scene, rays, tiles, points, x, y, surroundings)
                             : LightOf(row[i], surroundings);
      Store(light, x, y, &picture);
    }
    above = std::move(row);
    row = std::move(below);
  }
  return picture;
}

Image<float> ThinLensPhotograph(const Scene& scene, const RenderCamera& camera,
                                const LensSampling& sampling, ThreadPool& pool,
                                Surroundings surroundings) {
  const Intrinsics& intrinsics = camera.pinhole.intrinsics;
  const std::vector<Vec2> element_points = SquarePoints(SideOf(sampling.samples));
  const auto sample_count = static_cast<int>(element_points.size());
  std::vector<Vec3> lens_points;
  std::vector<double> shares;  // shares of the light that pass the lens at its points
  for (const Vec2& point : SampleLens(camera.aperture, sample_count, sampling.seed)) {
    lens_points.push_back(LensPointWorld(camera, point));
    shares.push_back(
        camera.transmission ? LightThrough(*camera.transmission, camera.aperture, point) : 1);
  }
  const HoodTest hood(camera);
  const double element_spread = PixelRays(camera.pinhole).FootprintOf(sample_count).spread;
  const double lens_cell_w = kFootprintPerSide * std::sqrt(Area(camera.aperture) / sample_count);
  Image<float> picture(intrinsics.width_px, intrinsics.height_px, ChannelsOf(surroundings));
  pool.ForEach(static_cast<size_t>(intrinsics.height_px), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < intrinsics.width_px; ++x) {
      Rgba sum = Rgba::Zero();
      double let_through = 0;  // sum of the shares of the samples that the hood does not cut off
      for (size_t i = 0; i < lens_points.size(); ++i) {
        if (shares[i] == 0) continue;
        const std::optional<Vec3> focus_point =
            FocusPointOfElement(camera, x + element_points[i].x(), y + element_points[i].y());
        if (!focus_point) {
          let_through += shares[i];
          continue;
        }
        const Vec3 direction = *focus_point - lens_points[i];
        if (!hood.LetsThrough(lens_points[i], direction)) continue;
        let_through += shares[i];
        // The footprint is as wide at the lens as the part of the lens that the sample represents,
        // and as wide at the focus plane as the part of the element that the sample represents.
        const Footprint footprint{lens_cell_w, -lens_cell_w / direction.norm() - element_spread};
        const Rgba light =
            LightOf(scene.SightAlong({lens_points[i], direction}, footprint), surroundings);
        sum += shares[i] * light;
      }
      if (let_through > 0) sum /= let_through;
      Store(sum, x, y, &picture);
    }
  });
  return picture;
}

Image<float> DepthsSeen(const Scene& scene, const PinholeCamera& camera, ThreadPool& pool) {
  const PixelRays rays(camera);
  const Vec3 forward = camera.ForwardWorld();
  Image<float> depths(camera.intrinsics.width_px, camera.intrinsics.height_px);
  pool.ForEach(static_cast<size_t>(depths.height()), [&](size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < depths.width(); ++x) {
      const std::optional<Ray> ray = rays.Through(x + 0.5, y + 0.5);
      const double distance = scene.SightAlong(*ray, rays.FootprintOf(1)).distance;
      depths.at(x, y) = static_cast<float>(distance * forward.dot(ray->direction.normalized()));
    }
  });
  return depths;
}

}  // namespace lf
