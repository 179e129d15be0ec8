// The lens points and plate positions of the middle rays of cells in one frame, many rays at a
// time. Internal to rebinning.
//
// With S on the st plane and U on the uv plane, both from the frame's centre, a ray S + l (U - S)
// passes the lens plane, forward . X = 0, where
//
//   X = (S (forward . U) - U (forward . S)) / (forward . (U - S))
//
// and meets the focus plane, n . X = o, where X = (S (n . U - o) - U (n . S - o)) / (n . (U - S)).
// All
// of these scalar products are linear forms of the cell's four numbers.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "lf/rebinning/frame_rays.h"

namespace lf {

// The linear form constant + of_a a + of_b b of a cell's two numbers on one plane.
struct CellForm {
  double constant = 0;
  double of_a = 0;
  double of_b = 0;
};

struct FrameView {
  FrameView(const Slab& slab, const RenderCamera& frame, const FrameReach& reach);

  // Scalar products of a vector and a point of one slab plane, seen from the frame's centre.
  struct OfPlane {
    CellForm forward, right, up;
    CellForm plate_x, plate_y;  // rows of the calibration matrix, before they are divided
    CellForm focus;             // n . X - o
  };
  OfPlane st, uv;
  double lens_reach2_w2;
  std::array<double, 2> plate_low_px;
  std::array<double, 2> plate_high_px;
};

struct SeenCells {
  static constexpr size_t kAtOnce = 64;
  size_t count = 0;
  std::array<size_t, kAtOnce> cells;  // indices of the given cells that are seen, ascending
  std::array<double, kAtOnce> lens_x_w, lens_y_w, x_px, y_px;
};

// Finds the cells whose middle rays the frame sees. There must be at most kAtOnce cells.
void FindSeenCells(const FrameView& view, std::span<const BinnedCell> cells, SeenCells* seen);
// Views one ray at a time: for rays that are not of cells, and as the reference of FindSeenCells().
class RayView {
 public:
  RayView(const RenderCamera& frame, const FrameReach& reach);

  // Returns the ray as the frame sees it, without its colour; none if it is not seen.
  std::optional<FrameRay> See(const Ray& ray) const;
  // Like See(), but the ray counts as one through `lens_point`, at any distance from the lens.
  std::optional<FrameRay> At(const Vec2& lens_point, const Ray& ray) const;

 private:
  Vec3 centre_, right_, up_, forward_;
  Plane focus_plane_;
  Mat3 plate_from_world_;
  double lens_reach2_w2_;
  double margin_px_;
  int width_px_, height_px_;
};

}  // namespace lf
