// A first camera path for a light field, ready to render and commented to be changed (the
// thesis's lrexample).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  std::optional<double> focus_distance_w;  // default: found by FindSubject()
  // Gives points of the scene that the LF image shows, in world coordinates; without it there are
  // no points. It is asked where no focus distance is stated.
  std::function<Result<std::vector<Vec3>>()> points_world = {};
};

struct ExamplePath {
  std::string yaml;
  double focus_distance_w = 0;
  std::string focus_reason;  // how it was found, for people
  double aperture_diameter_w = 0;
  std::string aperture_reason;  // for people, behind the diameter and a comma
  // Empty if the focus is sure; else why it is not, and up to three distances that may be right,
  // the best first.
  std::string doubt;
  std::vector<double> candidates_w;
};

// A path that shows something: one frame if nothing moves, else 50.
// - Focus: at the subject (focus/find_subject.h). Where that is not sure, or the points of a
//   reconstruction contradict it, at the depth of most of these (focus/point_subject.h). Where
//   these do not tell either, where the optical axes meet, or else in the middle of the depth
//   range, at the best depth found, or where neighbours see things a pixel apart; `doubt` says so.
// - Lens: eight spacings of LF cameras wide, down to 2.5 where these are so far apart that a blur
//   falls into copies, and no wider than the capture. Where copies are too far apart for any blur,
//   or the focus is not sure, next to a pinhole: the first frame is what one LF camera sees.
// - Picture: the largest part of what the LF camera sees, level where the LF cameras' mean up
//   direction is at most 30 degrees from its own.
// kInput: a light field of fewer than two cameras, or most of which share their position; no such
// camera, its image broken.
Result<ExamplePath> MakeExamplePath(const LightField& light_field, const LfImageStore& store,
                                    const ExampleOptions& options, ThreadPool& pool);

}  // namespace lf
