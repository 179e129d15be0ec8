// SPDX-License-Identifier: Apache-2.0
// Computes where the rays through the middles of cells pass the lens and meet the plate of one
// frame, for many rays at a time. Internal to rebinning.
//
// Let S and U be the points of a ray on the st and uv planes, relative to the lens centre of the
// frame. The ray S + l (U - S) passes the lens plane, forward . X = 0, at
//
//   X = (S (forward . U) - U (forward . S)) / (forward . (U - S))
//
// and meets the focus plane, n . X = o, at
//
//   X = (S (n . U - o) - U (n . S - o)) / (n . (U - S)).
//
// `forward` is the frame's viewing direction, n the normal of its focus plane, and o the distance
// of the focus plane from the lens centre along n. All these scalar products are linear forms of
// the four numbers of the cell.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "lf/rebinning/frame_rays.h"

namespace lf {

// The linear form constant + of_a a + of_b b, where a and b are the two numbers of a cell on one
// plane as they are in its key (kCellOffset is added to them).
struct CellForm {
  double constant = 0;
  double of_a = 0;
  double of_b = 0;
};

struct FrameView {
  FrameView(const Slab& slab, const RenderCamera& frame, const FrameReach& reach);

  // Scalar products of several vectors with X, a point of one slab plane relative to the lens
  // centre of the frame.
  struct OfPlane {
    CellForm forward, right, up;
    CellForm plate_x, plate_y;  // position on the plate times depth
    CellForm focus;             // n . X - o, which is 0 on the focus plane
  };
  OfPlane st, uv;
  double lens_reach2_w2;
  std::array<double, 2> plate_low_px;
  std::array<double, 2> plate_high_px;
};

struct SeenCells {
  static constexpr size_t kAtOnce = 64;
  size_t count = 0;
  // ascending indices of the seen cells among the `cells` of FindSeenCells()
  std::array<size_t, kAtOnce> cells;
  std::array<double, kAtOnce> lens_x_w, lens_y_w, x_px, y_px;
};

// Finds the cells whose middle rays the frame sees (those that FrameRaysOf() does not leave out if
// all squares need rays). There must be at most kAtOnce cells.
void FindSeenCells(const FrameView& view, std::span<const BinnedCell> cells, SeenCells* seen);
// Computes where one ray passes the lens and meets the plate. It is used for rays that do not
// belong to cells, and as the reference of FindSeenCells().
class RayView {
 public:
  RayView(const RenderCamera& frame, const FrameReach& reach);

  // Returns the ray as the frame sees it, without its colour; none if it is not seen.
  std::optional<FrameRay> See(const Ray& ray) const;
  // Like See(), but `lens_point` is used as the ray's point of the lens, at any distance from the
  // lens centre.
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
