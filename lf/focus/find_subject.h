// Finds the depth of the subject of an LF image by comparing the LF images around it, and tells
// whether it is sure: a first picture must not be focused on a watermark.
#pragma once

#include <cstddef>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct SubjectDepth {
  double distance_w = 0;   // along the optical axis, in world units
  double share = 0;        // part of the weight of all found depths
  size_t place_count = 0;  // places of the image that lie there
};

struct Subject {
  std::vector<SubjectDepth> depths;  // at most three, the best first; none: nothing was found
  bool is_sure = false;              // true if the first depth is sure
  size_t place_count = 0;            // places of the image whose depth was found
  size_t textured_count = 0;         // places with texture, whose depth was searched
  // A tenth of the places lies nearer than near_w, a tenth farther than far_w. Both are 0 if no
  // place was found.
  double near_w = 0;
  double far_w = 0;
};

// Searches the depth of up to 176 places with texture, evenly spread over the image of `camera`.
// Compares each place with up to five rings of LF cameras around, every ring four times as wide as
// the one before: near cameras tell the depth without ambiguity, far ones precisely. The weight of
// a place depends on its texture, on how clearly the LF images agree on one depth, and on how near
// it is to the middle. Places that stand still in all images, and places that are so far that
// nothing moves, do not count. The best depth is the one around which most weight lies, within a
// few percent. It is sure if eight places lie there, with a tenth of the whole weight, and if
// depths were found for a quarter of the textured places.
//   store  one with Mosaics::kToRgb
// kInput: the image of `camera` cannot be loaded. Other images that cannot be loaded are left out.
// kOutput: the machine lacks memory or open files.
Result<Subject> FindSubject(const LightField& light_field, const LfImageStore& store,
                            LfImageId camera, ThreadPool& pool);

}  // namespace lf
