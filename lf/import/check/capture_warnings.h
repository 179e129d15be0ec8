// SPDX-License-Identifier: Apache-2.0
// Finds faults of a capture in the poses of its cameras. capture_report.h describes the kinds of
// warnings. The functions return no warning if the fault is not there. Internal to this folder.
#pragma once

#include <span>
#include <vector>

#include "lf/import/check/capture_report.h"
#include "lf/import/check/find_brackets.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Returns the warning "facing-away" or "diverging-axes".
std::vector<CaptureWarning> WarnOfDirections(const LightField& light_field);

// Returns the warning "upside-down".
std::vector<CaptureWarning> WarnOfUpsideDown(const LightField& light_field);

// Returns the warning "repeated-positions" about cameras whose distance to the nearest neighbour is
// at most 1e-8 of the median of these distances. Distances that are only rounding errors do not
// count in the median.
//   nearest_w  NearestDistances() of the LF images `ids`
std::vector<CaptureWarning> WarnOfRepeats(const LightField& light_field,
                                          std::span<const LfImageId> ids,
                                          std::span<const double> nearest_w);

// Returns the warning "brackets" if the calibration does not state the gains of the exposures of a
// pose, or if clipped pixels are not masked.
//   import_again  as CaptureReportOptions::import_again
std::vector<CaptureWarning> WarnOfBrackets(const FoundBrackets& brackets, bool masks_clipped,
                                           const CallAgain& import_again);

// Returns the warning "sparse" if the ghosts Density::near_ghost_px are more than 1 % of the image
// width apart.
//   width_px   width of an LF image
//   spacing_w  median distance between neighbouring cameras
std::vector<CaptureWarning> WarnOfSparseness(const Density& density, double width_px,
                                             double spacing_w);

}  // namespace lf
