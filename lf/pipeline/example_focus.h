// Focus distance and aperture of an example path. Internal to example_path.cc.
#pragma once

#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/pipeline/example_path.h"
#include "lf/store/lf_image_store.h"

namespace lf {

struct ExampleFocus {
  double distance_w = 0;
  std::string reason;
  // Empty if the focus is sure; else why it is not, and at most three distances that may be right,
  // the best first.
  std::string doubt = {};
  std::vector<double> candidates_w = {};
  // The scene lies between these, if that is known; else they are equal.
  double near_w = 0, far_w = 0;
};

// Returns the focus as ExamplePath says. Where pixels and the points of a reconstruction contradict
// each other, the points tell the focus if they are sure; else it is not sure.
//   spacing_w  of LF cameras
Result<ExampleFocus> ChooseFocus(const LightField& light_field, const LfImageStore& store,
                                 const ExampleOptions& options, double spacing_w, ThreadPool& pool);

struct ExampleAperture {
  double spacings = 0;  // its diameter, in spacings of LF cameras
  std::string reason;
};

ExampleAperture ChooseAperture(const ExampleFocus& focus, double fx_px, double spacing_w);

}  // namespace lf
