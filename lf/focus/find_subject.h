// Finds the depth of what a camera looks at by comparing the LF images around it, and tells how
// sure that is: a first picture must not be focused on a watermark.
#pragma once

#include <cstddef>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

struct SubjectDepth {
  double distance_w = 0;   // along the optical axis, in world units
  double share = 0;        // of all that was found, by weight
  size_t place_count = 0;  // places of the image that lie there
};

struct Subject {
  std::vector<SubjectDepth> depths;  // at most three, the best first; none: nothing was found
  bool is_sure = false;              // of the first
  size_t place_count = 0;            // places of the image whose depth was found
  size_t textured_count = 0;         // places that were looked at
  // A tenth of the places lies nearer than near_w, a tenth farther than far_w. Both are 0 if no
  // place was found.
  double near_w = 0;
  double far_w = 0;
};

// Looks at up to 176 places with texture, evenly spread over the image of `camera`, and compares
// each with up to five rings of LF cameras around, every ring four times as wide as the one before:
// near ones tell the depth without doubt, far ones exactly. A place counts by its texture, by how
// well the LF images agree on one depth and on no other, and by how near it is to the middle. What
// stands still in all images, and what is so far that nothing moves, does not count. The best depth
// is the one around which most lies, within a few percent. Sure: eight places lie there, with a
// tenth of the weight of all, and depths were found for a quarter of the textured places.
//   store  one with Mosaics::kToRgb
// kInput: the image of `camera` cannot be loaded. Others that cannot be loaded are left out.
// kOutput: the machine lacks memory or open files.
Result<Subject> FindSubject(const LightField& light_field, const LfImageStore& store,
                            LfImageId camera, ThreadPool& pool);

}  // namespace lf
