// SPDX-License-Identifier: Apache-2.0
// Finds the LF cameras around an LF camera. A k-d tree of their positions finds the neighbours of
// all n LF cameras in n log n steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/focus/place_depth.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

class NearbyCameras {
 public:
  // Keeps a reference to the light field, which must outlive this object.
  explicit NearbyCameras(const LightField& light_field);

  // Returns up to `count` LF cameras, the nearest to a point first. They look in about the same
  // direction as `camera` (within 37 degrees); `camera` itself is not among them.
  std::vector<uint32_t> Nearest(const Vec3& point_world, size_t count, LfImageId camera) const;

  // Returns rings of up to six views around `camera` for DepthOf() (focus/place_depth.h); each ring
  // is twice as wide as the one before. Depths from the rings of ChooseRings(), of which each is
  // four times as wide, would not be precise enough: a wrong disparity makes the estimated falloff
  // too weak. Images are not loaded.
  Rings DepthRings(LfImageId camera) const;

  // Returns the views whose light is compared with the light of `camera`: the views of the rings
  // (of DepthRings()) and of the six LF cameras nearest to `camera`, each once. Images are not
  // loaded.
  std::vector<View> ComparedViews(LfImageId camera, const Rings& rings) const;

 private:
  std::vector<View> Ring(LfImageId camera, double radius_w, double turn, double least_share) const;
  View ViewOf(const PinholeCamera& camera, uint32_t other) const;
  void Split(size_t begin, size_t end);
  template <typename Visit>
  void Search(size_t begin, size_t end, const Vec3& point_world, const double& limit,
              const Visit& visit) const;

  const LightField& field_;
  std::vector<Vec3> centres_;    // position of each LF camera in the world
  std::vector<Vec3> forwards_;   // viewing direction of each LF camera in the world, of length 1
  std::vector<uint32_t> order_;  // balanced tree of LF cameras: each range's middle is its root
  std::vector<uint8_t> axes_;    // axis of each root's split, at the root's index in order_
  Vec3 least_ = Vec3::Zero(), most_ = Vec3::Zero();  // corners of the box of all centres
  double spacing_w_ = 0;
};

}  // namespace lf
