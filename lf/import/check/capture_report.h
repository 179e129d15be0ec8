// SPDX-License-Identifier: Apache-2.0
// Reports what the calibration of a light field says about the capture, and which parts of the
// calibration look wrong. No file is read.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/shell_word.h"
#include "lf/import/check/find_brackets.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct Spread {
  double min = 0;
  double median = 0;
  double max = 0;
};

// The LF cameras that share a distortion model and an image size. Each Spread is taken over all LF
// images of these cameras.
struct CameraGroup {
  DistortionModel model = DistortionModel::kNone;
  int width_px = 0;
  int height_px = 0;
  size_t image_count = 0;
  size_t intrinsics_count = 0;  // number of different intrinsics
  Spread fx_px, fy_px, cx_px, cy_px;
  Spread horizontal_fov_rad, vertical_fov_rad;  // field of view of the middle row, middle column
};

enum class DistanceSource {
  kStated,      // CaptureReportOptions::distance_w
  kDepthRange,  // reciprocal of the mean of 1 / near and 1 / far, for LightField::depth_range
  kMeeting,     // median distance from the cameras to the point where their axes meet
};

// How densely the cameras sample a scene at the distance z. b is the median spacing
// (CaptureReport::spacing_w), F the median fx_px of the largest group of cameras. Between
// neighbouring images, a point moves by the disparity F b / z pixels. A frame focused at z shows a
// point at z' as copies that are F b |1/z - 1/z'| pixels of an LF image apart. The copies are
// visible as ghosts if they are more than about a pixel apart.
struct Density {
  DistanceSource source = DistanceSource::kStated;
  double distance_w = 0;     // the distance z
  double spacing_rad = 0;    // angle under which the spacing b is seen from the distance z
  double disparity_px = 0;   // F b / z
  double near_ghost_px = 0;  // distance between copies of a point at z' = 0.75 z
  double far_ghost_px = 0;   // distance between copies of a point at z' = 1.25 z
};

struct CaptureWarning {
  std::string kind;                // a word for programs, such as "upside-down"
  std::string message;             // the fault and its remedy
  size_t image_count = 0;          // number of affected LF images; 0: the capture as a whole
  std::vector<std::string> names;  // names of the first 5 affected LF images

  friend bool operator==(const CaptureWarning&, const CaptureWarning&) = default;
};

struct CaptureReport {
  size_t image_count = 0;    // number of recorded LF images
  size_t virtual_count = 0;  // number of virtual LF images, which nothing else here counts
  size_t mask_count = 0;
  std::vector<CameraGroup> groups;  // the largest image_count first
  Vec3 box_min_w = Vec3::Zero();    // bounding box of the camera positions
  Vec3 box_max_w = Vec3::Zero();
  // Distance from a camera to its nearest neighbour. None for fewer than two cameras. LF images of
  // one pose with several exposures count as one camera.
  std::optional<Spread> spacing_w;
  std::optional<Vec3> meeting_point_w;  // where the optical axes meet: AxesMeetingPoint()
  std::optional<DepthRange> depth_range;
  double unit_m = 1;
  std::optional<AlphaMeaning> alpha;             // meaning of the images' alpha, if known
  std::array<double, 3> background = {0, 0, 0};  // radiance behind the images, if alpha is no mask
  bool keeps_opacity = false;             // true: nothing is behind the images; frames have opacity
  std::optional<Density> density;         // set if spacing_w and a distance to the scene are known
  std::optional<FoundBrackets> brackets;  // poses with several exposures
  std::vector<CaptureWarning> warnings;
};

struct CaptureReportOptions {
  std::optional<double> distance_w;  // distance to the scene; unset: from the other DistanceSources
  std::vector<double> lights = {};   // LightOf() (exif_gains.h) of each LF image; empty: unknown
  CallAgain import_again = {};       // repeats the call of lfimport in warnings; unset: a call with
                                     // placeholders
};

// Reports about a light field, which must have at least one LF image. Virtual LF images are only
// counted, unless there are no others: the report is about the capture. The kinds of warnings are:
//   facing-away         cameras that look away from the common point or direction of most cameras
//   diverging-axes      most cameras look away from the point where their axes meet
//   upside-down         cameras whose up axis is more than 120 degrees away from the common up
//   axis;
//                       not if all look in about one direction and more than a quarter of them are
//                       turned, as in a survey that is flown in lines to and fro
//   repeated-positions  cameras at the position of another camera, unless they are brackets
//   brackets            poses with several exposures that are not merged yet
//   sparse              ghosts at 0.75 z that are more than 1 % of the image width apart
CaptureReport ReportCapture(const LightField& light_field, const CaptureReportOptions& options,
                            ThreadPool& pool);

// Returns a warning about the LF images `ids`, with the names of the first 5.
CaptureWarning WarningAbout(const LightField& light_field, std::string kind, std::string message,
                            const std::vector<LfImageId>& ids);

}  // namespace lf
