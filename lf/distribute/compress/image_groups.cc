// SPDX-License-Identifier: Apache-2.0
#include "lf/distribute/compress/image_groups.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "lf/light_field/model/brackets.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
ReferenceGroups GroupsOf(const CompressSource& source) {
  const std::vector<LfImageId> ids = source.CompressedIds();
  std::vector<double> exposures;
  exposures.reserve(ids.size());
  for (const LfImageId id : ids)
    exposures.push_back(ExposureOf(source.light_field.cameras[id.value]));
  const std::vector<uint32_t> numbers = ExposureNumbers(exposures);
  std::map<std::tuple<int, int, uint32_t>, uint32_t> kinds;  // by size and exposure
  std::vector<CameraToGroup> cameras;
  cameras.reserve(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    const Intrinsics& size = source.light_field.Camera(ids[i]).intrinsics;
    const RigidTransform& pose = source.light_field.cameras[ids[i].value].cam_from_world;
    const auto next = static_cast<uint32_t>(kinds.size());
    const uint32_t kind =
        kinds.try_emplace({size.width_px, size.height_px, numbers[i]}, next).first->second;
    cameras.push_back({-(pose.rotation.transpose() * pose.translation),
                       pose.rotation.transpose() * Vec3::UnitZ(), kind});
  }
  ReferenceGroups groups = GroupCameras(cameras);
  for (GroupMember& member : groups.members) member.id = ids[member.id.value];
  return groups;
}

std::vector<size_t> SampleOf(const ReferenceGroups& groups, size_t image_count) {
  const size_t usual = (groups.members.size() + groups.size() - 1) / groups.size();
  const size_t count = std::min(groups.size(), (image_count + usual - 1) / usual);
  std::vector<size_t> sample;
  for (size_t i = 0; i < count; ++i) sample.push_back((2 * i + 1) * groups.size() / (2 * count));
  return sample;
}

PinholeView ViewToPredict(const CompressSource& source, LfImageId id) {
  const LightField& light_field = source.light_field;
  const PixelRect rect = RectToRecord(light_field, id, source.rects[id.value]);
  const PinholeCamera camera = light_field.Camera(id);
  PinholeView view = {camera.intrinsics.Matrix(), camera.cam_from_world};
  view.intrinsics(0, 2) -= rect.x_begin;
  view.intrinsics(1, 2) -= rect.y_begin;
  return light_field.encoding.bayer == BayerPattern::kNone ? view : Halved(view);
}

}  // namespace lf
