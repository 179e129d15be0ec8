// SPDX-License-Identifier: Apache-2.0
// The epipolar picture of a row or a column of LF cameras: the same line of pixels of each LF
// image, side by side. A point of the scene is a straight line in it, whose slope tells its depth.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "lf/analysis/epi/camera_line.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// How the lines of the picture are made of LF images.
//   kRecorded  one line for each LF image, in the order of their positions
//   kNearest   lines at even positions, each of the nearest LF image
//   kLinear    lines at even positions, each interpolated between the LF images before and behind
//   kAuto      kRecorded if the positions are even (CameraLine::is_even), otherwise kNearest
enum class EpipolarLines { kAuto, kRecorded, kNearest, kLinear };

struct EpipolarOptions {
  LineKind kind = LineKind::kRow;
  // The line of pixels: a pixel row (kRow) or a pixel column (kColumn) of the view of `through`.
  int pixel = 0;
  LfImageId through = LfImageId{0};
  std::optional<double> tolerance_w = {};  // as for FindCameraLine()
  // A point at this depth is at the same pixel of every line. Unset: a point at infinity is.
  std::optional<double> focus_distance_w = {};
  EpipolarLines lines = EpipolarLines::kAuto;
  // Number of lines at even positions; unset: as many as LF images. Unused by kRecorded.
  std::optional<size_t> line_count = {};
  bool strict = false;                      // true: an LF image that cannot be loaded is an error
  const std::atomic<bool>* stop = nullptr;  // once true, the work ends with kInterrupted
};
inline constexpr size_t kMostEpipolarLines = 100'000;

// All LF images are resampled to pinhole cameras that look in one direction (CameraLine::rotation)
// and have the intrinsics of the LF image `through` without lens distortion. In the picture, a
// point at depth z in front of them has the slope
//
//   dx/ds = -f (1 / z - 1 / g)                              (thesis 6.2)
//
// in pixels per world unit, where s is the position of the camera, f the focal length in pixels
// along the line of pixels, and g the focus distance.
struct EpipolarPicture {
  // Linear light [line][pixel][3] (light_field/model/lf_light.h), from left to right, or for a
  // column from top to bottom. NaN where the LF image shows nothing.
  Image<float> light;
  std::vector<double> positions_w;  // of each line, along CameraLine::direction_world
  // The LF image that each line is made of, or the nearest one.
  std::vector<LfImageId> ids;
  CameraLine line;
  EpipolarLines lines = EpipolarLines::kRecorded;  // never kAuto
  double focal_px = 0;
  // LF images that could not be loaded; their lines are NaN.
  std::vector<LfImageId> missing;
  std::string first_reason;  // the reason why the first of these could not be loaded
};

// Makes the picture. Loads only the pixels that it needs, of one LF image per thread at a time.
//   store     a store with Mosaics::kToRgb
//   progress  called by any thread, one at a time; may be empty
// kUsage: the pixel is outside the view, or an option is out of its range. kInput: errors of
// FindCameraLine(); the LF images are brackets (RadianceEncoding::masks_clipped); no LF image can
// be loaded, or with `strict` one. kOutput: the machine lacks something. kInterrupted: `stop` is
// set.
Result<EpipolarPicture> MakeEpipolarPicture(
    const LightField& light_field, const LfImageStore& store, const EpipolarOptions& options,
    ThreadPool& pool, const std::function<void(size_t done, size_t total)>& progress = {});

}  // namespace lf
