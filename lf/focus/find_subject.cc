// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/find_subject.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "lf/core/log.h"
#include "lf/focus/best_depths.h"
#include "lf/focus/place_depth.h"
#include "lf/focus/reduced_image.h"

namespace lf {
namespace {

constexpr size_t kMostAtOnce = 4;  // largest number of LF images in memory in full size

// Loads the images of all views. Removes views whose image cannot be loaded, and rings that then
// have too few views. kOutput: the machine lacks memory or open files.
//   missing  receives the reasons why images were not loaded
Result<void> LoadRings(const LightField& field, const LfImageStore& store, ThreadPool& pool,
                       Rings* rings, std::vector<std::string>* missing) {
  MachineFailure failure;
  std::vector<View*> views;
  for (std::vector<View>& ring : *rings)
    for (View& view : ring) views.push_back(&view);
  std::vector<std::string> reasons(views.size());
  for (size_t begin = 0; begin < views.size(); begin += kMostAtOnce)
    pool.ForEach(std::min(kMostAtOnce, views.size() - begin), [&](size_t i) {
      View& view = *views[begin + i];
      Result<ReducedImage> image = LoadReducedImage(field, store, view.id);
      if (image) {
        view.image = std::make_shared<const ReducedImage>(*std::move(image));
        return;
      }
      failure.Note(image.error());
      reasons[begin + i] = image.error().message;
    });
  LF_RETURN_IF_ERROR(failure.Check());
  std::copy_if(reasons.begin(), reasons.end(), std::back_inserter(*missing),
               [](const std::string& reason) { return !reason.empty(); });
  for (std::vector<View>& ring : *rings)
    std::erase_if(ring, [](const View& view) { return view.image == nullptr; });
  std::erase_if(*rings,
                [](const std::vector<View>& ring) { return ring.size() < kLeastViewsOfRing; });
  return {};
}

}  // namespace

Result<Subject> FindSubject(const LightField& light_field, const LfImageStore& store,
                            LfImageId camera, ThreadPool& pool) {
  Subject subject;
  LF_ASSIGN_OR_RETURN(const ReducedImage image, LoadReducedImage(light_field, store, camera));
  Rings rings = ChooseRings(light_field, camera);
  LF_RETURN_IF_ERROR(LoadRings(light_field, store, pool, &rings, &subject.missing));
  const std::vector<Place> places = TexturedPlaces(light_field, camera, image);
  subject.textured_count = places.size();
  if (rings.empty()) return subject;
  const Intrinsics k = light_field.Camera(camera).intrinsics;
  std::vector<std::optional<FoundDepth>> depths(places.size());
  pool.ForEach(places.size(),
               [&](size_t i) { depths[i] = DepthOf(rings, places[i], k, image.divisor); });
  std::vector<FoundDepth> found;
  for (const std::optional<FoundDepth>& depth : depths)
    if (depth && depth->weight > 0) found.push_back(*depth);
  subject.place_count = found.size();
  if (found.empty()) return subject;
  std::sort(found.begin(), found.end(),
            [](const FoundDepth& a, const FoundDepth& b) { return a.distance_w < b.distance_w; });
  subject.near_w = found[found.size() / 10].distance_w;
  subject.far_w = found[found.size() - 1 - found.size() / 10].distance_w;
  subject.depths = BestDepths(std::move(found));
  constexpr size_t kLeastPlaces = 8;
  constexpr double kLeastShare = 0.1;
  subject.is_sure = subject.depths[0].place_count >= kLeastPlaces &&
                    subject.depths[0].share >= kLeastShare &&
                    4 * subject.place_count >= subject.textured_count;
  LogDebug("LF camera {}: {} of {} textured places have a depth, {:.4g} to {:.4g}, from {} rings",
           camera.value, subject.place_count, subject.textured_count, subject.near_w, subject.far_w,
           rings.size());
  return subject;
}

}  // namespace lf
