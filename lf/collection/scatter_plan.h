// The segments of a scatter plan, from spans of accepted pixels. Internal to collection.
#pragma once

#include "lf/collection/cubic_segments.h"
#include "lf/collection/scatter.h"

namespace lf {

// An empty list of this thread's, whose memory is used again by the next plan.
std::vector<CubicSegment>& ScratchSegments();

// `segments` with what tiles need to know of them.
ScatterPlan MakeScatterPlan(const std::vector<CubicSegment>& segments, int plate_width,
                            int plate_height);

// Candidates reach this far beyond the edges of polygonal lenses; the law decides.
inline constexpr double kLensMargin = 1e-7;

}  // namespace lf
