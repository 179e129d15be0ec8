// SPDX-License-Identifier: Apache-2.0
// Positions of the rays of an LF camera with lens distortion, for the elements of a plate. Bending
// a ray takes up to 100 ns, too long for the six positions and more that every piece of every row
// needs. They are therefore computed for patches of many rows. Internal to collection.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "lf/collection/segments.h"
#include "lf/core/geometry.h"

namespace lf {

// Makes segments like SegmentMaker, for a smooth function of two coordinates. On a patch of up to
// 1024 x kRows elements, each coordinate of a position is a polynomial of degree 5 across times one
// of degree 5 down, through 6 x 6 positions. A patch on which it is not accurate enough is halved
// across; if it becomes narrower than it is high, its rows are fitted one by one. Patches lie at
// multiples of their size, so that positions do not depend on the elements that are asked for.
class PositionPatches {
 public:
  // Returns the position of a point (x, y) of the plate, or nothing if it has none.
  using Function = std::function<std::optional<Vec2>(double x, double y)>;

  explicit PositionPatches(Function position) : position_(std::move(position)) {}

  // Appends the segments of elements [x_begin, x_end) of row y, whose centres are at y + 0.5. Their
  // positions are within 2 SegmentMaker::kTolerance of the function, before polynomials are rounded
  // to single precision. Elements without a position are left out. Rows are best asked for from top
  // to bottom, because only the patches of one row of patches are kept.
  void Add(int y, int x_begin, int x_end, std::vector<Segment>* segments);

 private:
  static constexpr int kRows = 64;
  // [k].col(l): coefficient of t^k v^l. t is the distance from the middle column of the patch in
  // elements, v that from the middle row in halves of its height.
  using Surface = std::array<Eigen::Matrix<double, 2, Segment::kTerms>, Segment::kTerms>;
  struct Patch {
    int begin, end;                  // columns
    std::optional<Surface> surface;  // nullopt: its rows are fitted one by one
  };

  const std::vector<Patch>& PatchesOf(size_t block);
  void AddPatches(int begin, int end, std::vector<Patch>* patches) const;
  std::optional<Surface> Fit(int begin, int end) const;
  static Polynomials RowOf(const Surface& surface, double v);
  void AddPart(int y, int x_begin, int x_end, const Patch& patch,
               std::vector<Segment>* segments) const;

  Function position_;
  int band_ = -1;  // rows [kRows band_, kRows (band_ + 1)) are those of patches_
  // For each block of Segment::kMaxCount columns, the patches from left to right; empty if not yet
  // asked for.
  std::vector<std::vector<Patch>> patches_;
};

}  // namespace lf
