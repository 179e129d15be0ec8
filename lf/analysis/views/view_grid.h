// SPDX-License-Identifier: Apache-2.0
// A regular grid of views of a light field: pinhole cameras in a plane that look in one direction,
// as 4D light fields have them (thesis 6.2).
#pragma once

#include <optional>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Limit of the number of columns and of rows.
inline constexpr int kMostViewsAcross = 4096;

class ViewGrid {
 public:
  // Places the views evenly in the rectangle around the LF cameras, along the mean right and down
  // axes of these, in the plane through their mean position. A single column or row is in the
  // middle. The views have the intrinsics of the recorded LF camera in the middle without
  // distortion. If the principal points of all LF cameras move evenly with their positions, as in a
  // slab that is rectified to a plane, so do those of the views. kInput: LF cameras look more than
  // kMostTurn_deg (densify/camera_plane.h) from their mean direction. kUsage: columns or rows are
  // not from 1 to kMostViewsAcross.
  static Result<ViewGrid> Make(const LightField& light_field, int columns, int rows);

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  size_t size() const { return static_cast<size_t>(columns_) * static_cast<size_t>(rows_); }
  // Views are numbered by row, then by column; row 0 is the upper one and column 0 the left one.
  int column_of(size_t view) const { return static_cast<int>(view) % columns_; }
  int row_of(size_t view) const { return static_cast<int>(view) / columns_; }

  // Returns the position of a view from the middle of the LF cameras: x to the right, y down.
  Vec2 Position_w(size_t view) const;
  PinholeCamera Camera(size_t view) const;
  int width_px() const { return k_.width_px; }
  int height_px() const { return k_.height_px; }
  // Distances from one column, and from one row, to the next; 0 if there is only one.
  const Vec2& step_w() const { return step_w_; }

  // Returns the LF camera that stands at the place of the view, unless it is virtual: at most
  // kCoincident of the grid's smaller step away. None if there is none, or if the LF images are
  // brackets (RadianceEncoding::masks_clipped), which are merged by rendering.
  std::optional<LfImageId> RecordedAt(size_t view) const { return recorded_[view]; }
  static constexpr double kCoincident = 0.01;

 private:
  void FindRecorded(const LightField& light_field, const std::vector<Vec2>& points_w);

  int columns_ = 1;
  int rows_ = 1;
  RigidTransform cam_from_world_;  // of a view in the middle of the LF cameras
  Vec2 first_w_ = Vec2::Zero();
  Vec2 step_w_ = Vec2::Zero();
  Intrinsics k_;  // of a view in the middle of the LF cameras
  Vec2 principal_px_per_w_ = Vec2::Zero();
  std::vector<std::optional<LfImageId>> recorded_;
};

}  // namespace lf
