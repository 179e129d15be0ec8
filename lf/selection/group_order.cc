// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/group_order.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "lf/core/geometry.h"
#include "lf/light_field/model/brackets.h"
#include "lf/selection/capture_surface.h"
#include "lf/selection/reference_groups.h"
#include "lf/selection/spread_order.h"

namespace lf {
namespace {

// The LF images of a group are of one kind, and all recorded or all virtual.
using Kind = std::tuple<int, int, double, uint32_t>;  // width, height, recording time, exposure

Kind KindOf(const LightField& light_field, uint32_t id, uint32_t exposure_number) {
  const Intrinsics& k =
      (light_field.reduction ? light_field.reduction->recorded_intrinsics
                             : light_field.intrinsics)[light_field.cameras[id].intrinsics_index];
  return {k.width_px, k.height_px, light_field.times.empty() ? 0 : light_field.times[id],
          exposure_number};
}

// Returns the LF images `ids` group after group, groups in a spread order.
//   sizes  receives the numbers of LF images of the groups
std::vector<uint32_t> GroupsInOrder(const LightField& light_field, const std::vector<uint32_t>& ids,
                                    uint64_t seed, uint64_t stream, std::vector<size_t>* sizes) {
  std::vector<double> exposures;
  exposures.reserve(ids.size());
  for (const uint32_t id : ids) exposures.push_back(ExposureOf(light_field.cameras[id]));
  const std::vector<uint32_t> numbers = ExposureNumbers(exposures);
  std::vector<Kind> kind_of;  // of each of `ids`
  kind_of.reserve(ids.size());
  for (size_t i = 0; i < ids.size(); ++i)
    kind_of.push_back(KindOf(light_field, ids[i], numbers[i]));
  std::vector<Kind> kinds = kind_of;
  std::sort(kinds.begin(), kinds.end());
  kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
  std::vector<CameraToGroup> cameras;
  cameras.reserve(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    const RigidTransform& pose = light_field.cameras[ids[i]].cam_from_world;
    const auto kind = std::lower_bound(kinds.begin(), kinds.end(), kind_of[i]) - kinds.begin();
    cameras.push_back({pose.Inverse().translation, pose.rotation.row(2).transpose(),
                       static_cast<uint32_t>(kind)});
  }
  const ReferenceGroups groups = GroupCameras(cameras);
  std::vector<Vec3> centres;
  centres.reserve(groups.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    Vec3 sum = Vec3::Zero();
    for (const GroupMember& member : groups.Group(g)) sum += cameras[member.id.value].position;
    centres.push_back(sum / static_cast<double>(groups.Group(g).size()));
  }
  std::vector<uint32_t> order;
  order.reserve(ids.size());
  for (const uint32_t g : OrderOfPoints(SurfaceOf(centres), seed, stream)) {
    for (const GroupMember& member : groups.Group(g)) order.push_back(ids[member.id.value]);
    sizes->push_back(groups.Group(g).size());
  }
  return order;
}

// A list of LF images that is taken group after group.
struct GroupList {
  std::vector<uint32_t> ids;
  std::vector<size_t> sizes;
  size_t next = 0, taken = 0;  // index of the next group; number of LF images before it

  bool IsAtEnd() const { return next == sizes.size(); }
  void MoveTo(std::vector<uint32_t>* order) {
    const std::span<const uint32_t> group = std::span(ids).subspan(taken, sizes[next]);
    order->insert(order->end(), group.begin(), group.end());
    taken += sizes[next++];
  }
};

}  // namespace

std::vector<uint32_t> OrderByGroups(const LightField& light_field, uint64_t seed) {
  std::vector<uint32_t> recorded, of_virtual;
  for (uint32_t i = 0; i < light_field.size(); ++i)
    (light_field.cameras[i].is_virtual ? of_virtual : recorded).push_back(i);
  GroupList a, b;
  a.ids = GroupsInOrder(light_field, recorded, seed, 0, &a.sizes);
  b.ids = GroupsInOrder(light_field, of_virtual, seed, 1, &b.sizes);
  std::vector<uint32_t> order;
  order.reserve(light_field.size());
  // Every beginning has about the same share of both.
  while (!a.IsAtEnd() || !b.IsAtEnd()) {
    const bool is_a =
        b.IsAtEnd() || (!a.IsAtEnd() && a.taken * b.ids.size() <= b.taken * a.ids.size());
    (is_a ? a : b).MoveTo(&order);
  }
  return order;
}

}  // namespace lf
