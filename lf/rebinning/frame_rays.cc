// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/frame_rays.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include "lf/rebinning/frame_view.h"

namespace lf {
namespace {

class SquareTest {
 public:
  SquareTest(const AskedSquares& squares, const RenderCamera& frame)
      : squares_(squares),
        width_px_(frame.pinhole.intrinsics.width_px),
        height_px_(frame.pinhole.intrinsics.height_px) {}

  // True if the square of a position needs rays. A position beside the plate is in the square of
  // the nearest element.
  bool IsAsked(double x_px, double y_px) const {
    if (squares_.asked.empty()) return true;
    const auto square = [](double place, int size_px) {
      return static_cast<size_t>(std::clamp(place, 0.0, size_px - 1.0)) / AskedSquares::kSide;
    };
    return squares_.asked[square(y_px, height_px_) * squares_.columns + square(x_px, width_px_)];
  }

 private:
  const AskedSquares& squares_;
  int width_px_, height_px_;
};

void Colour(const BinnedCell& cell, FrameRay* ray) {
  for (int c = 0; c < 3; ++c) ray->rgb[c] = static_cast<float>(cell.Mean(c));
}

// Computes the rays of all cells with all threads. Returns them in the order of the cells.
//   see(cells, rays)  appends the rays of some cells
template <class See>
LargeVector<FrameRay> RaysOfCells(std::span<const BinnedCell> cells, ThreadPool& pool,
                                  const See& see) {
  constexpr size_t kCellsAtOnce = 65536;
  std::vector<std::vector<FrameRay>> parts((cells.size() + kCellsAtOnce - 1) / kCellsAtOnce);
  // A thread collects the rays of all its parts in the same memory. If each part grew its own, the
  // system would spend more time on that memory than the rays take.
  std::atomic<size_t> next = 0;
  pool.ForEach(std::min(parts.size(), static_cast<size_t>(pool.thread_count())), [&](size_t) {
    std::vector<FrameRay> seen;
    for (size_t i = next++; i < parts.size(); i = next++) {
      const size_t begin = i * kCellsAtOnce;
      seen.clear();
      see(cells.subspan(begin, std::min(kCellsAtOnce, cells.size() - begin)), &seen);
      parts[i] = seen;  // exactly as large as needed
    }
  });
  size_t count = 0;
  for (const auto& part : parts) count += part.size();
  LargeVector<FrameRay> rays;
  rays.reserve(count);
  for (auto& part : parts) {
    rays.insert(rays.end(), part.begin(), part.end());
    part = {};
  }
  return rays;
}

}  // namespace

LargeVector<FrameRay> FrameRaysOf(const Slab& slab, std::span<const BinnedCell> cells,
                                  const RenderCamera& frame, const FrameReach& reach,
                                  ThreadPool& pool, const AskedSquares& squares) {
  const FrameView view(slab, frame, reach);
  const SquareTest test(squares, frame);
  return RaysOfCells(
      cells, pool, [&](std::span<const BinnedCell> part, std::vector<FrameRay>* rays) {
        SeenCells seen;
        for (size_t begin = 0; begin < part.size(); begin += SeenCells::kAtOnce) {
          const auto some = part.subspan(begin, std::min(SeenCells::kAtOnce, part.size() - begin));
          FindSeenCells(view, some, &seen);
          for (size_t i = 0; i < seen.count; ++i) {
            if (!test.IsAsked(seen.x_px[i], seen.y_px[i])) continue;
            FrameRay ray;
            ray.lens_x_w = static_cast<float>(seen.lens_x_w[i]);
            ray.lens_y_w = static_cast<float>(seen.lens_y_w[i]);
            ray.x_px = static_cast<float>(seen.x_px[i]);
            ray.y_px = static_cast<float>(seen.y_px[i]);
            Colour(some[seen.cells[i]], &ray);
            rays->push_back(ray);
          }
        }
      });
}

LargeVector<FrameRay> FrameRaysThrough(const Vec2& lens_point, const Slab& slab,
                                       std::span<const BinnedCell> cells, const RenderCamera& frame,
                                       const FrameReach& reach, ThreadPool& pool) {
  const RayView view(frame, reach);
  const Vec3 lens_world = LensPointWorld(frame, lens_point);
  const auto see = [&](CellKey cell) -> std::optional<FrameRay> {
    const SlabPoint point = MiddleOf(slab, cell);
    const Ray asked{lens_world, RayOfPoint(slab, point).At(1) - lens_world};
    const std::optional<SlabPoint> asked_point = Parameterize(slab, asked);
    if (!asked_point) return {};
    const Vec2 off = (point - *asked_point).head<2>();
    if (!(off.squaredNorm() <= reach.lens_w * reach.lens_w)) return {};
    return view.At(lens_point + off, asked);
  };
  return RaysOfCells(cells, pool,
                     [&](std::span<const BinnedCell> part, std::vector<FrameRay>* rays) {
                       for (const BinnedCell& cell : part) {
                         std::optional<FrameRay> ray = see(cell.cell);
                         if (!ray) continue;
                         Colour(cell, &*ray);
                         rays->push_back(*ray);
                       }
                     });
}

}  // namespace lf
