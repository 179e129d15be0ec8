// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include "lf/core/median.h"
#include "lf/densify/semi_global.h"
#include "lf/densify/working_images.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr int kSearchedWidth = 200;
constexpr size_t kReferences = 8, kMostViews = 6;
constexpr int kTexture = 8, kSearchedBorder = 2;

// Returns the largest cost of a match that counts as good. Noise makes right matches dear as well:
// where it does, the better half of the textured pixels counts.
int GoodCost(const Image<uint16_t>& tones, const ChosenPlanes& chosen) {
  constexpr int kGood = 40;
  std::vector<double> costs;
  for (int y = kSearchedBorder; y < tones.height() - kSearchedBorder; ++y)
    for (int x = kSearchedBorder; x < tones.width() - kSearchedBorder; ++x)
      if (TextureAt(tones, x, y) > kTexture) costs.push_back(chosen.cost.at(x, y));
  return costs.empty() ? kGood : std::max(kGood, static_cast<int>(Median(std::move(costs))));
}

// A pixel of an LF image with a sure depth.
struct SurePixel {
  Vec3 point_camera;  // (x, y, 1) in camera axes, on the ray of the pixel
  double inverse_depth = 0;
};

// Appends the pixels of one LF image that are sure.
void AppendSure(const LightField& light_field, const std::optional<Vec3>& subject,
                const WorkingImage& reference, std::span<const SweepView> views,
                InterruptFlag interrupted, std::vector<SurePixel>* found) {
  constexpr double kLeastStep_px = 0.5;
  constexpr int kMostSearched = 220;
  constexpr int kClear = 6;
  std::vector<double> shifts;
  for (const SweepView& view : views)
    shifts.push_back(ShiftPerInverseDepth(reference.camera, view.image->camera));
  if (shifts.empty()) return;
  const double shift = Median(std::move(shifts));
  if (!(shift > 0)) return;
  const InverseDepths range =
      SearchedRange(reference.camera, shift, subject, light_field.depth_range);
  const double extent = range.greatest - range.least;
  const int planes =
      std::clamp(static_cast<int>(extent * shift / kLeastStep_px) + 1, 8, kMostSearched);
  MatchingCosts costs;
  ComputeMatchingCosts(reference, views, range, planes,
                       {0, 0, reference.width(), reference.height()}, &costs, interrupted);
  const ChosenPlanes chosen = ChoosePlanes(costs, reference.tones, true, interrupted);
  const int good = GoodCost(reference.tones, chosen);
  // A depth at the end of the range may lie beyond it, or match by chance. Only a stated range has
  // a far end that means something.
  const auto first = light_field.depth_range ? -1.0f : 2.0f;
  const auto last = static_cast<float>(planes - 3);
  const Mat3 direction_of_pixel = reference.camera.intrinsics.InverseMatrix();
  for (int y = kSearchedBorder; y < reference.height() - kSearchedBorder; ++y)
    for (int x = kSearchedBorder; x < reference.width() - kSearchedBorder; ++x)
      if (TextureAt(reference.tones, x, y) > kTexture && chosen.cost.at(x, y) < good &&
          chosen.lead.at(x, y) > kClear && chosen.place.at(x, y) > first &&
          chosen.place.at(x, y) < last)
        found->push_back(
            {direction_of_pixel * Vec3(x + 0.5, y + 0.5, 1),
             range.least + static_cast<double>(chosen.place.at(x, y)) * extent / (planes - 1)});
}

double Quantile(std::span<const double> sorted, double share) {
  return sorted[static_cast<size_t>(share * static_cast<double>(sorted.size() - 1))];
}

//   of_images  inverse depths found in each LF image
InverseDepths RangeOf(std::vector<std::vector<double>> of_images) {
  constexpr double kOutermost = 0.005, kWidened = 0.06, kFewBeyond = 0.02, kAlone = 0.1;
  constexpr size_t kLeastImages = 4, kLeastDepths = 50;
  std::vector<double> all, leasts, greatests;
  for (std::vector<double>& depths : of_images) {
    std::sort(depths.begin(), depths.end());
    all.insert(all.end(), depths.begin(), depths.end());
    if (depths.size() < kLeastDepths) continue;
    leasts.push_back(Quantile(depths, kOutermost));
    greatests.push_back(Quantile(depths, 1 - kOutermost));
  }
  std::sort(all.begin(), all.end());
  std::sort(leasts.begin(), leasts.end());
  std::sort(greatests.rbegin(), greatests.rend());
  double least = Quantile(all, kOutermost), greatest = Quantile(all, 1 - kOutermost);
  if (leasts.size() >= kLeastImages) {
    // One LF image alone does not widen the range by much, because its pose or its light may differ
    // from those of its neighbours.
    const double extent = greatests[1] - leasts[1];
    least = std::max(least, leasts[1] - kAlone * extent);
    greatest = std::min(greatest, greatests[1] + kAlone * extent);
  }
  const double margin = kWidened * (greatest - least) + 1e-3 * std::abs(greatest);
  const bool few_beyond = Quantile(all, kFewBeyond) >= 0;
  return {few_beyond ? std::max(0.0, least - margin) : least - margin, greatest + margin};
}

// The sure pixels of an LF image.
struct SurePixels {
  RigidTransform cam_from_world;
  std::vector<SurePixel> pixels;
};

// Searches eight of the LF images `ids`, spread over these.
Result<std::vector<SurePixels>> SearchSure(const LightField& light_field, const LfImageStore& store,
                                           std::span<const std::vector<uint32_t>> compare_with,
                                           std::span<const uint32_t> ids, ThreadPool& pool,
                                           const Watch& watch) {
  const int divisor = std::max(1, light_field.intrinsics.front().width_px / kSearchedWidth);
  WorkingImages images(light_field, store, divisor, std::numeric_limits<size_t>::max());
  const std::optional<Vec3> subject = AxesMeetingPoint(light_field);
  const size_t count = std::min(kReferences, ids.size());
  std::vector<SurePixels> sure(count);
  LF_RETURN_IF_ERROR(ForEachWatched(pool, count, watch, [&](size_t i) -> Result<void> {
    const uint32_t id = ids[count == 1 ? 0 : i * (ids.size() - 1) / (count - 1)];
    std::vector<std::shared_ptr<const WorkingImage>> loaded;
    std::vector<uint32_t> wanted{id};
    const std::vector<uint32_t>& others = compare_with[id];
    wanted.insert(wanted.end(), others.begin(),
                  others.begin() + static_cast<ptrdiff_t>(std::min(kMostViews, others.size())));
    for (const uint32_t one : wanted) {
      LF_ASSIGN_OR_RETURN(auto image, images.Get(LfImageId{one}));
      loaded.push_back(std::move(image));
    }
    std::vector<SweepView> views;
    for (size_t k = 1; k < loaded.size(); ++k) views.push_back(ViewFrom(*loaded[0], *loaded[k]));
    sure[i].cam_from_world = loaded[0]->camera.cam_from_world;
    AppendSure(light_field, subject, *loaded[0], views, watch.interrupted, &sure[i].pixels);
    return {};
  }));
  return sure;
}

}  // namespace

InverseDepths SearchedRange(const PinholeCamera& camera, double shift_per_depth_px,
                            const std::optional<Vec3>& subject,
                            const std::optional<DepthRange>& stated) {
  constexpr double kGreatestShift = 0.3, kBeyondInfinity = 0.1;
  constexpr double kNearer = 1.5, kFarther = 0.5;  // inverse depths, by those that are stated
  const double longer_px = std::max(camera.intrinsics.width_px, camera.intrinsics.height_px);
  const double shifted = kGreatestShift * longer_px / shift_per_depth_px;
  const double subject_w = subject ? (camera.cam_from_world * *subject).z() : 0;
  const InverseDepths range{-kBeyondInfinity * shifted,
                            shifted + (subject_w > 0 ? 1 / subject_w : 0)};
  if (!stated) return range;
  const InverseDepths narrower{std::max(range.least, kFarther / stated->far_w),
                               std::min(range.greatest, kNearer / stated->near_w)};
  return narrower.greatest > narrower.least ? narrower : range;
}

Result<InverseDepths> FindInverseDepths(const LightField& light_field, const LfImageStore& store,
                                        std::span<const std::vector<uint32_t>> compare_with,
                                        ThreadPool& pool, const Watch& watch) {
  constexpr size_t kLeastDepths = 200;
  std::vector<uint32_t> ids(light_field.size());
  std::iota(ids.begin(), ids.end(), 0U);
  LF_ASSIGN_OR_RETURN(const std::vector<SurePixels> sure,
                      SearchSure(light_field, store, compare_with, ids, pool, watch));
  std::vector<std::vector<double>> depths;
  for (const SurePixels& of_image : sure) {
    depths.emplace_back();
    for (const SurePixel& pixel : of_image.pixels) depths.back().push_back(pixel.inverse_depth);
  }
  size_t found = 0;
  for (const std::vector<double>& of_image : depths) found += of_image.size();
  if (found < kLeastDepths)
    return InputError(fmt::format(
        "depths of the scene: only {} pixels of {} LF images have a sure depth, expected at least "
        "{}: the LF images overlap too little or lack texture; state the depths by {{depths}}",
        found, depths.size(), kLeastDepths));
  return RangeOf(std::move(depths));
}

Result<std::vector<std::vector<Vec3>>> FindSurePoints(
    const LightField& light_field, const LfImageStore& store,
    std::span<const std::vector<uint32_t>> compare_with, std::span<const uint32_t> ids,
    ThreadPool& pool, const Watch& watch) {
  LF_ASSIGN_OR_RETURN(const std::vector<SurePixels> sure,
                      SearchSure(light_field, store, compare_with, ids, pool, watch));
  std::vector<std::vector<Vec3>> points;
  for (const SurePixels& of_image : sure) {
    const RigidTransform world_from_cam = of_image.cam_from_world.Inverse();
    points.emplace_back();
    for (const SurePixel& pixel : of_image.pixels)
      if (pixel.inverse_depth > 0)
        points.back().push_back(world_from_cam * (pixel.point_camera / pixel.inverse_depth));
  }
  return points;
}

}  // namespace lf
