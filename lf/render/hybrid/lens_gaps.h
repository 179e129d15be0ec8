// SPDX-License-Identifier: Apache-2.0
// Finds, for each element, the parts of a frame's lens that no collected ray passes through. Needs
// only the calibration of the LF cameras, so that gaps are known before an LF image is read (thesis
// 4.3.3).
//
// The lens is represented by points spread over it (lens points). A lens point is covered for an
// element once the collected LF images have a ray that lands in this element and passes through the
// lens near the point. "Near" means within kCoveredDistances times the distance between LF cameras,
// or within the distance between lens points, whichever is larger. A lens point that is not covered
// is a gap: rebinned rays are used for it. Gaps therefore occur where an aperture is larger than
// the captured band, and where a small aperture lies between LF cameras. A lens point is no gap if
// no LF camera within the reach of the lens point's kernel (rebinning/ray_query.h) sees the
// element, because no rebinned ray could then fill the gap.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/render/hybrid/frame_sampling.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {

// Distance up to which a ray covers a lens point, in distances between LF cameras around the lens.
inline constexpr double kCoveredDistances = 1.5;
// Gaps are tested at nodes: positions on a grid over the plate. A node needs no rebinned rays if at
// most this share of its lens points are gaps.
inline constexpr double kLittleMissing = 0.1;
// A function that returns the weights with which the frame collects the rays of an LF image. Their
// are_none() is true if the frame collects none of these rays.
using CollectedWeights = std::function<RayWeights(LfImageId id)>;

class LensGaps {
 public:
  //   collected          empty: the frame collects no rays, and all lens points are gaps
  //   lens_test          true if only rays through the opening of the lens are collected
  //                      (FrameLens::tests_opening())
  //   ranks              range of the ranks of the LF images that the frame takes
  //   camera_distance_w  CameraDistanceAround() in the whole light field. Must be set if the index
  //                      covers only a part of the light field; unset: measured in `index`
  LensGaps(const ImageIndex& index, const RenderCamera& frame, const CollectedWeights& collected,
           bool lens_test, const RankRange& ranks, const SelectOptions& select,
           const QueryOptions& options, ThreadPool& pool,
           std::optional<double> camera_distance_w = {});

  // True if there are LF cameras around the lens, so that there can be rebinned rays.
  bool can_be_asked() const { return sampling_.lf.camera_distance_w > 0; }
  const FrameSampling& sampling() const { return sampling_; }
  const RenderCamera& camera() const { return all_.camera; }
  // Number of LF images that have a collected ray at one or more nodes; 0 if `collected` is empty.
  size_t collected_count() const { return collected_ranks_.size(); }
  // Takes the first `count` LF images, by ascending ranks, of those that collected_count() counts
  // (all if they are fewer). Returns the rank after the last of these; 0 if there are none.
  uint32_t RankAfter(size_t count) const;

  // QueriesAt() returns the queries that the frame needs when exactly the LF images at ranks
  // before `rank` are collected. AsksAt() returns true if any node then needs rebinned rays;
  // asks_in_the_end() returns AsksAt(kInTheEnd).
  FrameQueries QueriesAt(uint32_t rank) const;
  bool AsksAt(uint32_t rank) const;
  bool asks_in_the_end() const { return asks_in_the_end_; }
  // Rank from which on QueriesAt() returns the same queries for all higher ranks.
  uint32_t changes_until() const { return changes_until_; }
  // A rank behind those of all LF images: the end of the render.
  static constexpr uint32_t kInTheEnd = UINT32_MAX - 1;

  // Returns the frame's camera with its lens and plate enlarged by the reach of the kernels,
  // because rays that land beside the plate contribute to the elements at its edge.
  RenderCamera ReachedCamera() const;

 private:
  void SetNodes(const std::vector<LfImageId>& near, const ImageIndex& index);
  size_t node_count() const { return static_cast<size_t>(columns_.count()) * rows_.count(); }
  bool NodeAsksAt(size_t node, uint32_t rank) const;
  void FindGaps(const std::vector<LfImageId>& near, const ImageIndex& index,
                const CollectedWeights& collected, bool lens_test, ThreadPool& pool);

  FrameSampling sampling_;
  FrameQueries all_;
  bool is_collected_ = false;
  NodeAxis columns_{1};  // grid of nodes over the plate
  NodeAxis rows_{1};
  // Rank from which on a lens point is covered at a node: one after the rank of the first LF
  // image that covers it. UINT32_MAX: never covered. 0: no LF camera within the reach of the lens
  // point sees the focus point of the node, so that the lens point is no gap.
  std::vector<uint32_t> covered_from_;  // [rows][columns][points]
  uint32_t changes_until_ = 0;
  bool asks_in_the_end_ = false;
  // ranks of the LF images that collected_count() counts, ascending
  std::vector<uint32_t> collected_ranks_;
};

}  // namespace lf
