// SPDX-License-Identifier: Apache-2.0
// Finds the depth of every element of a frame by a plane sweep over the LF images behind its lens,
// and makes a picture in which everything is in focus.
//
// Depths that a densified store has can take the place of the sweep.
//
// Surfaces without texture, beyond the range of distances, or seen by too few LF cameras have no
// depth: nothing is invented. An element has no depth either if most elements of its colour around
// it have none or another one, because a border beside it may belong to another surface.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/render/collect/collect.h"
#include "lf/render/state/plate_notes.h"
#include "lf/selection/image_index.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

struct DepthMapOptions {
  // True: depths are those that a densified store has of recorded LF images. range, plane_count,
  // window_radius, clean and most_views are then not used.
  bool from_store = false;
  DepthRange range;        // distances along the optical axis; 0 < near_w < far_w
  size_t plane_count = 0;  // distances that are tested; 0: as many as PlanesFor() returns
  int window_radius = 2;   // elements; costs are means over windows of 2 r + 1 elements
  // An element whose confidence is below this has no depth.
  double least_confidence = 0.5;
  // True: wrong and missing depths become the median of the depths of the elements of their colour
  // around them, if most of these have about the same depth.
  bool clean = false;
  size_t most_views = 200;  // largest number of LF images, spread evenly over the lens; 3 to 4096
  size_t memory_bytes = size_t{8} << 30;    // bounds the LF images in memory
  bool strict = false;                      // true: a broken LF image is an error
  const std::atomic<bool>* stop = nullptr;  // once true, the function ends; may be null
};
inline constexpr size_t kMostDepthPlanes = 1024;

struct DepthMap {
  // [height][width] distance along the optical axis in world units; NaN: unknown.
  Image<float> depth_w;
  // [height][width] from 0 (no distance is better than others) to 1, also of unknown elements.
  Image<float> confidence;
  // [height][width] depth_w with the unknown elements filled from those around them.
  Image<float> filled_w;
  // Light of the elements at filled_w, of a pinhole, and what DevelopFrame() needs to develop it.
  SensorPlate sharp{0, 0};
  PlateNotes notes;
  DepthRange range;  // of the distances that were tested, or of the depths that the store has
  std::vector<double> planes_w;  // distances of the sweep; empty if there was none
  size_t view_count = 0;         // LF images that were compared, or whose depths were used
  // Number of elements with a depth.
  size_t known_count = 0;
  std::vector<SkippedImage> skipped;  // broken LF images
};

// Returns the distances to test: the given ones or, if one is unset, that of FindFocusRange(). A
// range that is not stated by the light field is widened, because a fifth of the scene may lie
// beyond it. kUsage: the nearest distance is not below the farthest. Other errors are those of
// FindFocusRange().
Result<DepthRange> RangeToSweep(const LightField& light_field, const RenderCamera& camera,
                                std::optional<double> near_w, std::optional<double> far_w,
                                ThreadPool& pool);

// Returns the number of planes between which a point moves by at most half an element in the LF
// images at the rim of a lens of this radius, from 8 to 256.
size_t PlanesFor(const RenderCamera& frame, const DepthRange& range, double lens_radius_w);

// Makes the depth map of a frame. Its lens says which LF cameras are compared; a lens with fewer
// than 12 is widened until it has as many. Virtual LF images are left out. The result has the same
// bits for any number of threads and any memory_bytes.
//   index     of the whole light field
//   store     must load RGB (Mosaics::kToRgb), and depths if options.from_store is set
//   progress  called with the share that is done, from 0 to 1, by any thread; may be empty
// kUsage: options out of range; from_store is set, and no LF camera near the lens has depths.
// kInput: fewer than 3 LF cameras see the scene, or a broken LF image
// with `strict`. kOutput: memory_bytes is too small for the views of 16 rows, or the machine lacks
// something. kInterrupted: *stop became true.
Result<DepthMap> MakeDepthMap(const ImageIndex& index, const LfImageStore& store, FrameId id,
                              const RenderCamera& frame, const DepthMapOptions& options,
                              ThreadPool& pool, const std::function<void(double)>& progress);

}  // namespace lf
