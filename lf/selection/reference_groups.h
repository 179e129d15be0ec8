// SPDX-License-Identifier: Apache-2.0
// Groups of neighbouring LF cameras for predictive coding (thesis 6.2): the first image of a group,
// its key image, is encoded by itself. Each other one is predicted from reference images, which are
// up to three anchors of its group that are decoded before it. No image depends on another group.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lf/core/geometry.h"
#include "lf/core/ids.h"

namespace lf {

// An LF camera, as far as groups depend on it. Numbers that are not finite count as 0.
struct CameraToGroup {
  Vec3 position;
  Vec3 direction;  // unit vector along the optical axis
  // Only LF cameras of one kind share a group: one image size and exposure.
  uint32_t kind = 0;
};

// Returns the number of each exposure (light_field/model/brackets.h), 0 for the least one. Those of
// brackets have different numbers, because a dark image does not predict a bright one: successive
// numbers are more than half a stop apart, with no exposure between. Slightly different gains of
// cameras have one number.
std::vector<uint32_t> ExposureNumbers(std::span<const double> exposures);

// An LF image of a group.
struct GroupMember {
  static constexpr size_t kMostReferences = 3;
  LfImageId id;  // index of its CameraToGroup
  uint8_t reference_count = 0;
  // Ranks in the group of its reference images, the nearest first. All are less than its own rank.
  std::array<uint8_t, kMostReferences> references = {};

  std::span<const uint8_t> References() const {
    return std::span(references).first(reference_count);
  }
};

// Returns the number of anchors of a group: 6 of 16.
constexpr size_t AnchorCount(size_t group_size) { return (3 * group_size + 7) / 8; }

struct ReferenceGroups {
  static constexpr size_t kLeast = 8, kMost = 23;  // sizes of groups where LF cameras are dense

  std::vector<GroupMember> members;  // group after group, each in the order of decoding
  std::vector<size_t> begins = {0};  // [size() + 1]: index of each group's first member

  size_t size() const { return begins.size() - 1; }
  std::span<const GroupMember> Group(size_t group) const {
    return std::span(members).subspan(begins[group], begins[group + 1] - begins[group]);
  }
};

// Returns groups of about 16 neighbouring LF cameras, which look in directions less than 10 degrees
// apart. A group has from kLeast to kMost members, and fewer only if the directions of LF cameras
// that are neighbours differ by degrees. Successive groups are mostly neighbours.
//
// The first images of a group, AnchorCount() of them, are its anchors: the others are predicted
// from these alone, and no image from the others.
//
// LF cameras of each kind are cut in two, again and again: across the longest extent of their
// directions until these are near enough to each other, then across that of their positions. Cuts
// are between rows or columns of a grid. The order within a group begins with the LF camera in the
// middle, followed by the one farthest from all before it, and so on. The references of an LF image
// are the nearest anchor before it in each of the directions right, up, left and down in the
// group's plane of least variance; of these the nearest three, without those clearly more than
// three times as far away as the nearest.
//
// The result depends on positions, directions and kinds, and on the order of `cameras` only if two
// of them are equal. It is the same on all machines. A million LF cameras take 2 to 3 seconds. To
// see one image of a grid of 64 x 64, 4.6 images are decoded on average; to see a window of 9 x 9,
// 1.24 for each image of the window.
ReferenceGroups GroupCameras(std::span<const CameraToGroup> cameras);

}  // namespace lf
