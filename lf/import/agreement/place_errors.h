// SPDX-License-Identifier: Apache-2.0
// Measures how far LF images show places from where their cameras should show them. Internal to
// this folder.
#pragma once

#include <vector>

#include "lf/import/agreement/find_places.h"
#include "lf/import/agreement/pose_repair.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct PlaceError {
  // Distance between where an LF image shows the place and where it should, in reduced pixels; at
  // most kMost, which is also the error of a place behind a camera.
  static constexpr double kMost = 1000;
  double reduced_px = 0;
  // Error up to which LF images and cameras agree: a quarter of the way that the place moves
  // between LF images, because wrong poses cause errors as long as this way; from 0.5 to 2 reduced
  // pixels.
  double tolerance = 0;

  bool agrees() const { return reduced_px <= tolerance; }
};

class PlaceErrors {
 public:
  // Keeps references to all arguments, which must outlive this object.
  PlaceErrors(const LightField& light_field, const std::vector<SeenPlace>& places, int divisor);

  // Returns the error of each place, in reduced pixels, with the cameras after a repair. The point
  // of a place lies on the ray of SeenPlace::from. Its depth is the one for which three quarters of
  // the other LF images have the least error: no error at all, but for the epipolar line, if there
  // is only one. LF images that a repair leaves without a pose are left
  // out.
  //   step  only each step-th place is measured
  std::vector<PlaceError> Of(const Repair& repair, size_t step = 1) const;

 private:
  const LightField& field_;
  const std::vector<SeenPlace>& places_;
  const int divisor_;
  const bool is_rectified_;
  std::vector<uint32_t> images_;  // the LF images that show a place, ascending
};

}  // namespace lf
