// Makes a first camera path for a light field, ready to render, with comments that tell how to
// change it (the thesis's lrexample).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

enum class ExampleMove { kStatic, kOrbit, kDolly, kFocusPull };

// Parses "static", "orbit", "dolly" or "focus-pull"; none for any other text.
std::optional<ExampleMove> ParseExampleMove(std::string_view name);

struct ExampleOptions {
  LfImageId camera;  // the path starts where this LF image was taken
  ExampleMove move = ExampleMove::kFocusPull;
  std::optional<double> focus_distance_w;  // default: found by FindSubject()
  // Returns points of the scene that the LF image shows, in world coordinates; empty: there are no
  // points. It is called only if no focus distance is given.
  std::function<Result<std::vector<Vec3>>()> points_world = {};
};

struct ExamplePath {
  std::string yaml;
  double focus_distance_w = 0;
  std::string focus_reason;  // how it was found, for people
  double aperture_diameter_w = 0;
  std::string aperture_reason;  // for people; follows the diameter and a comma
  // The reason why the focus is not sure; empty if it is sure. If it is not, candidates_w are at
  // most three distances that may be right, the best first.
  std::string doubt;
  std::vector<double> candidates_w;
};

// Returns a path that shows something of the scene: one frame if nothing moves, otherwise 50.
// - Focus: at the subject (focus/find_subject.h). If the subject is not sure, or the points of a
//   reconstruction contradict it, at the depth of most points (focus/point_subject.h). If these are
//   not sure either, the focus is the first of these that is known, and `doubt` says so: where the
//   optical axes meet, the middle of the depth range, the best depth found, where neighbours see
//   points one pixel apart.
// - Lens: eight spacings of LF cameras wide, down to 2.5 if these are so far apart that a blur
//   falls into ghosts, and not wider than the capture. If ghosts are too far apart for any blur, or
//   the focus is not sure, almost a pinhole: the first frame is the view of one LF camera.
// - Picture: the largest part of the LF camera's view. It is level if the mean up direction of the
//   LF cameras is at most 30 degrees from the LF camera's own.
// kInput: the light field has fewer than two cameras, or most of them share their position; there
// is no LF image options.camera, or it is broken.
Result<ExamplePath> MakeExamplePath(const LightField& light_field, const LfImageStore& store,
                                    const ExampleOptions& options, ThreadPool& pool);

}  // namespace lf
