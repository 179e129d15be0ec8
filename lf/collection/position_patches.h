// SPDX-License-Identifier: Apache-2.0
// Positions of the rays of an LF camera with lens distortion, for the elements of a plate. Bending
// a ray takes up to 100 ns, too long for the six positions and more that every piece of every row
// needs. They are therefore computed for patches of many rows. Internal to collection.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "lf/collection/segments.h"
#include "lf/core/geometry.h"

namespace lf {

// Makes segments like SegmentMaker, for a smooth function of two coordinates. On a patch of up to
// kBlock x kBlock elements, each coordinate of a position is a polynomial of degree 5 across times
// one of degree 5 down, through 6 x 6 positions. A patch on which it is not accurate enough is
// halved, across or down; if it becomes too small, its rows are fitted one by one. Patches lie at
// multiples of their size, so that positions do not depend on the elements that are asked for.
class PositionPatches {
 public:
  // Returns the position of a point (x, y) of the plate, or nothing if it has none.
  using Function = std::function<std::optional<Vec2>(double x, double y)>;

  // Bounds of the positions of a segment, which are a little wider than necessary.
  struct PositionBounds {
    Vec2 low, high;
  };

  //   elements  all elements that will be asked for; only bounds depend on it
  PositionPatches(Function position, const PixelRect& elements)
      : position_(std::move(position)), elements_(elements) {}

  // Appends the segments of elements [x_begin, x_end) of row y, whose centres are at y + 0.5. Their
  // positions are within 2 SegmentMaker::kTolerance of the function, before polynomials are rounded
  // to single precision. Elements without a position are left out. Rows are best asked for from top
  // to bottom, because only the patches of one row of blocks are kept.
  //   bounds  replaced by the bounds of the segments, which are valid until the next call; nullptr
  //           where none are known
  void Add(int y, int x_begin, int x_end, std::vector<Segment>* segments,
           std::vector<const PositionBounds*>* bounds);

 private:
  static constexpr int kBlock = Segment::kMaxCount;
  static constexpr int kLeastSize = 64;  // of a patch, across and down
  static constexpr int kTerms = Segment::kTerms;

  // (k, axis): coefficient of t^k in the x-coordinate (axis 0) or the y-coordinate (axis 1) of
  // positions along a row. t is the distance from the middle column of the patch, in elements.
  using RowPowers = Eigen::Array<double, kTerms, 2>;
  // [l]: the part of a row's powers that is multiplied by v^l. v is the distance of the row from
  // the middle row of the patch, in halves of its height.
  using Surface = std::array<RowPowers, kTerms>;

  enum class State : uint8_t {
    kUnknown,  // not fitted yet
    kSurface,
    kHalved,
    kRowByRow  // its rows are fitted one by one
  };
  struct Patch {
    PixelRect rect;
    State state = State::kUnknown;
    bool is_near_middle = false;    // IsNearMiddle() is true for all rows
    bool allows_parabolas = false;  // AllowParabolas() is true for all rows
    Surface surface;
    PositionBounds bounds;  // of all elements of elements_ on the patch
    Patch* halves[2] = {nullptr, nullptr};
  };
  enum class Direction : uint8_t { kAcross, kDown };

  // Sets row_ to the patches that contain elements [x_begin, x_end) of row y.
  void FindRow(int y, int x_begin, int x_end);
  void FindRowOn(Patch* patch, int y, int x_begin, int x_end);
  void AddOnPatch(int y, int x_begin, int x_end, const Patch& patch, std::vector<Segment>* segments,
                  std::vector<const PositionBounds*>* bounds) const;
  void Decide(Patch* patch);
  // Makes the surface and its bounds. Returns nothing if the surface is accurate, otherwise the
  // direction in which the patch should be halved.
  std::optional<Direction> Fit(Patch* patch) const;
  PositionBounds BoundsOf(const Patch& patch) const;
  static Polynomials RowOf(const Surface& surface, double v);
  // Returns, for each coefficient, an upper bound of its absolute value in all rows.
  static Polynomials MostOf(const Surface& surface);
  static Polynomials FromPowers(const RowPowers& powers);
  static Direction RoughDirection(const Surface& surface, double half_x);

  Function position_;
  PixelRect elements_;
  int band_ = -1;  // rows [kBlock band_, kBlock (band_ + 1)) are those of patches_
  std::deque<Patch> patches_;
  std::vector<Patch*> blocks_;  // the patches of kBlock x kBlock elements, from left to right
  // The patches of the row that was asked for last, from left to right. They serve all rows
  // [row_y_begin_, row_y_end_).
  std::vector<const Patch*> row_;
  int row_y_begin_ = 0, row_y_end_ = 0;
};

}  // namespace lf
