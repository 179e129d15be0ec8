// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_planes.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "lf/core/parallel.h"
#include "lf/densify/depth_sweep.h"
#include "lf/densify/stored_planes.h"

namespace lf {

// The loop that makes the call returns an error of its own.
Result<void> DepthPlanes::CheckNotInterrupted() const {
  if (IsSet(interrupted_)) return Error{ErrorKind::kInterrupted, "interrupted"};
  return {};
}

Result<DepthPlane> DepthPlanes::Searched(uint32_t id) {
  LF_ASSIGN_OR_RETURN(const auto reference, images_.Get(LfImageId{id}));
  std::vector<std::shared_ptr<const WorkingImage>> others;
  std::vector<SweepView> views;
  for (const uint32_t other : plan_.compare_with[id]) {
    LF_ASSIGN_OR_RETURN(auto image, images_.Get(LfImageId{other}));
    views.push_back(ViewFrom(*reference, *image));
    others.push_back(std::move(image));
  }
  const ThreadCpuTimer timer;
  DepthPlane plane = SweepDepths(*reference, views, plan_.range, plan_.planes, interrupted_);
  LF_RETURN_IF_ERROR(CheckNotInterrupted());
  const std::lock_guard lock(mutex_);
  facts_.cpu_s += static_cast<double>(timer.Nanoseconds()) * 1e-9;
  facts_.searched_pixels += static_cast<double>(plane.pixels().size());
  return plane;
}

Result<void> DepthPlanes::SearchOne(uint32_t id) {
  const PinholeCamera camera = CameraOf(id);
  const DepthCache::Entry entry = EntryOf(id);
  if (auto cached =
          cache_.FindPlane(entry, camera.intrinsics.width_px, camera.intrinsics.height_px)) {
    planes_[id] = *std::move(cached);
    const std::lock_guard lock(mutex_);
    ++facts_.cached;
    return {};
  }
  if (writer_.HasPlane(LfImageId{id}, PlaneKind::kSwept)) {
    LF_ASSIGN_OR_RETURN(const Image<uint16_t> stored,
                        writer_.ReadPlane(LfImageId{id}, PlaneKind::kSwept));
    planes_[id] = CutTo(stored, camera.intrinsics.width_px, camera.intrinsics.height_px);
    return {};
  }
  LF_ASSIGN_OR_RETURN(planes_[id], Searched(id));
  if (cache_.KeepPlane(entry, planes_[id])) return {};
  const Intrinsics& k = light_field_.Camera(LfImageId{id}).intrinsics;
  return writer_.AddPlane(
      LfImageId{id}, PlaneKind::kSwept,
      PaddedTo(planes_[id], PlaneSizeOf(k.width_px, k.height_px, plan_.divisor)));
}

size_t DepthPlanes::MissingCount() const {
  return static_cast<size_t>(
      std::count_if(plan_.swept.begin(), plan_.swept.end(), [&](uint32_t id) {
        return !cache_.MayHave(EntryOf(id)) && !writer_.HasPlane(LfImageId{id}, PlaneKind::kSwept);
      }));
}

Result<void> DepthPlanes::Search(const Loop& loop) {
  return loop(DensifyStep::kDepths, plan_.swept.size(),
              [&](size_t i) { return SearchOne(plan_.swept[i]); });
}

Result<DepthPlane> DepthPlanes::Agreeing(uint32_t id, double* agreeing_count,
                                         double* shown_count) const {
  constexpr int kWanted = 2;
  std::vector<DepthView> views;
  for (const uint32_t other : plan_.compare_with[id])
    if (!planes_[other].empty())
      views.push_back({&planes_[other], MapBetween(CameraOf(id), CameraOf(other))});
  LF_ASSIGN_OR_RETURN(const auto image, images_.Get(LfImageId{id}));
  const Image<uint8_t> agreeing =
      CountAgreeing(planes_[id], image->tones, views, plan_.range, plan_.tolerance, interrupted_);
  const int wanted = std::min(kWanted, static_cast<int>(views.size()));
  *agreeing_count =
      static_cast<double>(std::count_if(agreeing.pixels().begin(), agreeing.pixels().end(),
                                        [&](uint8_t count) { return count >= wanted; }));
  *shown_count = static_cast<double>(ShownCount(image->tones));
  return FillDisagreeing(planes_[id], agreeing, wanted, image->tones, plan_.range,
                         plan_.shift_per_depth_px, interrupted_);
}

Result<void> DepthPlanes::MakeAgree(const Loop& loop) {
  for (const DensifyStep round : {DensifyStep::kAgreement, DensifyStep::kAgreementAgain}) {
    std::vector<DepthPlane> agreeing(planes_.size());
    double count = 0, shown = 0;
    LF_RETURN_IF_ERROR(loop(round, plan_.swept.size(), [&](size_t i) -> Result<void> {
      const uint32_t id = plan_.swept[i];
      double agreeing_count = 0, shown_count = 0;
      LF_ASSIGN_OR_RETURN(agreeing[id], Agreeing(id, &agreeing_count, &shown_count));
      const std::lock_guard lock(mutex_);
      count += agreeing_count;
      shown += shown_count;
      return {};
    }));
    planes_ = std::move(agreeing);
    facts_.agreeing_share = count / std::max(shown, 1.0);
  }
  return {};
}

Result<void> DepthPlanes::Store(const Loop& loop) const {
  return loop(DensifyStep::kStoring, plan_.stored.size(), [&](size_t i) -> Result<void> {
    const LfImageId id{plan_.stored[i]};
    if (writer_.HasPlane(id, PlaneKind::kDisparity)) return {};
    const DepthPlane recorded = AsRecorded(planes_[id.value], light_field_.Camera(id).intrinsics,
                                           plan_.divisor, interrupted_);
    LF_RETURN_IF_ERROR(CheckNotInterrupted());
    return writer_.AddPlane(id, PlaneKind::kDisparity, recorded);
  });
}

}  // namespace lf
