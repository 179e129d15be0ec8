// Focus distance and aperture of an example path. Internal to example_path.cc.
#pragma once

#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/focus/example_path.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct ExampleFocus {
  double distance_w = 0;
  std::string reason;
  // The reason why the focus is not sure; empty if it is sure. If it is not, candidates_w are at
  // most three distances that may be right, the best first.
  std::string doubt = {};
  std::vector<double> candidates_w = {};
  // Depths that the scene lies between, if they are known; otherwise equal.
  double near_w = 0, far_w = 0;
};

// Returns the focus as described at MakeExamplePath(). If the pixels and the points of a
// reconstruction contradict each other, the points decide if they are sure; otherwise the focus is
// not sure.
//   spacing_w  of LF cameras
Result<ExampleFocus> ChooseFocus(const LightField& light_field, const LfImageStore& store,
                                 const ExampleOptions& options, double spacing_w, ThreadPool& pool);

struct ExampleAperture {
  double spacings = 0;  // its diameter, in spacings of LF cameras
  std::string reason;
};

ExampleAperture ChooseAperture(const ExampleFocus& focus, double fx_px, double spacing_w);

}  // namespace lf
