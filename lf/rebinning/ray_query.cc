// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/ray_query.h"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr size_t kLeafRays = 16;

// Returns the coordinates of a ray in units of the kernel's sigmas.
std::array<float, 4> Scaled(double lens_x, double lens_y, double x, double y,
                            const QueryKernel& kernel) {
  return {static_cast<float>(lens_x / kernel.sigma_st_w),
          static_cast<float>(lens_y / kernel.sigma_st_w),
          static_cast<float>(x / kernel.sigma_uv_px), static_cast<float>(y / kernel.sigma_uv_px)};
}

struct Points {
  std::vector<std::array<float, 4>> scaled;

  size_t kdtree_get_point_count() const { return scaled.size(); }
  float kdtree_get_pt(size_t i, size_t axis) const { return scaled[i][axis]; }
  template <class Box>
  bool kdtree_get_bbox(Box& /*box*/) const {
    return false;
  }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>,
                                                  Points, 4, uint32_t>;

}  // namespace

struct RayQuery::Tree {
  std::span<const FrameRay> rays;
  QueryKernel kernel;
  Points points;
  Index index;

  Tree(std::span<const FrameRay> all, const QueryKernel& with)
      : rays(all),
        kernel(with),
        points(PointsOf(all, with)),
        index(4, points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafRays)) {}

  static Points PointsOf(std::span<const FrameRay> rays, const QueryKernel& kernel) {
    LF_CHECK(kernel.sigma_st_w > 0 && kernel.sigma_uv_px > 0);
    Points points;
    points.scaled.reserve(rays.size());
    for (const FrameRay& ray : rays)
      points.scaled.push_back(Scaled(ray.lens_x_w, ray.lens_y_w, ray.x_px, ray.y_px, kernel));
    return points;
  }
  void Add(uint32_t ray, float distance2, QuerySum* sum) const {
    const double weight = std::exp(-0.5 * distance2);
    sum->weight += weight;
    for (int c = 0; c < 3; ++c) sum->rgb[c] += weight * rays[ray].rgb[c];
  }
};

RayQuery::RayQuery(std::span<const FrameRay> rays, const QueryKernel& kernel)
    : tree_(std::make_unique<Tree>(rays, kernel)) {}
RayQuery::~RayQuery() = default;

QuerySum RayQuery::WithinReach(const Vec2& lens_point, const Vec2& position_px) const {
  const auto query =
      Scaled(lens_point.x(), lens_point.y(), position_px.x(), position_px.y(), tree_->kernel);
  static thread_local std::vector<std::pair<uint32_t, float>> found;
  constexpr auto kReach2 = static_cast<float>(kReach_sigmas * kReach_sigmas);
  tree_->index.radiusSearch(query.data(), kReach2, found, nanoflann::SearchParams(0, 0, false));
  QuerySum sum;
  for (const auto& [ray, distance2] : found) tree_->Add(ray, distance2, &sum);
  return sum;
}

QuerySum RayQuery::Nearest(const Vec2& lens_point, const Vec2& position_px, size_t count) const {
  const auto query =
      Scaled(lens_point.x(), lens_point.y(), position_px.x(), position_px.y(), tree_->kernel);
  std::vector<uint32_t> rays(count);
  std::vector<float> distances2(count);
  const size_t found = tree_->index.knnSearch(query.data(), count, rays.data(), distances2.data());
  QuerySum sum;
  // The weights themselves may underflow; weights relative to the nearest ray do not.
  for (size_t i = 0; i < found; ++i) tree_->Add(rays[i], distances2[i] - distances2[0], &sum);
  return sum;
}

}  // namespace lf
