// SPDX-License-Identifier: Apache-2.0
// Finds the depth of the subject of an LF image by comparing it with the LF images around it, and
// tells whether the depth is sure, so that a first picture is not focused on a watermark.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Largest Subject::share_before of a depth that is sure.
inline constexpr double kMostBefore = 0.5;

struct SubjectDepth {
  double distance_w = 0;   // the depth, along the optical axis
  double share = 0;        // weight of the places near this depth, as a share of all weight
  size_t place_count = 0;  // number of places of the image near this depth
};

struct Subject {
  std::vector<SubjectDepth> depths;  // at most three, the best first; empty: no depth was found
  bool is_sure = false;              // true if the first depth is sure
  size_t place_count = 0;            // number of places whose depth was found
  size_t textured_count = 0;         // number of places with texture, whose depth was searched
  // 1 / depth of the places whose depth was found, in ascending order; 0 for each place that is too
  // far away to move.
  std::vector<double> per_w;
  // Number of textured places at which neighbouring LF images agree on no depth. At the others
  // without a depth they agree on several, as on repeating patterns.
  size_t disagreeing_count = 0;
  // A tenth of the places with a precise depth is nearer than near_w, a tenth is farther than
  // far_w. near_w and far_w are 0 if no depth was found.
  double near_w = 0;
  double far_w = 0;
  // True if near_w and far_w are sure, even if the subject is not: depths were found for at least a
  // quarter of the textured places, and eight of them, with a tenth of all weight, share one.
  bool is_range_sure = false;
  double share_before = 0;  // share of the weight that lies more than 15 % before the first depth
  // Reasons why LF images could not be loaded; each names its file.
  std::vector<std::string> missing;
};

// Searches the depth of up to 176 places with texture, spread evenly over the image of `camera`.
// Each place is compared with up to six rings of LF cameras around `camera`, each two or four times
// as wide as the one before. Near cameras tell the depth without ambiguity, far cameras tell
// it precisely. The weight of a place depends on its texture, on how clearly the LF images agree on
// one depth, and on how near the place is to the middle of the image. Places that do not move from
// image to image do not count: watermarks, and places that are too far away.
//
// The best depth is the depth around which most weight lies, or a nearer one around which still
// much weight lies (best_depths.h). It is sure if at least eight places and an eighth of all
// textured places, with together at least a tenth of the whole weight, lie around it; if not more
// than kMostBefore of the weight lies before it; and if depths were found for at least 40 % of the
// textured places. If more of the weight lies before it, the best depth before it comes first.
//   store  a store with Mosaics::kToRgb
// kInput: the image of `camera` cannot be loaded. Other images that cannot be loaded are left out.
// kOutput: the machine lacks memory or open files.
Result<Subject> FindSubject(const LightField& light_field, const LfImageStore& store,
                            LfImageId camera, ThreadPool& pool);

}  // namespace lf
