// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/match_exposure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "lf/core/byte_text.h"
#include "lf/focus/place_depth.h"
#include "lf/import/exposure/compare_patches.h"
#include "lf/import/exposure/exposure_views.h"
#include "lf/import/exposure/fit_exposure.h"
#include "lf/import/exposure/nearby_cameras.h"
#include "lf/light_field/model/brackets.h"
#include "lf/light_field/model/distinct_intrinsics.h"

namespace lf {
namespace {

constexpr int kWidest_px = 240, kNarrowest_px = 80;  // limits of LoadViewsOptions::width_px
constexpr double kLeastAgreement = 0.8;  // least correlation of a patch that is compared
constexpr size_t kProbed = 6;        // number of LF images that are first searched at all depths
constexpr size_t kProbedPlaces = 3;  // every third place of the kProbed LF images is searched
constexpr size_t kLeastProbes = 50;  // fewer depths found in the kProbed LF images are not used
constexpr size_t kMostSamples = 4'000'000;
// Every LF image may keep so many samples, even if all LF images together exceed kMostSamples.
constexpr size_t kLeastSamples = 60;
constexpr size_t kImagesPerRound = 64;
constexpr size_t kLeastImagesPerCamera = 8;
constexpr double kLeastCornerLight = 0.05, kMostCornerLight = 1.25;

// Groups of LF cameras that share a falloff.
struct CameraGroups {
  std::vector<uint32_t> of_images;      // group of each LF image
  std::vector<uint32_t> of_intrinsics;  // group of each of LightField::intrinsics
  std::vector<Vignetting> known;        // falloff of each group in the calibration
};

CameraGroups GroupCameras(const LightField& field) {
  CameraGroups groups;
  const bool are_shared = field.size() < kLeastImagesPerCamera * field.intrinsics.size();
  std::map<std::tuple<int, int, uint32_t>, uint32_t> numbers;
  for (uint32_t i = 0; i < field.intrinsics.size(); ++i) {
    const Intrinsics& k = field.intrinsics[i];
    const auto number = static_cast<uint32_t>(numbers.size());
    const auto [group, is_new] =
        numbers.emplace(std::tuple(k.width_px, k.height_px, are_shared ? 0 : i), number);
    if (is_new) groups.known.push_back(k.vignetting);
    groups.of_intrinsics.push_back(group->second);
  }
  for (const LfCamera& camera : field.cameras)
    groups.of_images.push_back(groups.of_intrinsics[camera.intrinsics_index]);
  return groups;
}

class Sampler {
 public:
  Sampler(const LightField& field, const std::vector<ExposureView>& views)
      : field_(field), views_(views), nearby_(field) {}

  // Finds the smallest depth at which SamplesOf() searches for the depth of a place. Searching at
  // all depths takes several times as long, and is therefore done only for some places of some LF
  // images. 2 % of the depths found there are below a limit; the smallest depth is half of it.
  void FindNearestDepth(ThreadPool& pool) {
    const size_t count = std::min(kProbed, field_.size());
    std::vector<std::vector<double>> depths(count);
    pool.ForEach(count, [&](size_t i) {
      const LfImageId id{static_cast<uint32_t>(i * field_.size() / count)};
      if (!views_[id.value].grey) return;
      const Rings rings = LoadedRings(nearby_.DepthRings(id));
      if (rings.empty()) return;
      const std::vector<Place> places = TexturedPlaces(field_, id, *views_[id.value].grey);
      for (size_t place = i % kProbedPlaces; place < places.size(); place += kProbedPlaces)
        if (const auto depth =
                DepthOf(rings, places[place], IntrinsicsOf(id), views_[id.value].grey->divisor))
          depths[i].push_back(depth->distance_w);
    });
    std::vector<double> all;
    for (const std::vector<double>& some : depths) all.insert(all.end(), some.begin(), some.end());
    if (all.size() < kLeastProbes) return;
    const auto near = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 50);
    std::nth_element(all.begin(), near, all.end());
    nearest_w_ = *near / 2;
  }

  // Returns samples that compare one LF image with the LF images around it. If there are more than
  // `most` samples, they are thinned evenly to `most`.
  std::vector<ExposureSample> SamplesOf(LfImageId id, size_t most) const {
    std::vector<ExposureSample> samples;
    const ExposureView& own = views_[id.value];
    if (!own.grey) return samples;
    const Rings rings = LoadedRings(nearby_.DepthRings(id));
    if (rings.empty()) return samples;
    const std::vector<View> compared = Loaded(nearby_.ComparedViews(id, rings));
    const Intrinsics& k = IntrinsicsOf(id);
    for (const Place& place : TexturedPlaces(field_, id, *own.grey))
      if (const auto depth = DepthOf(rings, place, k, own.grey->divisor, nearest_w_))
        Compare(id, place, depth->distance_w, compared, &samples);
    if (samples.size() <= most) return samples;
    std::vector<ExposureSample> thinned;
    for (size_t i = 0; i < most; ++i) thinned.push_back(samples[i * samples.size() / most]);
    return thinned;
  }

 private:
  const Intrinsics& IntrinsicsOf(LfImageId id) const {
    return field_.intrinsics[field_.cameras[id.value].intrinsics_index];
  }

  std::vector<View> Loaded(std::vector<View> views) const {
    for (View& view : views) view.image = views_[view.id.value].grey;
    std::erase_if(views, [](const View& view) { return view.image == nullptr; });
    return views;
  }
  Rings LoadedRings(Rings rings) const {
    for (std::vector<View>& ring : rings) ring = Loaded(std::move(ring));
    std::erase_if(rings,
                  [](const std::vector<View>& ring) { return ring.size() < kLeastViewsOfRing; });
    return rings;
  }

  void Compare(LfImageId id, const Place& place, double depth_w, const std::vector<View>& others,
               std::vector<ExposureSample>* samples) const {
    const ComparedPatch patch({views_[id.value], IntrinsicsOf(id)}, place,
                              field_.encoding.max_radiance);
    for (const View& view : others) {
      if (CorrelationAt(view, place, depth_w) < kLeastAgreement) continue;
      std::optional<ExposureSample> sample = patch.CompareWith(
          {views_[view.id.value], IntrinsicsOf(view.id)}, *PatchSeenBy(view, place, depth_w));
      if (!sample) continue;
      sample->a = id.value;
      sample->b = view.id.value;
      samples->push_back(*sample);
    }
  }

  const LightField& field_;
  const std::vector<ExposureView>& views_;
  const NearbyCameras nearby_;
  double nearest_w_ = 0;  // nearest depth that SamplesOf() searches; 0: searches all depths
};

// Returns the largest width, in pixels, with which the views of all LF images fit into the memory
// together; 0 if not even the narrowest views fit.
int WidthWithin(const LightField& field, size_t memory_bytes) {
  for (int width = kWidest_px; width >= kNarrowest_px; width -= 20) {
    size_t bytes = 0;
    for (const LfCamera& camera : field.cameras)
      bytes += ViewBytes(field.intrinsics[camera.intrinsics_index], width);
    if (bytes <= memory_bytes) return width;
  }
  return 0;
}

Result<std::vector<ExposureSample>> TakeSamples(const LightField& plain,
                                                const std::vector<ExposureView>& views,
                                                const MatchExposureOptions& options,
                                                ThreadPool& pool) {
  Sampler sampler(plain, views);
  sampler.FindNearestDepth(pool);
  const size_t most = std::max(kLeastSamples, kMostSamples / plain.size());
  std::vector<ExposureSample> samples;
  for (size_t begin = 0; begin < plain.size(); begin += kImagesPerRound) {
    if (options.interrupted && *options.interrupted)
      return Error{ErrorKind::kInterrupted,
                   fmt::format("interrupted after comparing the exposure of {} of {} images", begin,
                               plain.size())};
    const size_t count = std::min(kImagesPerRound, plain.size() - begin);
    std::vector<std::vector<ExposureSample>> of_images(count);
    pool.ForEach(count, [&](size_t i) {
      of_images[i] = sampler.SamplesOf(LfImageId{static_cast<uint32_t>(begin + i)}, most);
    });
    for (const auto& of_image : of_images)
      samples.insert(samples.end(), of_image.begin(), of_image.end());
    if (options.progress) options.progress(plain.size() + begin + count, 2 * plain.size());
  }
  return samples;
}

// Returns the mean of |ln(a / b) - model| over the agreeing samples, with the gains and falloffs of
// the calibration in the model of FitExposure().
double StepBefore(const LightField& field, const std::vector<ExposureSample>& samples,
                  const ExposureFit& fit, const CameraGroups& groups) {
  std::vector<std::array<double, 3>> log_gains(field.size());
  for (size_t i = 0; i < field.size(); ++i)
    for (size_t c = 0; c < 3; ++c) log_gains[i][c] = std::log(double{field.cameras[i].gain[c]});
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < samples.size(); ++i)
    for (int c = 0; fit.weights[i] > 0 && c < 3; ++c) {
      const double left = samples[i].log_ratio[static_cast<size_t>(c)] -
                          ModelLogRatio(samples[i], c, log_gains, groups.of_images, groups.known);
      if (std::isnan(left)) continue;
      sum += std::abs(left);
      ++count;
    }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

// Returns facts about the fitted falloffs; none if one of the falloffs is implausible for a lens,
// or if the samples do not reach far enough towards the corners of the images.
std::optional<FoundFalloff> BelievableFalloff(const LightField& field, const CameraGroups& groups,
                                              const std::vector<ExposureSample>& samples,
                                              const ExposureFit& fit) {
  std::vector<float> radii;
  for (size_t i = 0; i < samples.size(); ++i)
    if (fit.weights[i] > 0)
      radii.push_back(std::max(samples[i].a_r_squared, samples[i].b_r_squared));
  if (radii.empty()) return std::nullopt;
  FoundFalloff found;
  const auto tenth = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() * 9 / 10);
  std::nth_element(radii.begin(), tenth, radii.end());
  found.reach = std::sqrt(*tenth);
  constexpr double kLeastReach = 0.4;
  if (found.reach < kLeastReach) return std::nullopt;
  found.corner_min = std::numeric_limits<double>::max();
  found.corner_max = 0;
  found.camera_count = fit.falloffs.size();
  for (size_t i = 0; i < field.intrinsics.size(); ++i) {
    Intrinsics k = field.intrinsics[i];
    k.vignetting = fit.falloffs[groups.of_intrinsics[i]];
    const FalloffRange range = FalloffRangeOf(k);
    if (range.min < kLeastCornerLight || range.max > kMostCornerLight) return std::nullopt;
    double corner = 0;
    for (const int x : {0, k.width_px})
      for (const int y : {0, k.height_px}) corner = std::max(corner, RadiusSquared(k, x, y));
    const double share = k.vignetting.Falloff(corner);
    found.corner_min = std::min(found.corner_min, share);
    found.corner_max = std::max(found.corner_max, share);
  }
  return found;
}

}  // namespace

LightField WithoutExposure(const LightField& light_field) {
  LightField plain = light_field;
  for (LfCamera& camera : plain.cameras) {
    camera.gain = {};
    camera.masks_clipped = false;
    camera.brighter = LfCamera::kNone;
  }
  for (Intrinsics& k : plain.intrinsics) k.vignetting = {};
  return plain;
}

Result<MatchedExposure> MatchExposure(const LightField& light_field, const LfImageStore& store,
                                      const MatchExposureOptions& options, ThreadPool& pool) {
  const LightField plain = WithoutExposure(light_field);
  LoadViewsOptions load;
  load.width_px = WidthWithin(plain, options.memory_bytes);
  load.interrupted = options.interrupted;
  if (options.progress)
    load.progress = [&](size_t done, size_t total) { options.progress(done, 2 * total); };
  if (load.width_px == 0)
    return InputError(fmt::format(
        "{{match_exposure}}: even small copies of all {} LF images would exceed the limit of {} "
        "of memory: match one part of the light field at a time ({{exclude}})",
        plain.size(), ByteText(options.memory_bytes)));
  LF_ASSIGN_OR_RETURN(const std::vector<ExposureView> views,
                      LoadExposureViews(plain, store, load, pool));
  LF_ASSIGN_OR_RETURN(const std::vector<ExposureSample> samples,
                      TakeSamples(plain, views, options, pool));

  const CameraGroups groups = GroupCameras(light_field);
  MatchedExposure matched;
  ExposureFit fit =
      FitExposure(samples, groups.of_images, groups.known, {.vignetting = options.vignetting});
  if (options.vignetting) {
    matched.falloff = BelievableFalloff(light_field, groups, samples, fit);
    if (!matched.falloff)
      fit = FitExposure(samples, groups.of_images, groups.known, {.vignetting = false});
  }
  const auto tied =
      static_cast<size_t>(std::count_if(fit.components.begin(), fit.components.end(),
                                        [](uint32_t component) { return component != kAlone; }));
  const auto readable = static_cast<size_t>(std::count_if(
      views.begin(), views.end(), [](const ExposureView& view) { return view.grey != nullptr; }));
  if (tied == 0 || 2 * tied < readable)
    return InputError(fmt::format(
        "{{match_exposure}}: the gains of only {} of {} LF images can be estimated, from {} places "
        "that two LF images show{}. LF images must overlap, the scene must have texture, and its "
        "light must not move relative to the scene (as it does on a turntable). Import without "
        "{{match_exposure}}, or state lf_gain (doc/formats/transforms_json.md)",
        tied, readable, samples.size(),
        fit.spread > 0
            ? fmt::format(" (the ratio of their brightness varies by {:.0f} % from place to place)",
                          100 * fit.spread)
            : ""));
  matched.sample_count = fit.sample_count;
  matched.component_count = fit.component_count;
  matched.step_after = fit.step;
  matched.step_before = StepBefore(light_field, samples, fit, groups);
  matched.least_gain = std::numeric_limits<float>::max();
  matched.most_gain = 0;
  for (uint32_t i = 0; i < plain.size(); ++i) {
    matched.gains.push_back(light_field.cameras[i].gain);
    if (!views[i].grey) matched.unreadable.push_back(LfImageId{i});
    if (views[i].grey && fit.components[i] == kAlone) matched.left_alone.push_back(LfImageId{i});
    if (fit.components[i] == kAlone) continue;
    for (size_t c = 0; c < 3; ++c) {
      const auto gain = static_cast<float>(std::exp(fit.log_gains[i][c]));
      matched.gains[i][c] = gain;
      matched.least_gain = std::min(matched.least_gain, gain);
      matched.most_gain = std::max(matched.most_gain, gain);
    }
  }
  for (size_t i = 0; i < light_field.intrinsics.size(); ++i)
    matched.falloffs.push_back(matched.falloff ? fit.falloffs[groups.of_intrinsics[i]]
                                               : light_field.intrinsics[i].vignetting);
  return matched;
}

void ApplyExposure(const MatchedExposure& matched, LightField* light_field) {
  for (size_t i = 0; i < light_field->intrinsics.size(); ++i)
    light_field->intrinsics[i].vignetting = matched.falloffs[i];
  for (size_t i = 0; i < light_field->size(); ++i) light_field->cameras[i].gain = matched.gains[i];
  MakeRoomForGains(light_field);
}

}  // namespace lf
