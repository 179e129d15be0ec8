// The lens of one frame as collection takes it: which rays it lets through, and what they count.
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/capture/light_field.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/lens_weights/frame_weights.h"
#include "lf/lens_weights/lens_coverage.h"
#include "lf/selection/select.h"

namespace lf {

// kUsage where the lens of the frame is a pinhole: kArea cannot weigh it.
Result<void> CheckHasArea(const RenderCamera& camera, FrameId frame);

// With lens weights LF cameras beside the lens take part, and weights replace its test
// (doc/ray.md, "What is added").
class FrameLens {
 public:
  // LF images with rays within so many distances of neighbouring LF cameras of the lens are asked
  // for their share.
  static constexpr double kReach_distances = 8;

  // kArea wants a lens of some size.
  // Refers to the light field.
  //   camera_distance_w  CameraDistanceAround() in the whole light field, where the index is of a
  //                      part: one that has all of near() gives the same weights
  FrameLens(const ImageIndex& index, const RenderCamera& frame, LensWeights kind,
            const SelectOptions& select, ThreadPool& pool,
            std::optional<double> camera_distance_w = {});

  // The frame's; with weights its lens is the disk that holds all rays that have one.
  const RenderCamera& camera() const { return camera_; }

  // Refer to this object. 0 beyond the angle that selection allows.
  RayWeights WeightsOf(LfImageId id) const;

  // Returns false if WeightsOf() is 0 all over the plate.
  bool Takes(LfImageId id) const;

  // LF images that were asked for their share, ascending, and how far apart their cameras are
  // around the lens; with weights.
  std::vector<LfImageId> near() const;
  double camera_distance_w() const { return camera_distance_w_; }

  // What the weights are like; none without weights.
  struct Facts {
    double hat_share = 0;  // FrameWeights::hat_share()
    LensCoverage coverage;
  };
  std::optional<Facts> facts() const;

  // Of the elements in the middle of squares of EffectiveStep() elements: how many LF images, each
  // as good as any other, would make as little noise, (sum w)^2 / sum w^2 over those that hold what
  // the element sees; 0 where none does. Broken images and masks are not known here.
  // [rows][columns]  Empty without weights.
  Image<float> EffectiveCounts() const;

 private:
  const LightField& light_field_;
  SelectOptions select_;
  RenderCamera camera_;
  double camera_distance_w_ = 0;
  std::optional<FrameWeights> weights_;
  std::map<uint32_t, size_t> cameras_;  // of weights_, by LF image
};

int EffectiveStep(const Intrinsics& plate);
// Columns and rows of squares.
std::pair<int, int> EffectiveSquares(const Intrinsics& plate);
// The same of every element, interpolated between those that are not 0.  [height][width]
Image<float> SpreadOverPlate(const Image<float>& effective_counts, const Intrinsics& plate);

}  // namespace lf
