// SPDX-License-Identifier: Apache-2.0
// A frame into whose plate rays are collected.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/collect/frame_rays.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/selection/select.h"

namespace lf {

// Returns the weights of the rays of an LF image in a frame; 0 if the frame does not take the LF
// image. Any thread may call it. An empty function means that every ray has weight 1.
using ImageWeights = std::function<RayWeights(LfImageId id)>;

// Progress of a frame. Its plate has the rays of exactly those LF images that the frame takes and
// whose ranks are below ranks_done. Broken LF images count as done.
struct FrameProgress {
  uint32_t ranks_done = 0;
  FrameRays rays;  // counts of the rays that this FrameCollector tested and added
};

// The rays of all LF images, and their trust, which a frame with a guarded plate collects besides
// the rays of recorded LF images (PlateKind::kGuarded; doc/densify.md, "The guard").
struct FrameGuard {
  RenderCamera camera;   // with the lens of all LF cameras
  ImageWeights weights;  // of all LF images in this lens
  // Distance between neighbouring recorded LF cameras around the lens, which decides how far out of
  // focus a ray is.
  double camera_distance_w = 0;
};

// A lens of a frame with a shutter, at another instant than CollectedFrame::camera.
struct CollectedInstant {
  RenderCamera camera;
  ImageWeights weights = {};
};

struct CollectedFrame {
  RenderCamera camera;
  SensorPlate* plate = nullptr;  // receives the rays; must not be null
  // The frame takes LF images at these ranks of the order. The plate must already have the rays of
  // the LF images that the frame takes at ranks before ranks.begin.
  RankRange ranks = {};
  ImageWeights weights = {};
  // Must be set in all frames or in none. If it is set, `camera` and `weights` are those of
  // recorded LF images alone, `weights` gives virtual LF images the weight 0, and progress.rays
  // counts the rays of recorded LF images, and the virtual LF images with a ray of the guard.
  std::optional<FrameGuard> guard = {};
  // Moments of the plate, made for its width and height. They are updated with the plate, and
  // always include exactly the LF images whose rays the plate has. Null: no moments are kept.
  NoiseMoments* moments = nullptr;
  // The further instants of a frame with a shutter. Their rays are added to the same channels of
  // the plate as those of `camera`, and the counts and moments of an LF image are those of its rays
  // at all instants together. All frames must have the same number; none if there is a guard.
  std::vector<CollectedInstant> further = {};
  // Strength of the correction that mosaics get for this frame (CorrectionFor()); used by kMosaic.
  int correction = 0;
  // FrameCollector sets the members below.
  FrameProgress progress = {};
  bool is_stopped = false;  // true: the frame takes no more LF images
};

// Returns the kind of the plates of a light field.
inline PlateKind PlateKindOf(const RadianceEncoding& encoding, bool is_guarded) {
  if (is_guarded) return encoding.HasOpacity() ? PlateKind::kGuardedOpacity : PlateKind::kGuarded;
  return encoding.HasOpacity() ? PlateKind::kOpacity : PlateKind::kColours;
}

// Returns frames that take all LF images, with weight 1.
//   plates  one plate for each camera, with the size of the camera's image
inline std::vector<CollectedFrame> FramesOf(std::span<const RenderCamera> cameras,
                                            std::vector<SensorPlate>& plates) {
  std::vector<CollectedFrame> frames;
  for (size_t f = 0; f < cameras.size(); ++f) frames.push_back({cameras[f], &plates[f]});
  return frames;
}

}  // namespace lf
