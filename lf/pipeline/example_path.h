// A first camera path for a light field, ready to render and commented to be changed (the
// thesis's lrexample).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/store/lf_image_store.h"

namespace lf {

enum class ExampleMove { kStatic, kOrbit, kDolly, kFocusPull };

// "static", "orbit", "dolly", "focus-pull"; none for anything else.
std::optional<ExampleMove> ParseExampleMove(std::string_view name);

struct ExampleOptions {
  LfImageId camera;  // the path starts where this LF image was taken
  ExampleMove move = ExampleMove::kFocusPull;
  std::optional<double> focus_distance_w;  // default: where the optical axes meet, else the
                                           // sharpest of a sweep of planes
};

struct ExamplePath {
  std::string yaml;
  double focus_distance_w = 0;
  std::string focus_reason;  // how it was found, for people
  double aperture_diameter_w = 0;
};

// The lens covers about eight spacings of LF cameras, and no more than the capture does.
// kInput: a light field of fewer than two cameras, no such camera, broken images.
Result<ExamplePath> MakeExamplePath(const LightField& light_field, const LfImageStore& store,
                                    const ExampleOptions& options, ThreadPool& pool);

}  // namespace lf
