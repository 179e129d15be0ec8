// Through which parts of a frame's lens no recorded light comes, element by element: known from
// calibrations alone, before an LF image is read (thesis 4.3.3).
//
// The lens is divided among points spread over it. A point is covered, as an element sees it, once
// the collected LF images have a ray to that element which passes the lens near it: within
// kCoveredDistances of the distance between LF cameras, or as near as lens points are to each
// other. What is not covered is asked of rebinned rays. So an aperture larger than the captured
// band is noticed, and one that falls between LF cameras. Where no LF camera within the reach of
// the point's kernel sees the element, nothing is asked.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lf/camera/ray_weight.h"
#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/hybrid/frame_sampling.h"
#include "lf/rebinning/frame_queries.h"
#include "lf/selection/image_index.h"
#include "lf/selection/select.h"

namespace lf {

// In distances between LF cameras around the lens.
inline constexpr double kCoveredDistances = 1.5;
// Elements that no more than this part of the lens is missing of are left as they are.
inline constexpr double kLittleMissing = 0.1;
// What collection takes of an LF image in the frame: none if it never does.
using CollectedWeights = std::function<RayWeights(LfImageId id)>;

class LensGaps {
 public:
  // collected  empty: nothing is collected, everything is asked for
  // lens_test  whether only rays inside the opening are collected: without lens weights
  // places     that the frame takes
  // camera_distance_w  CameraDistanceAround() in the whole light field, where the index is of a
  // part
  LensGaps(const ImageIndex& index, const RenderCamera& frame, const CollectedWeights& collected,
           bool lens_test, const PlaceRange& places, const SelectOptions& select,
           const QueryOptions& options, ThreadPool& pool,
           std::optional<double> camera_distance_w = {});

  // Whether there are LF cameras around the lens, whose rays could answer.
  bool can_be_asked() const { return sampling_.lf.camera_distance_w > 0; }
  const FrameSampling& sampling() const { return sampling_; }
  const RenderCamera& camera() const { return all_.camera; }
  // LF images that collection takes something of, as far as nodes see.
  size_t collected_count() const { return collected_places_.size(); }
  // The place behind the first `count` of these, or behind all of them.
  uint32_t PlaceAfter(size_t count) const;

  // What is asked for when the LF images at places before this one are collected.
  FrameQueries QueriesAt(uint32_t place) const;
  bool AsksAt(uint32_t place) const;
  bool asks_in_the_end() const { return asks_in_the_end_; }
  // From this place on, at the latest, what is asked for does not change any more.
  uint32_t changes_until() const { return changes_until_; }
  static constexpr uint32_t kInTheEnd = UINT32_MAX - 1;

  // Returns the frame's camera with a lens and a plate that hold all that its queries reach: rays
  // that pass beside the plate have a say in the elements at its edge.
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
  // From which place on a lens point is covered: behind the LF image that does it first;
  // UINT32_MAX: never; 0: no LF camera within its reach sees the element, nobody could answer.
  std::vector<uint32_t> covered_from_;  // [rows][columns][points]
  uint32_t changes_until_ = 0;
  bool asks_in_the_end_ = false;
  std::vector<uint32_t> collected_places_;  // ascending
};

}  // namespace lf
