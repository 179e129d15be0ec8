#include "lf/package/package.h"

#include <algorithm>
#include <utility>

#include "lf/core/check.h"

namespace lf {

std::vector<FrameId> Package::FrameIds() const {
  std::vector<FrameId> ids;
  for (const PackageFrame& frame : frames) ids.push_back(frame.id);
  return ids;
}

std::optional<double> Package::CameraDistance(FrameId frame) const {
  const auto found = std::lower_bound(frames.begin(), frames.end(), frame,
                                      [](const PackageFrame& a, FrameId b) { return a.id < b; });
  LF_CHECK(found != frames.end() && found->id == frame);
  return found->camera_distance_w;
}

Package PackageOfAll(LightField light_field, CameraPath path, uint64_t seed) {
  Package package;
  package.whole = IdentityOf(light_field);
  package.places = ShuffledPlaces(light_field.size(), seed);
  package.choices.seed = seed;
  for (uint32_t n = 1; n <= path.frame_count(); ++n)
    package.frames.push_back({.id = FrameId{n}, .camera_distance_w = std::nullopt});
  package.light_field = std::move(light_field);
  package.path = std::move(path);
  return package;
}

}  // namespace lf
