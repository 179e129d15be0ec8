// SPDX-License-Identifier: Apache-2.0
#include "lf/view/frame_use.h"

#include <algorithm>

#include "lf/selection/ideal_cells.h"
#include "lf/selection/overlap.h"
#include "lf/selection/seen_region.h"

namespace lf {
namespace {

constexpr size_t kCamerasPerTask = 1024;

// Repeats the tests of selection to find out why an LF camera is not used.
class Reasons {
 public:
  Reasons(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options)
      : light_field_(index.light_field()),
        region_(frame),
        outline_(frame, options.select.reach),
        options_(options) {}

  CameraUse Of(LfImageId id) const {
    const PinholeCamera camera = light_field_.Camera(id);
    if (region_.Misses(camera.CentreWorld())) return CameraUse::kOutside;
    if (!IsWithinAngle(light_field_.cameras[id.value], outline_.camera, options_.select))
      return CameraUse::kAngle;
    const std::vector<IdealCell> cells = camera.intrinsics.has_distortion()
                                             ? MakeIdealCells(camera.intrinsics)
                                             : std::vector<IdealCell>();
    if (ImageOverlap(camera, cells, options_.select.reach).Rect(outline_).empty())
      return CameraUse::kSeesNone;
    return options_.lens_weights == LensWeights::kNone ? CameraUse::kLimit : CameraUse::kNoWeight;
  }

 private:
  const LightField& light_field_;
  const SeenRegion region_;
  const FrameOutline outline_;
  const NeedsOptions& options_;
};

}  // namespace

std::string_view NameOf(CameraUse use) {
  constexpr std::string_view kNames[kCameraUseCount] = {"used",      "outside", "angle",
                                                        "sees-none", "limit",   "no-weight"};
  return kNames[static_cast<size_t>(use)];
}

FrameUse UseOfCameras(const ImageIndex& index, const RenderCamera& frame,
                      const NeedsOptions& options, ThreadPool& pool) {
  FrameNeeds needs = NeedsOf(index, frame, options, pool);
  FrameUse use;
  use.camera_distance_w = needs.camera_distance_w();
  use.used = std::move(needs.images);
  // If the frame has reached the limit --max-images, the limit excludes the LF images that
  // follow the last used one in the order.
  std::vector<bool> is_late(index.light_field().size(), false);
  if (options.max_image_count && !use.used.empty() && use.used.size() >= *options.max_image_count) {
    const uint32_t last = index.RankOf(use.used.back().id);
    for (uint32_t i = 0; i < is_late.size(); ++i) is_late[i] = index.RankOf(LfImageId{i}) > last;
  }
  const Reasons reasons(index, frame, options);
  use.of_cameras.assign(is_late.size(), CameraUse::kOutside);
  for (const FrameNeeds::Image& image : use.used) use.of_cameras[image.id.value] = CameraUse::kUsed;
  const size_t task_count = (is_late.size() + kCamerasPerTask - 1) / kCamerasPerTask;
  pool.ForEach(task_count, [&](size_t task) {
    const size_t end = std::min(is_late.size(), (task + 1) * kCamerasPerTask);
    for (size_t i = task * kCamerasPerTask; i < end; ++i) {
      CameraUse& one = use.of_cameras[i];
      if (one == CameraUse::kUsed) continue;
      one = reasons.Of(LfImageId{static_cast<uint32_t>(i)});
      if (is_late[i] && one == CameraUse::kNoWeight) one = CameraUse::kLimit;
    }
  });
  return use;
}

}  // namespace lf
