// Finds what looks wrong in a capture from its poses. Internal to this folder.
#pragma once

#include <span>
#include <vector>

#include "lf/import/check/capture_report.h"
#include "lf/import/check/find_brackets.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Warnings facing-away and diverging-axes.
std::vector<CaptureWarning> WarnOfDirections(const LightField& light_field);

// Warning upside-down.
std::vector<CaptureWarning> WarnOfUpsideDown(const LightField& light_field);

// Warning repeated-positions, for cameras whose nearest neighbour is closer than 1e-8 of the
// median.
//   nearest_w  NearestDistances() of the LF images `ids`
std::vector<CaptureWarning> WarnOfRepeats(const LightField& light_field,
                                          std::span<const LfImageId> ids,
                                          std::span<const double> nearest_w);

// Warning brackets, if the light field does not state how exposures differ, or keeps clipped
// pixels.
std::vector<CaptureWarning> WarnOfBrackets(const FoundBrackets& brackets, bool masks_clipped);

// Warning sparse, for images `width_px` wide and cameras `spacing_w` apart.
std::vector<CaptureWarning> WarnOfSparseness(const Density& density, double width_px,
                                             double spacing_w);

}  // namespace lf
