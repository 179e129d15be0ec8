// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/find_subject.h"

#include <fmt/format.h>

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

constexpr double kClearlyBefore = 0.85;  // a smaller share of a depth is clearly nearer

// Sets near_w and far_w by the depths, in ascending order, that are about as precise as half of
// them.
void SetRange(const std::vector<FoundDepth>& found, Subject* subject) {
  std::vector<double> errors;
  for (const FoundDepth& one : found) errors.push_back(one.error);
  const auto middle = errors.begin() + static_cast<ptrdiff_t>(errors.size() / 2);
  std::nth_element(errors.begin(), middle, errors.end());
  constexpr double kAsPrecise = 1.5;
  std::vector<double> depths_w;
  for (const FoundDepth& one : found)
    if (one.error <= kAsPrecise * *middle) depths_w.push_back(one.distance_w);
  subject->near_w = depths_w[depths_w.size() / 10];
  subject->far_w = depths_w[depths_w.size() - 1 - depths_w.size() / 10];
}

// Returns the share of all weight that lies clearly before a depth.
double ShareBefore(const std::vector<FoundDepth>& found, double distance_w) {
  double before = 0, all = 0;
  for (const FoundDepth& one : found) {
    all += one.weight;
    if (one.distance_w < kClearlyBefore * distance_w) before += one.weight;
  }
  return before / all;
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
  std::vector<NoDepth> whys(places.size());
  pool.ForEach(places.size(), [&](size_t i) {
    depths[i] = DepthOf(rings, places[i], k, image.divisor, 0, &whys[i]);
  });
  for (size_t i = 0; i < places.size(); ++i) {
    if (depths[i] || whys[i] == NoDepth::kFar)
      subject.per_w.push_back(depths[i] ? 1 / depths[i]->distance_w : 0);
    else
      subject.disagreeing_count += whys[i] == NoDepth::kDisagreement;
  }
  std::sort(subject.per_w.begin(), subject.per_w.end());
  std::vector<FoundDepth> found;
  for (const std::optional<FoundDepth>& depth : depths)
    if (depth && depth->weight > 0) found.push_back(*depth);
  subject.place_count = found.size();
  if (found.empty()) return subject;
  std::sort(found.begin(), found.end(),
            [](const FoundDepth& a, const FoundDepth& b) { return a.distance_w < b.distance_w; });
  SetRange(found, &subject);
  constexpr size_t kCompared = 6, kKept = 3;
  subject.depths = BestDepths(found, kCompared);
  const auto is_large = [](const SubjectDepth& depth) {
    return depth.place_count >= kLeastSubjectPlaces && depth.share >= kLeastSubjectShare;
  };
  subject.is_range_sure = std::any_of(subject.depths.begin(), subject.depths.end(), is_large) &&
                          4 * subject.place_count >= subject.textured_count;
  PutSubjectFirst(&subject.depths);
  subject.share_before = ShareBefore(found, subject.depths[0].distance_w);
  constexpr double kLeastFound = 0.4, kLeastOfTextured = 0.125;
  const auto textured_count = static_cast<double>(subject.textured_count);
  const SubjectDepth& best = subject.depths[0];
  subject.is_sure = is_large(best) &&
                    static_cast<double>(best.place_count) >= kLeastOfTextured * textured_count &&
                    subject.share_before <= kMostBefore &&
                    static_cast<double>(subject.place_count) >= kLeastFound * textured_count;
  std::string clusters;
  for (const SubjectDepth& depth : subject.depths)
    clusters += fmt::format("; {} near {:.4g}, {:.0f} % of the weight", depth.place_count,
                            depth.distance_w, 100 * depth.share);
  // If most of the picture stands before the best depth, the best one of these is the better guess.
  const auto is_before = [&](const SubjectDepth& depth) {
    return depth.distance_w < kClearlyBefore * subject.depths[0].distance_w;
  };
  if (subject.share_before > kMostBefore)
    if (const auto first = std::find_if(subject.depths.begin(), subject.depths.end(), is_before);
        first != subject.depths.end())
      std::rotate(subject.depths.begin(), first, first + 1);
  if (subject.depths.size() > kKept) subject.depths.resize(kKept);
  LogDebug("LF camera {}: {} of {} textured places have a depth, {:.4g} to {:.4g}, from {} rings{}",
           camera.value, subject.place_count, subject.textured_count, subject.near_w, subject.far_w,
           rings.size(), clusters);
  return subject;
}

}  // namespace lf
