// SPDX-License-Identifier: Apache-2.0
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

// kAuto is kAlong if the LF images are a dense recorded track (IsDenseTrack() in
// focus/moves/recorded_track.h), otherwise kFocusPull.
enum class ExampleMove { kAuto, kStatic, kAlong, kOrbit, kDolly, kFocusPull };

// Parses "auto", "static", "along", "orbit", "dolly" or "focus-pull"; returns nullopt for any other
// text.
std::optional<ExampleMove> ParseExampleMove(std::string_view name);

// Returns what a path does at its LF camera, to be followed by the camera's name: "starts at",
// "moves around" or "passes".
const char* StartWords(ExampleMove move);

struct ExampleOptions {
  LfImageId camera;  // LF image whose LF camera the path starts at, passes or moves around
  ExampleMove move = ExampleMove::kAuto;
  std::optional<double> focus_distance_w;  // unset: MakeExamplePath() finds it
  bool densify = false;  // true: virtual LF images will be put into the lens (lf/densify)
  // Returns points of the scene that the LF image shows, in world coordinates. May be left empty if
  // the light field has no points. Called only if focus_distance_w is unset.
  std::function<Result<std::vector<Vec3>>()> points_world = {};
  // Not empty: a reason to doubt every depth that is found, such as poses that do not belong to the
  // images. The focus is then not sure.
  std::string doubt = {};
};

struct ExamplePath {
  std::string yaml;
  ExampleMove move = ExampleMove::kStatic;  // the chosen one if kAuto was asked for
  double focus_distance_w = 0;
  std::string focus_reason;  // how the focus distance was found, for people
  double aperture_diameter_w = 0;
  std::string aperture_reason;  // reason of the diameter, to be printed after "DIAMETER, "
  // A sentence that says how far the camera or the focus moves and what limits that (empty if
  // nothing moves), and why the film may disappoint (empty if there is nothing to say).
  std::string move_note;
  std::string move_warning;
  // The reason why the focus may be wrong; empty if the focus is sure. If there is a doubt,
  // candidates_w holds at most three focus distances to try, the most likely first.
  std::string doubt;
  std::vector<double> candidates_w;
};

// Returns the LF camera nearest to the middle of the capture whose LF image can be read and that is
// level within 3 degrees, because levelling a picture crops it. If no LF camera is both, returns
// the nearest one whose LF image can be read; if none can be read, the nearest one. kOutput: the
// machine lacks memory or open files. The light field must have a camera.
Result<LfImageId> FirstCamera(const LightField& light_field, const LfImageStore& store);

// Returns a path that shows something of the scene: one frame if nothing moves, otherwise 50 (an
// orbit, or along a track, up to 101).
// - Focus: at options.focus_distance_w if it is set, otherwise on the subject
//   (focus/find_subject.h). If the subject is not sure, or the points of a reconstruction
//   contradict it, the focus is at the depth of most points (focus/point_subject.h). If that depth
//   is not sure either, `doubt` is set, and the focus is the first of these that is known: the best
//   depth found, if LF images agree on one at 40 % of the textured places; the depth of most
//   points; the middle of the depth range; the point where the optical axes meet; the best depth
//   that some LF images agree on; the depth at which the disparity of neighbouring LF images is one
//   pixel.
// - Lens: its diameter is eight spacings of the LF cameras, or less if ghosts would otherwise be
//   visible (focus/example_aperture.h). It is never wider than the capture or a quarter of the
//   focus distance, and holds six LF cameras or more. If that is impossible, if the ghosts are more
//   than 16 pixels apart, or if the focus is not sure, the lens is almost a pinhole, and the first
//   frame is the view of one LF camera.
//   If virtual LF images will be put into it, it is as wide as a picture with a clear blur needs
//   (ChooseDensifiedAperture()), also in captures whose LF cameras are far apart.
// - Focus pull: through the depths found in the scene, from at least 0.7 to at most 1.6 times the
//   focus distance.
// - A moving camera: the lens is at most half as wide as the LF cameras reach, so that the rest is
//   left to the movement (focus/moves/), even if fewer than six LF cameras are in it then;
//   aperture_reason tells that. It keeps looking at the subject, which stays in focus. Its
//   frames may be cropped to as little as 70 % of their width, so that LF cameras have recorded
//   them; move_warning tells if that is not enough.
// - Picture: the largest rectangle within the view of the LF camera, in the proportions of the LF
//   image, at most 1920 elements wide. Its horizon is level if the LF camera is rolled by at most
//   30 degrees. It is shifted on the plate (camera.shift) if the principal point of the LF camera
//   is off-centre.
// kInput: the light field has fewer than two LF cameras, or most of them share their position with
// another; the LF image options.camera does not exist; the camera has no room for a visible
// movement, or there is no recorded track (FindTrack()). If the focus has to be found, also errors
// of options.points_world() and FindSubject().
Result<ExamplePath> MakeExamplePath(const LightField& light_field, const LfImageStore& store,
                                    const ExampleOptions& options, ThreadPool& pool);

}  // namespace lf
