#include "lf/rebinning/frame_rays.h"

#include <algorithm>
#include <optional>

namespace lf {
namespace {

// One ray after the other, through the same frame.
class FrameView {
 public:
  FrameView(const RenderCamera& frame, const FrameReach& reach, const AskedSquares& squares)
      : centre_(frame.pinhole.CentreWorld()),
        right_(frame.pinhole.RightWorld()),
        up_(frame.pinhole.UpWorld()),
        forward_(frame.pinhole.ForwardWorld()),
        focus_plane_(frame.focus_plane),
        plate_from_world_(frame.pinhole.intrinsics.Matrix() *
                          frame.pinhole.cam_from_world.rotation),
        lens_reach2_w2_((frame.aperture.radius_w + reach.lens_w) *
                        (frame.aperture.radius_w + reach.lens_w)),
        margin_px_(reach.plate_px),
        squares_(squares),
        width_px_(frame.pinhole.intrinsics.width_px),
        height_px_(frame.pinhole.intrinsics.height_px) {}

  std::optional<FrameRay> See(const Ray& ray) const {
    const double along = forward_.dot(ray.direction);
    if (!(along > 0)) return {};
    const Vec3 from_centre = ray.origin - centre_;
    const Vec3 on_lens = from_centre - forward_.dot(from_centre) / along * ray.direction;
    const Vec2 lens(right_.dot(on_lens), up_.dot(on_lens));
    if (!(lens.squaredNorm() <= lens_reach2_w2_)) return {};
    return At(lens, ray);
  }

  // Of a ray that is taken for one through another point of the lens.
  std::optional<FrameRay> At(const Vec2& lens, const Ray& ray) const {
    if (!(forward_.dot(ray.direction) > 0)) return {};
    const double slope = focus_plane_.normal.dot(ray.direction);
    if (slope == 0) return {};
    const double lambda = (focus_plane_.offset_w - focus_plane_.normal.dot(ray.origin)) / slope;
    const Vec3 element = plate_from_world_ * (ray.origin - centre_ + lambda * ray.direction);
    if (!(element.z() > 0)) return {};
    const double x = element.x() / element.z(), y = element.y() / element.z();
    if (!(x >= -margin_px_ && x <= width_px_ + margin_px_ && y >= -margin_px_ &&
          y <= height_px_ + margin_px_) ||
        !IsAsked(x, y))
      return {};
    FrameRay seen;
    seen.lens_x_w = static_cast<float>(lens.x());
    seen.lens_y_w = static_cast<float>(lens.y());
    seen.x_px = static_cast<float>(x);
    seen.y_px = static_cast<float>(y);
    return seen;
  }

 private:
  bool IsAsked(double x, double y) const {
    if (squares_.asked.empty()) return true;
    const auto square = [](double place, int size_px) {
      return static_cast<size_t>(std::clamp(place, 0.0, size_px - 1.0)) / AskedSquares::kSide;
    };
    return squares_.asked[square(y, height_px_) * squares_.columns + square(x, width_px_)];
  }

  Vec3 centre_, right_, up_, forward_;
  Plane focus_plane_;
  Mat3 plate_from_world_;
  double lens_reach2_w2_;
  double margin_px_;
  const AskedSquares& squares_;
  int width_px_, height_px_;
};

// In the order of the cells.
//   see(cell)  its ray, but for its colour; none: left out
template <class See>
LargeVector<FrameRay> RaysOfCells(std::span<const BinnedCell> cells, ThreadPool& pool,
                                  const See& see) {
  constexpr size_t kCellsAtOnce = 65536;
  // Parts are written where all of their cells would have room, and moved together.
  LargeVector<FrameRay> rays(cells.size());
  std::vector<size_t> counts((cells.size() + kCellsAtOnce - 1) / kCellsAtOnce);
  pool.ForEach(counts.size(), [&](size_t i) {
    const size_t begin = i * kCellsAtOnce;
    for (const BinnedCell& cell :
         cells.subspan(begin, std::min(kCellsAtOnce, cells.size() - begin))) {
      std::optional<FrameRay> ray = see(cell.cell);
      if (!ray) continue;
      for (int c = 0; c < 3; ++c) ray->rgb[c] = static_cast<float>(cell.Mean(c));
      rays[begin + counts[i]++] = *ray;
    }
  });
  auto end = rays.begin();
  for (size_t i = 0; i < counts.size(); ++i) {
    const auto part = rays.begin() + static_cast<std::ptrdiff_t>(i * kCellsAtOnce);
    end = std::move(part, part + static_cast<std::ptrdiff_t>(counts[i]), end);
  }
  rays.erase(end, rays.end());
  return rays;
}

}  // namespace

LargeVector<FrameRay> FrameRaysOf(const Slab& slab, std::span<const BinnedCell> cells,
                                  const RenderCamera& frame, const FrameReach& reach,
                                  ThreadPool& pool, const AskedSquares& squares) {
  const FrameView view(frame, reach, squares);
  return RaysOfCells(
      cells, pool, [&](CellKey cell) { return view.See(RayOfPoint(slab, MiddleOf(slab, cell))); });
}

LargeVector<FrameRay> FrameRaysThrough(const Vec2& lens_point, const Slab& slab,
                                       std::span<const BinnedCell> cells, const RenderCamera& frame,
                                       const FrameReach& reach, ThreadPool& pool) {
  const AskedSquares all;
  const FrameView view(frame, reach, all);
  const Vec3 lens_world = LensPointWorld(frame, lens_point);
  return RaysOfCells(cells, pool, [&](CellKey cell) -> std::optional<FrameRay> {
    const SlabPoint point = MiddleOf(slab, cell);
    const Ray ray = RayOfPoint(slab, point);
    const Ray asked{lens_world, ray.At(1) - lens_world};
    const std::optional<SlabPoint> asked_point = Parameterize(slab, asked);
    if (!asked_point) return {};
    const Vec2 off = (point - *asked_point).head<2>();
    if (!(off.squaredNorm() <= reach.lens_w * reach.lens_w)) return {};
    return view.At(lens_point + off, asked);
  });
}

}  // namespace lf
