// SPDX-License-Identifier: Apache-2.0
// The lens of one frame as collection uses it: which rays pass through it, and with which weights.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/lens_weights/lens_coverage.h"
#include "lf/selection/select.h"

namespace lf {

// Returns kUsage if the lens of the frame is a pinhole, because LensWeights::kArea then has no area
// to divide.
Result<void> CheckHasArea(const RenderCamera& camera, FrameId frame);

// If there are lens weights, they replace the test whether a ray passes through the lens: LF
// cameras beside the lens may then also have a weight, as described in doc/ray.md, "What is added".
// Only if very many LF cameras are seen through the lens (FrameWeights::keeps_opening()) are there
// both weights and the test.
class FrameLens {
 public:
  // LF images with rays up to this distance beside the lens may get a share of the lens. The unit
  // is the distance between neighbouring LF cameras.
  static constexpr double kReach_distances = 8;

  // If `kind` is kArea, CheckHasArea() must accept the lens. The object refers to the light field
  // of `index`. LF images that the index leaves out have the weight 0.
  //   camera_distance_w  CameraDistanceAround() in the whole light field. Must be set if the index
  //                      covers only a part of the light field: a part that contains all LF images
  //                      of near() then gives the same weights as the whole light field. Unset:
  //                      measured in `index`
  FrameLens(const ImageIndex& index, const RenderCamera& frame, LensWeights kind,
            const SelectOptions& select, ThreadPool& pool,
            std::optional<double> camera_distance_w = {});

  // The frame's camera. Unless tests_opening(), its aperture is replaced by the disk that all rays
  // with a weight pass through.
  const RenderCamera& camera() const { return camera_; }

  // True if rays are added only if they pass through the opening of the frame's lens: without lens
  // weights, or with very many LF cameras.
  bool tests_opening() const { return !weights_ || weights_->keeps_opening(); }

  // Returns the weights of the LF image's rays. The result refers to this object. The weights are 0
  // if the LF image has no share of the lens, or if the angle between the axes of LF camera and
  // frame exceeds SelectOptions::max_angle_rad. Without lens weights, they are otherwise 1.
  RayWeights WeightsOf(LfImageId id) const;

  // Returns true unless WeightsOf() is 0 in all elements.
  bool Takes(LfImageId id) const;

  // weights() returns the weights of the LF cameras of near(), in this order; null if there are no
  // lens weights. IndexOf() returns the index of an LF camera in them; nullopt if it has none.
  const FrameWeights* weights() const { return weights_ ? &*weights_ : nullptr; }
  std::optional<size_t> IndexOf(LfImageId id) const;

  // near() returns the LF images that may get a share of the lens, by ascending ids.
  // camera_distance_w() returns the distance between neighbouring LF cameras around the lens, in
  // world units. Without lens weights, near() is empty and the distance is 0.
  const std::vector<LfImageId>& near() const { return near_; }
  double camera_distance_w() const { return camera_distance_w_; }

  // Properties of the lens weights; facts() returns nullopt if there are none.
  struct Facts {
    double hat_share = 0;  // share of the hat weights: FrameWeights::hat_share()
    LensCoverage coverage;
  };
  std::optional<Facts> facts() const;

  const LightField& light_field() const { return light_field_; }

  // Returns the effective numbers of LF images of a frame that has only this lens.
  Image<float> EffectiveCounts() const;

  // FrameWeights::Reduce(); does nothing without lens weights.
  void ReduceWeights(double factor);

 private:
  const LightField& light_field_;
  const bool is_of_recorded_;  // true: virtual LF images have the weight 0
  SelectOptions select_;
  RenderCamera camera_;
  double camera_distance_w_ = 0;
  std::optional<FrameWeights> weights_;
  std::vector<LfImageId> near_;  // sorted; the LF cameras of weights_
};

// Returns the lenses of all instants of a frame (CameraPath::Instants()). The light of each instant
// counts equally in the frame: if there are lens weights, those of the instants with the larger
// sums (FrameWeights::SumOfWeights()) are reduced to the smallest sum, and all sums together to
// FrameWeights::kMostTogether. The largest weight of an instant is not reduced below
// kLeastLargestWeight, because coarser weights would leave out LF images. Without lens weights,
// each ray counts the same. The lens of a frame without a shutter is not changed.
//   camera_distances_w  FrameLens's camera_distance_w of each instant; empty: measured in `index`
std::vector<FrameLens> LensesOf(const ImageIndex& index, std::span<const RenderCamera> instants,
                                LensWeights kind, const SelectOptions& select, ThreadPool& pool,
                                std::span<const double> camera_distances_w = {});
inline constexpr double kLeastLargestWeight = 16;

// Returns the properties of the lens weights of all instants of a frame: the mean share of the
// hats, the largest uncovered share and the smallest fitting diameter; nullopt if there are none.
std::optional<FrameLens::Facts> FactsOf(std::span<const FrameLens> lenses);

// Returns effective numbers of LF images, (sum w)^2 / sum w^2: the number of LF images of equal
// weight that would give the same noise. Here w is the weight of an LF image in an element, summed
// over the lenses of all instants that see it. The sums are over the recorded LF images that
// contain the element's focus point, without virtual ones, which bring no new measurement; the
// result is 0 if no recorded LF image does. Computed for the middle element of each square of
// EffectiveStep() x EffectiveStep() elements. Does not take broken LF images and masks into
// account. Shape: [rows][columns] of EffectiveSquares(). Empty if there are no lens weights.
//   lenses  at least one
Image<float> EffectiveCountsOf(std::span<const FrameLens> lenses);

// Returns the side of the squares of EffectiveCountsOf(), in elements.
int EffectiveStep(const Intrinsics& plate);
// Returns the numbers of columns and rows of these squares on a plate.
std::pair<int, int> EffectiveSquares(const Intrinsics& plate);
// Interpolates the result of EffectiveCountsOf() between the middles of the squares, ignoring
// numbers that are 0. Returns one number for each element, [height][width]; 0 if all squares around
// it have 0.
Image<float> SpreadOverPlate(const Image<float>& effective_counts, const Intrinsics& plate);

}  // namespace lf
