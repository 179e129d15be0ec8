// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/demosaic/joint_demosaicker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "lf/core/hash.h"
#include "lf/densify/camera_chart.h"
#include "lf/densify/demosaic/joint_images.h"
#include "lf/densify/demosaic/joint_neighbours.h"
#include "lf/densify/demosaic/joint_tile.h"
#include "lf/densify/demosaic/pixel_places.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/depth_search.h"
#include "lf/densify/depth_sweep.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

constexpr int kTile_px = 256;
static_assert(kTile_px % kGuardBlock_px == 0);
constexpr uint32_t kLeftOut = std::numeric_limits<uint32_t>::max();

}  // namespace

Result<void> CheckForJoint(const LightField& light_field) {
  if (light_field.encoding.bayer == BayerPattern::kNone)
    return UsageError(fmt::format(
        "{}: has RGB or grey LF images, and {{demosaic joint}} needs mosaics: leave it out",
        light_field.source.string()));
  if (HasVirtual(light_field))
    return UsageError(fmt::format(
        "{}: has virtual LF images, which {{demosaic joint}} cannot use: give the light field that "
        "was recorded",
        light_field.source.string()));
  if (light_field.encoding.masks_clipped)
    return InputError(fmt::format(
        "{}: has brackets (\"lf_clipped\": \"mask\"), which {{demosaic joint}} does not support: "
        "leave it out, or give the LF images of one exposure",
        light_field.source.string()));
  return {};
}

struct JointDemosaicker::State {
  LightField light_field;            // without LF images that cannot be read
  std::vector<uint32_t> new_ids;     // [id of the caller]: id in `light_field`, or kLeftOut
  std::vector<std::string> reasons;  // [id of the caller]: why it cannot be read
  std::unique_ptr<LfImageStore> store;
  std::unique_ptr<JointImages> images;
  std::vector<Vec3> centres;
  std::vector<std::vector<uint32_t>> compare_with;
  InverseDepths range;
  InterruptFlag interrupted = nullptr;

  Result<void> LeaveOutBroken(ThreadPool& pool, const Watch& watch);
  Result<void> FindRange(ThreadPool& pool);
  Result<Image<float>> DepthsOf(uint32_t id, const JointImage& image,
                                const IdealPositions& ideal) const;
  Result<JointImageResult> Demosaic(uint32_t id) const;
};

Result<void> JointDemosaicker::State::LeaveOutBroken(ThreadPool& pool, const Watch& watch) {
  LF_ASSIGN_OR_RETURN(store, OpenStore(light_field, Mosaics::kAsRecorded));
  reasons.assign(light_field.size(), "");
  LF_RETURN_IF_ERROR(ForEachWatched(pool, light_field.size(), watch, [&](size_t i) {
    const LfImageId id{static_cast<uint32_t>(i)};
    const Intrinsics& k = light_field.Camera(id).intrinsics;
    const auto loaded = LoadWithoutThrowing(*store, id, {0, 0, k.width_px, k.height_px},
                                            light_field.image_names[i], LfPixels{});
    if (loaded) return Result<void>();
    if (loaded.error().kind != ErrorKind::kInput) return Result<void>(loaded.error());
    reasons[i] = loaded.error().message;
    return Result<void>();
  }));
  new_ids.assign(light_field.size(), kLeftOut);
  std::vector<size_t> kept;
  for (size_t i = 0; i < reasons.size(); ++i) {
    if (!reasons[i].empty()) continue;
    new_ids[i] = static_cast<uint32_t>(kept.size());
    kept.push_back(i);
  }
  if (kept.empty())
    return InputError(fmt::format("none of the {} LF images can be read; the first: {}",
                                  light_field.size(), reasons.front()));
  KeepImages(kept, &light_field);
  LF_ASSIGN_OR_RETURN(store, OpenStore(light_field, Mosaics::kAsRecorded));
  return {};
}

Result<void> JointDemosaicker::State::FindRange(ThreadPool& pool) {
  const std::optional<Vec3> subject = AxesMeetingPoint(light_field);
  std::vector<uint32_t> all(light_field.size());
  std::iota(all.begin(), all.end(), 0U);
  compare_with = CompareWith(light_field, all, subject);
  if (std::all_of(compare_with.begin(), compare_with.end(),
                  [](const auto& others) { return others.empty(); })) {
    range = {0, 1};  // all LF cameras are at one place, and depths have no effect
    return {};
  }
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> rgb,
                      OpenStore(light_field, Mosaics::kToRgb));
  const Result<InverseDepths> found =
      FindInverseDepths(light_field, *rgb, compare_with, pool, {"range of depths", interrupted});
  if (!found && found.error().kind == ErrorKind::kInput)
    return InputError(fmt::format(
        "{}: {{demosaic joint}} needs the depths of the scene, which cannot be found, because the "
        "LF images overlap too little or lack texture: leave it out to keep the mosaics",
        light_field.source.string()));
  if (!found) return found.error();
  range = *found;
  compare_with = FarEnoughForDepths(light_field, centres, subject, range, std::move(compare_with));
  return {};
}

// Returns the inverse depth of every pixel of an LF image.
Result<Image<float>> JointDemosaicker::State::DepthsOf(uint32_t id, const JointImage& image,
                                                       const IdealPositions& ideal) const {
  Image<float> depths(image.width(), image.height(), 1, static_cast<float>(range.least));
  if (compare_with[id].empty()) return depths;
  std::vector<std::shared_ptr<const JointImage>> others;
  std::vector<SweepView> views;
  double shift_px = 0;
  for (const uint32_t other : compare_with[id]) {
    LF_ASSIGN_OR_RETURN(auto loaded, images->Get(LfImageId{other}));
    views.push_back(ViewFrom(image.working, loaded->working));
    shift_px += ShiftPerInverseDepth(image.working.camera, loaded->working.camera);
    others.push_back(std::move(loaded));
  }
  shift_px *= (range.greatest - range.least) / static_cast<double>(views.size());
  const DepthPlane plane =
      SweepDepths(image.working, views, range, PlanesFor(shift_px), interrupted);
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) {
      const Vec2 at = ideal.At(x, y);
      if (std::isnan(at.x())) continue;
      const auto nearest = [](double place, int size) {
        return static_cast<int>(std::clamp(std::floor(place), 0.0, size - 1.0));
      };
      const uint16_t number =
          plane.at(nearest(at.x(), plane.width()), nearest(at.y(), plane.height()));
      if (number != InverseDepths::kUnknown) depths.at(x, y) = static_cast<float>(range.Of(number));
    }
  return depths;
}

Result<JointImageResult> JointDemosaicker::State::Demosaic(uint32_t id) const {
  LF_ASSIGN_OR_RETURN(const std::shared_ptr<const JointImage> image, images->Get(LfImageId{id}));
  const IdealPositions ideal(image->camera);
  LF_ASSIGN_OR_RETURN(const Image<float> depths, DepthsOf(id, *image, ideal));

  std::vector<std::shared_ptr<const JointImage>> others;
  std::vector<JointNeighbour> neighbours;
  for (const ChosenNeighbour& chosen :
       ChooseNeighbours(light_field, centres, id, range, kJointNeighbours)) {
    LF_ASSIGN_OR_RETURN(auto loaded, images->Get(LfImageId{chosen.id}));
    const PixelPlaces places(image->camera, loaded->camera);
    const float middle = depths.at(image->width() / 2, image->height() / 2);
    neighbours.push_back(
        {loaded.get(), places, places.OffsetsIn(ideal, image->width(), image->height(), middle),
         chosen.nearness, ShiftPerInverseDepth(image->working.camera, loaded->working.camera)});
    others.push_back(std::move(loaded));
  }

  const int width = image->width(), height = image->height();
  JointImageResult result;
  result.rgb = image->rgb;
  if (!neighbours.empty()) {
    const Image<float> other = DemosaickedWithOtherPattern(*image, light_field.encoding);
    const Image<uint8_t> is_tested =
        TestedPixels(HashBytes(light_field.image_names[id]), width, height);
    Image<float> tested(width, height);
    const JointTarget target{image.get(), &ideal, &depths, neighbours, &other, &is_tested};
    for (int y = 0; y < height; y += kTile_px)
      for (int x = 0; x < width; x += kTile_px) {
        if (IsSet(interrupted)) return Error{ErrorKind::kInterrupted, "interrupted"};
        const JointTile tile = MergeTile(
            target, {x, y, std::min(x + kTile_px, width), std::min(y + kTile_px, height)});
        for (int row = 0; row < tile.rect.height(); ++row) {
          std::copy_n(tile.rgb.row(row), 3 * tile.rect.width(), &result.rgb.at(x, y + row));
          std::copy_n(tile.tested.row(row), tile.rect.width(), &tested.at(x, y + row));
        }
      }
    result.errors = ApplyGuard(*image, other, is_tested, tested, &result.rgb);
  }
  const BalancedRadiance balanced(light_field.encoding);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        result.rgb.at(x, y, c) = balanced.Radiance(result.rgb.at(x, y, c), c);
  return result;
}

JointDemosaicker::JointDemosaicker(std::unique_ptr<State> state) : state_(std::move(state)) {}
JointDemosaicker::~JointDemosaicker() = default;

Result<std::unique_ptr<JointDemosaicker>> JointDemosaicker::Make(const LightField& light_field,
                                                                 ThreadPool& pool,
                                                                 const Options& options) {
  LF_RETURN_IF_ERROR(CheckForJoint(light_field));
  auto state = std::make_unique<State>();
  state->light_field = light_field;
  MakeRoomForUndershoot(&state->light_field.encoding);
  state->interrupted = options.watch.interrupted;
  LF_RETURN_IF_ERROR(state->LeaveOutBroken(pool, options.watch));
  for (uint32_t i = 0; i < state->light_field.size(); ++i)
    state->centres.push_back(state->light_field.Camera(LfImageId{i}).CentreWorld());
  LF_RETURN_IF_ERROR(state->FindRange(pool));
  state->images =
      std::make_unique<JointImages>(state->light_field, *state->store, options.memory_bytes);
  return std::unique_ptr<JointDemosaicker>(new JointDemosaicker(std::move(state)));
}

Result<JointImageResult> JointDemosaicker::Demosaic(LfImageId id) const {
  if (!state_->reasons[id.value].empty()) return InputError(state_->reasons[id.value]);
  return state_->Demosaic(state_->new_ids[id.value]);
}

}  // namespace lf
