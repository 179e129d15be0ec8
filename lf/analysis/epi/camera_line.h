// SPDX-License-Identifier: Apache-2.0
// Finds the LF cameras that stand in a row or a column with one of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// kRow: LF cameras beside each other, as they see it; kColumn: above each other.
enum class LineKind { kRow, kColumn };

struct CameraLine {
  std::vector<LfImageId> ids;       // by ascending position, at least two
  std::vector<double> positions_w;  // along the line; 0 at the LF camera that was asked for
  std::vector<double> distances_w;  // from the line
  Vec3 direction_world;             // length 1; to the right (kRow) or down (kColumn)
  // Rotation from world axes to those of a camera whose x axis (kRow) or y axis (kColumn) is the
  // line, and whose z axis is, as far as that allows, the mean direction in which the LF cameras
  // look.
  Mat3 rotation;
  double pitch_w = 0;  // mean distance from an LF camera to the next
  // True if no LF camera is farther than kEven times the pitch from its place among as many even
  // positions.
  bool is_even = false;
  static constexpr double kEven = 0.02;
};

// Returns the LF cameras within `tolerance_w` of a line through the LF camera `through`. The line
// begins as the mean right axis (kRow) or down axis (kColumn) of all LF cameras. It is fitted to
// those that are near it, first to the nearest ones of `through`, then to ever farther ones.
//   tolerance_w  unset: a quarter of the median distance between LF cameras (MedianSpacing())
// kInput: no other LF camera is that near, or the LF cameras of the line look along it.
Result<CameraLine> FindCameraLine(const LightField& light_field, LfImageId through, LineKind kind,
                                  std::optional<double> tolerance_w);

// Returns the LF image with a name, as the calibration states it, or the only one whose file has
// this name in any folder.
// kUsage: there is none, or there are several; the message suggests the nearest name. kUsage if it
// is virtual, because it was not taken by any camera; the message names the nearest recorded ones.
Result<LfImageId> LfImageNamed(const LightField& light_field, const std::string& name);

}  // namespace lf
