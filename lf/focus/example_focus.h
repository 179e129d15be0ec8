// SPDX-License-Identifier: Apache-2.0
// Chooses the focus distance of an example path. Internal to example_path.cc.
#pragma once

#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/focus/example_path.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// The depths of places of an LF image, or of points that it shows.
struct SeenDepths {
  std::vector<double> per_w = {};  // 1 / depth of those whose depth is known
  size_t count = 0;                // number of all, also of those whose depth is unknown
};

struct ExampleFocus {
  double distance_w = 0;
  std::string reason;
  // The reason why the focus may be wrong; empty if the focus is sure. If there is a doubt,
  // candidates_w holds at most three focus distances to try, the most likely first.
  std::string doubt = {};
  std::vector<double> candidates_w = {};
  // A range of depths that contains the focus and four fifths of the depths found in the scene.
  // Both ends are 0 if the focus is given by the user or not sure.
  double near_w = 0, far_w = 0;
  // Textured places of the LF image, but those at which LF images agree on several depths; none if
  // it cannot be loaded.
  SeenDepths places = {};
  SeenDepths points = {};  // if the focus is at the depth of points: these points
};

// Returns the focus as described at MakeExamplePath(). If the points of a reconstruction contradict
// the depth found in the pixels, uses the depth of the points if that depth is sure; otherwise sets
// `doubt`. If the focus is given, errors of FindSubject() that are kInput leave `places` empty.
//   spacing_w  distance between neighbouring LF cameras
Result<ExampleFocus> ChooseFocus(const LightField& light_field, const LfImageStore& store,
                                 const ExampleOptions& options, double spacing_w, ThreadPool& pool);

}  // namespace lf
