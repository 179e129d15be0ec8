// SPDX-License-Identifier: Apache-2.0
// Adds up the light that the views of a plane sweep have at the elements of a row. Internal to this
// folder.
//
// A view is sampled at the position where it shows an element at the distance of the plane. The
// root of the light there is interpolated between four pixels with weights of 1/256 px, and rounded
// to an integer. All sums are integers, so that they do not depend on the order of the views.
//
// AddViewReference() says what is added, one view and element at a time. AddView() computes the
// same bits for several elements at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/analysis/depth/lens_views.h"
#include "lf/camera/render_camera.h"

namespace lf {

inline constexpr size_t kLensQuarters = 4;

// The sums of a row of elements. `element` is the index in the row.
class RowSums {
 public:
  // All sums are 0.
  explicit RowSums(int element_count)
      : element_count_(element_count),
        room_(static_cast<size_t>(element_count) + kMostAtOnce),
        roots_(kLensQuarters * room_ * 4),
        squares_(kLensQuarters * room_ * 2) {}

  int element_count() const { return element_count_; }
  void Clear();

  // The number of views of a quarter of the lens (LensView::Quarter()) that see the element.
  uint32_t Count(size_t quarter, size_t element) const { return Roots(quarter, element)[3]; }
  // Sum of their roots of light in colour 0 (R) to 2 (B).
  uint32_t Root(size_t quarter, size_t element, size_t colour) const {
    return Roots(quarter, element)[colour];
  }
  // Sum of the squares of their roots in all colours.
  uint64_t Squares(size_t quarter, size_t element) const {
    const uint64_t* const pair = &squares_[2 * (quarter * room_ + element)];
    return pair[0] + pair[1] - Count(quarter, element);
  }

  // Sums in the form in which they are added; there is room for kMostAtOnce elements behind the
  // last one.
  //   RootsOf    [element][4]: sums of the roots of R, G and B, and the number of views
  //   SquaresOf  [element][2]: sums of R^2 + G^2, and of B^2 + 1
  uint32_t* RootsOf(size_t quarter) { return &roots_[4 * quarter * room_]; }
  uint64_t* SquaresOf(size_t quarter) { return &squares_[2 * quarter * room_]; }

  // Largest number of elements whose sums AddView() adds at once.
  static constexpr size_t kMostAtOnce = 8;

 private:
  const uint32_t* Roots(size_t quarter, size_t element) const {
    return &roots_[4 * (quarter * room_ + element)];
  }

  int element_count_;
  size_t room_;
  std::vector<uint32_t> roots_;    // [quarter][element][4]
  std::vector<uint64_t> squares_;  // [quarter][element][2]
};

// A view, and its positions of the elements of a plate that lie at one distance.
struct ViewOfPlane {
  ViewOfPlane(const LensView& lens_view, const RenderCamera& frame, double distance_w)
      : view(&lens_view), positions(lens_view, frame, distance_w) {}
  const LensView* view;
  PlanePositions positions;
};

// Adds the light of a view at the elements from (x_begin, y) on to their sums. Positions at which
// the view has no four pixels, or one of them is masked, add nothing.
void AddViewReference(const ViewOfPlane& plane, int x_begin, int y, RowSums* sums);
void AddView(const ViewOfPlane& plane, int x_begin, int y, RowSums* sums);

}  // namespace lf
