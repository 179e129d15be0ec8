// What looks wrong in a capture, by its poses. Internal to import.
#pragma once

#include <span>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/import/capture_report.h"
#include "lf/import/find_brackets.h"

namespace lf {

// facing-away and diverging-axes.
std::vector<CaptureWarning> WarnOfDirections(const LightField& light_field);

// upside-down.
std::vector<CaptureWarning> WarnOfUpsideDown(const LightField& light_field);

// repeated-positions: those whose nearest other camera is closer than 1e-8 of the median.
//   nearest_w  as of NearestDistances() of the LF images `ids`
std::vector<CaptureWarning> WarnOfRepeats(const LightField& light_field,
                                          std::span<const LfImageId> ids,
                                          std::span<const double> nearest_w);

// brackets: the light field does not say how exposures differ, or keeps clipped pixels.
std::vector<CaptureWarning> WarnOfBrackets(const FoundBrackets& brackets, bool masks_clipped);

// sparse: for images so wide, with cameras so far apart.
std::vector<CaptureWarning> WarnOfSparseness(const Density& density, double width_px,
                                             double spacing_w);

}  // namespace lf
