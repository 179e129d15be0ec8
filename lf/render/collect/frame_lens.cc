// SPDX-License-Identifier: Apache-2.0
#include "lf/render/collect/frame_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "lf/light_field/model/time_slices.h"
#include "lf/render/collect/around_lens.h"
#include "lf/render/collect/sampled_weights.h"
#include "lf/selection/lens_weights/image_feather.h"

namespace lf {

Result<void> CheckHasArea(const RenderCamera& camera, FrameId frame) {
  if (camera.aperture.radius_w > 0) return {};
  return UsageError(fmt::format(
      "{{lens_weights area}}: the lens of frame {} is a pinhole, which has no area: use "
      "{{lens_weights hat}}",
      frame.value));
}

FrameLens::FrameLens(const ImageIndex& index, const RenderCamera& frame, LensWeights kind,
                     const SelectOptions& select, ThreadPool& pool,
                     std::optional<double> camera_distance_w)
    : light_field_(index.light_field()),
      is_of_recorded_(index.is_of_recorded()),
      select_(select),
      camera_(frame) {
  if (kind == LensWeights::kNone) return;
  camera_distance_w_ = camera_distance_w ? *camera_distance_w : CameraDistanceAround(index, frame);
  RenderCamera grown = frame;
  OpenUpTo(frame.aperture.radius_w + kReach_distances * camera_distance_w_, &grown);
  for (const SelectedImage& image : SelectImages(index, std::span(&grown, 1), select, pool))
    near_.push_back(image.id);
  // LF cameras are passed to FrameWeights in the order of their ids, because weights must not
  // depend on the order of the LF images.
  std::sort(near_.begin(), near_.end());
  std::vector<Vec3> centres_world;
  centres_world.reserve(near_.size());
  for (const LfImageId id : near_) centres_world.push_back(light_field_.Camera(id).CentreWorld());
  weights_.emplace(frame, centres_world, kind, pool, light_field_.encoding.masks_clipped);
  if (weights_->keeps_opening()) return;
  // The disk that replaces the aperture is made slightly larger, so that rays on its border count
  // as inside.
  OpenUpTo(weights_->reach_w() * (1 + 1e-6), &camera_);
}

RayWeights FrameLens::WeightsOf(LfImageId id) const {
  if (!weights_) return Takes(id) ? 1 : 0;
  const std::optional<size_t> index = IndexOf(id);
  if (!index || !weights_->TakesPart(*index)) return 0;
  const size_t camera = *index;
  RayWeights::RowFunction of_row = [this, camera](int end_x, int end_y, int count,
                                                  uint8_t* weights) {
    weights_->OfRow(camera, end_x, end_y, count, weights);
  };
  if (const std::optional<uint8_t> same = weights_->ConstantOf(camera)) {
    if (*same == 0) return 0;
    of_row = [of_all = *same](int, int, int count, uint8_t* weights) {
      std::fill_n(weights, count, of_all);
    };
  }
  auto feather = std::make_shared<const ImageFeather>(light_field_.Camera(id), camera_);
  return RayWeights(
      weights_->BlocksOf(camera), std::move(of_row),
      [feather](int x, int y, int columns, int rows, uint16_t* of_corners) {
        feather->OfCorners(x, y, columns, rows, of_corners);
      },
      [feather](const PixelRect& rect) { return feather->IsWhole(rect); });
}

bool FrameLens::Takes(LfImageId id) const {
  const LfCamera& of_image = light_field_.cameras[id.value];
  if (!weights_)
    return SliceOfFrame(light_field_, camera_.recording_time).Holds(id) &&
           !(is_of_recorded_ && of_image.is_virtual) && IsWithinAngle(of_image, camera_, select_);
  const std::optional<size_t> index = IndexOf(id);
  if (!index || !weights_->TakesPart(*index)) return false;
  // The share of an LF camera may be so small that its weight is rounded to 0.
  return weights_->ConstantOf(*index) != 0;
}

std::optional<size_t> FrameLens::IndexOf(LfImageId id) const {
  const auto found = std::lower_bound(near_.begin(), near_.end(), id);
  if (found == near_.end() || *found != id) return std::nullopt;
  return static_cast<size_t>(found - near_.begin());
}

std::optional<FrameLens::Facts> FrameLens::facts() const {
  if (!weights_) return std::nullopt;
  return Facts{weights_->hat_share(), weights_->coverage()};
}

Image<float> FrameLens::EffectiveCounts() const { return EffectiveCountsOf({this, 1}); }

void FrameLens::ReduceWeights(double factor) {
  if (weights_) weights_->Reduce(factor);
}

std::vector<FrameLens> LensesOf(const ImageIndex& index, std::span<const RenderCamera> instants,
                                LensWeights kind, const SelectOptions& select, ThreadPool& pool,
                                std::span<const double> camera_distances_w) {
  std::vector<FrameLens> lenses;
  lenses.reserve(instants.size());
  double least = FrameWeights::kMostTogether / static_cast<double>(instants.size());
  for (size_t i = 0; i < instants.size(); ++i) {
    const auto distance_w =
        camera_distances_w.empty() ? std::nullopt : std::optional(camera_distances_w[i]);
    const FrameLens& lens = lenses.emplace_back(index, instants[i], kind, select, pool, distance_w);
    if (lens.weights() != nullptr && lens.weights()->SumOfWeights() > 0)
      least = std::min(least, lens.weights()->SumOfWeights());
  }
  if (lenses.size() == 1) return lenses;
  for (FrameLens& lens : lenses) {
    if (lens.weights() == nullptr || !(lens.weights()->SumOfWeights() > 0)) continue;
    const double factor = std::max(least / lens.weights()->SumOfWeights(),
                                   kLeastLargestWeight / lens.weights()->LargestWeight());
    if (factor < 1) lens.ReduceWeights(factor);
  }
  return lenses;
}

std::optional<FrameLens::Facts> FactsOf(std::span<const FrameLens> lenses) {
  std::optional<FrameLens::Facts> all = lenses.front().facts();
  if (!all) return std::nullopt;
  for (const FrameLens& lens : lenses.subspan(1)) {
    const FrameLens::Facts facts = *lens.facts();
    all->hat_share += facts.hat_share;
    LensCoverage& coverage = all->coverage;
    coverage.uncovered_share = std::max(coverage.uncovered_share, facts.coverage.uncovered_share);
    coverage.fitting_diameter_w =
        std::min(coverage.fitting_diameter_w, facts.coverage.fitting_diameter_w);
  }
  all->hat_share /= static_cast<double>(lenses.size());
  return all;
}

Image<float> EffectiveCountsOf(std::span<const FrameLens> lenses) {
  if (lenses.front().weights() == nullptr) return {};
  const LightField& light_field = lenses.front().light_field();
  std::vector<LfImageId> ids;
  for (const FrameLens& lens : lenses)
    for (const LfImageId id : lens.near())
      if (lens.Takes(id) && !light_field.cameras[id.value].is_virtual) ids.push_back(id);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  const Intrinsics& plate = lenses.front().camera().pinhole.intrinsics;
  const int step = EffectiveStep(plate);
  const auto [columns, rows] = EffectiveSquares(plate);
  const auto middles = [step](int count, int size_px) {
    std::vector<int> elements;
    for (int i = 0; i < count; ++i) elements.push_back(std::min(i * step + step / 2, size_px - 1));
    return elements;
  };
  const SampledWeights sampled(lenses, middles(columns, plate.width_px),
                               middles(rows, plate.height_px));
  Image<double> sums(columns, rows, 2);
  Image<double> of_image(columns, rows);
  for (const LfImageId id : ids) {
    sampled.Of(id, of_image.pixels());
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const double weight = of_image.at(column, row);
        sums.at(column, row, 0) += weight;
        sums.at(column, row, 1) += weight * weight;
      }
  }
  Image<float> counts(columns, rows, 1);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double sum = sums.at(column, row, 0), squares = sums.at(column, row, 1);
      counts.at(column, row, 0) = static_cast<float>(squares > 0 ? sum * sum / squares : 0);
    }
  return counts;
}

int EffectiveStep(const Intrinsics& plate) {
  constexpr int kMostStep = 64, kLeastNodes = 8;
  return std::clamp(std::min(plate.width_px, plate.height_px) / kLeastNodes, 1, kMostStep);
}

std::pair<int, int> EffectiveSquares(const Intrinsics& plate) {
  const int step = EffectiveStep(plate);
  return {(plate.width_px + step - 1) / step, (plate.height_px + step - 1) / step};
}

Image<float> SpreadOverPlate(const Image<float>& effective_counts, const Intrinsics& plate) {
  Image<float> spread(plate.width_px, plate.height_px);
  // Position of an element between the middles of two squares (nodes): `fraction` is 0 at `node`
  // and 1 at `next`.
  struct Place {
    int node, next;
    float fraction;
  };
  const auto places = [step = EffectiveStep(plate)](int size, int count) {
    std::vector<Place> of_elements;
    for (int i = 0; i < size; ++i) {
      const int first = step / 2;
      const float at =
          (static_cast<float>(i) - static_cast<float>(first)) / static_cast<float>(step);
      const int node = std::clamp(static_cast<int>(std::floor(at)), 0, count - 1);
      of_elements.push_back({node, std::min(node + 1, count - 1),
                             std::clamp(at - static_cast<float>(node), 0.0F, 1.0F)});
    }
    return of_elements;
  };
  const std::vector<Place> across = places(plate.width_px, effective_counts.width());
  const std::vector<Place> down = places(plate.height_px, effective_counts.height());
  for (int y = 0; y < plate.height_px; ++y)
    for (int x = 0; x < plate.width_px; ++x) {
      const Place &h = across[x], &v = down[y];
      float sum = 0, total = 0;
      const auto add = [&](int column, int row, float weight) {
        const float count = effective_counts.at(column, row);
        if (count == 0) return;
        sum += weight * count;
        total += weight;
      };
      add(h.node, v.node, (1 - h.fraction) * (1 - v.fraction));
      add(h.next, v.node, h.fraction * (1 - v.fraction));
      add(h.node, v.next, (1 - h.fraction) * v.fraction);
      add(h.next, v.next, h.fraction * v.fraction);
      spread.at(x, y) = total > 0 ? sum / total : 0;
    }
  return spread;
}

}  // namespace lf
