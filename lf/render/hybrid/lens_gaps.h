// The parts of a frame's lens that no collected ray passes, element by element. They are computed
// from calibrations alone, before an LF image is read (thesis 4.3.3).
//
// The lens is represented by points spread over it. A point is covered for an element once the
// collected LF images have a ray to that element which passes the lens near the point: within
// kCoveredDistances times the distance between LF cameras, or within the distance between lens
// points, whichever is more. Points that are not covered are gaps, and ask for rebinned rays. This
// detects an aperture that is larger than the captured band, and one that lies between LF cameras.
// A point asks for nothing if no LF camera within the reach of its kernel sees the element.
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

// Distance within which a ray covers a lens point, in distances between LF cameras around the lens.
inline constexpr double kCoveredDistances = 1.5;
// A node asks for nothing if at most this part of its lens points is missing.
inline constexpr double kLittleMissing = 0.1;
// Returns the weights with which the frame collects the rays of an LF image; none if it collects
// none.
using CollectedWeights = std::function<RayWeights(LfImageId id)>;

class LensGaps {
 public:
  //   collected          empty: nothing is collected, and all lens points are asked for
  //   lens_test          true if only rays inside the opening are collected (no lens weights)
  //   places             of the LF images that the frame takes
  //   camera_distance_w  CameraDistanceAround() in the whole light field, needed if the index is of
  //                      a part of it; none: computed from the index
  LensGaps(const ImageIndex& index, const RenderCamera& frame, const CollectedWeights& collected,
           bool lens_test, const PlaceRange& places, const SelectOptions& select,
           const QueryOptions& options, ThreadPool& pool,
           std::optional<double> camera_distance_w = {});

  // True if there are LF cameras around the lens, so that rebinned rays could answer.
  bool can_be_asked() const { return sampling_.lf.camera_distance_w > 0; }
  const FrameSampling& sampling() const { return sampling_; }
  const RenderCamera& camera() const { return all_.camera; }
  // Number of LF images with a collected ray at a node.
  size_t collected_count() const { return collected_places_.size(); }
  // Returns the place behind the first `count` of these LF images, or behind all if there are
  // fewer.
  uint32_t PlaceAfter(size_t count) const;

  // Returns the queries when the LF images at places before `place` are collected.
  FrameQueries QueriesAt(uint32_t place) const;
  bool AsksAt(uint32_t place) const;
  bool asks_in_the_end() const { return asks_in_the_end_; }
  // Place from which on queries do not change any more.
  uint32_t changes_until() const { return changes_until_; }
  static constexpr uint32_t kInTheEnd = UINT32_MAX - 1;

  // Returns the frame's camera with a lens and a plate that contain the reach of all its queries:
  // rays that pass beside the plate contribute to the elements at its edge.
  RenderCamera ReachedCamera() const;

 private:
  void SetNodes(const std::vector<LfImageId>& near, const ImageIndex& index);
  size_t node_count() const { return static_cast<size_t>(columns_.count()) * rows_.count(); }
  bool NodeAsksAt(size_t node, uint32_t place) const;
  void FindGaps(const std::vector<LfImageId>& near, const ImageIndex& index,
                const CollectedWeights& collected, bool lens_test, ThreadPool& pool);

  FrameSampling sampling_;
  FrameQueries all_;
  bool is_collected_ = false;
  NodeAxis columns_{1};  // nodes over the plate
  NodeAxis rows_{1};
  // Place from which on a lens point is covered: behind the first LF image that covers it;
  // UINT32_MAX: never; 0: no LF camera within its reach sees the element, so no rebinned ray could
  // answer.
  std::vector<uint32_t> covered_from_;  // [rows][columns][points]
  uint32_t changes_until_ = 0;
  bool asks_in_the_end_ = false;
  std::vector<uint32_t> collected_places_;  // ascending
};

}  // namespace lf
