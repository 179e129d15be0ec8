// SPDX-License-Identifier: Apache-2.0
#include "lf/render/package/package.h"

#include <utility>

#include "lf/core/check.h"

namespace lf {

std::vector<FrameId> Package::FrameIds() const {
  std::vector<FrameId> ids;
  for (const PackageFrame& frame : frames) ids.push_back(frame.id);
  return ids;
}

std::optional<double> Package::CameraDistance(FrameId frame) const {
  if (surroundings.empty()) return std::nullopt;
  LF_CHECK(surroundings.size() == path.frame_count());
  return surroundings[path.frames().IndexOf(frame)].camera_distance_w;
}

std::optional<double> Package::RecordedCameraDistance(FrameId frame) const {
  const std::optional<double> of_all = CameraDistance(frame);
  if (!of_all) return std::nullopt;
  return surroundings[path.frames().IndexOf(frame)].recorded_distance_w.value_or(*of_all);
}

std::span<const double> Package::InstantDistances(FrameId frame) const {
  if (instant_distances_w.empty()) return {};
  const auto samples = static_cast<size_t>(path.shutter.samples);
  LF_CHECK(instant_distances_w.size() == path.frame_count() * samples);
  const std::span<const double> distances_w =
      std::span(instant_distances_w).subspan(path.frames().IndexOf(frame) * samples, samples);
  return distances_w.front() < 0 ? std::span<const double>() : distances_w;
}

Package PackageOfAll(LightField light_field, CameraPath path, uint64_t seed, ImageOrder order) {
  Package package;
  package.whole = IdentityOf(light_field);
  package.whole_virtual_count = light_field.size() - RecordedCount(light_field);
  package.ranks = RanksOf(order, light_field, seed);
  package.choices.order = order;
  package.choices.seed = seed;
  for (const FrameId frame : path.frames().All()) package.frames.push_back({.id = frame});
  package.light_field = std::move(light_field);
  package.path = std::move(path);
  return package;
}

}  // namespace lf
