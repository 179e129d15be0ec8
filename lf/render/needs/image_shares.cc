// SPDX-License-Identifier: Apache-2.0
#include "lf/render/needs/image_shares.h"

#include <algorithm>
#include <optional>
#include <span>

#include "lf/render/collect/frame_lens.h"
#include "lf/render/collect/sampled_weights.h"
#include "lf/selection/select.h"

namespace lf {
namespace {

constexpr int kSamples = 12;  // number of columns, and of rows, in which weights are computed

std::vector<FrameLens> LensesOfFrame(const ImageIndex& index, const Package& package, FrameId frame,
                                     LensWeights kind, const SelectOptions& select,
                                     ThreadPool& pool) {
  const std::span<const RenderCamera> instants = package.path.Instants(frame);
  std::span<const double> distances_w = package.InstantDistances(frame);
  const std::optional<double> distance_w = package.CameraDistance(frame);
  if (distances_w.empty() && distance_w && instants.size() == 1)
    distances_w = std::span(&*distance_w, 1);
  return LensesOf(index, instants, kind, select, pool, distances_w);
}

// Returns the LF images that the frame collects rays of, by ascending ids.
std::vector<LfImageId> TakenImages(const ImageIndex& index, const Package& package,
                                   std::span<const FrameLens> lenses, const SelectOptions& select,
                                   ThreadPool& pool) {
  std::vector<TakingFrame> taking;
  for (const FrameLens& lens : lenses)
    taking.push_back({lens.camera(), {}, [&lens](LfImageId id) { return lens.Takes(id); }});
  if (package.choices.max_image_count) {
    const RankRange ranks = RanksOfFirst(*package.choices.max_image_count, index, taking, select);
    for (TakingFrame& instant : taking) instant.ranks = ranks;
  }
  std::vector<LfImageId> ids;
  for (const SelectedImage& image : SelectImages(index, taking, select, pool))
    ids.push_back(image.id);
  std::sort(ids.begin(), ids.end());
  return ids;
}

// Returns the middle columns (or rows) of kSamples equal parts of a side of the plate.
std::vector<int> SampledElements(int size_px) {
  std::vector<int> elements;
  const int count = std::min(kSamples, size_px);
  for (int i = 0; i < count; ++i) elements.push_back((2 * i + 1) * size_px / (2 * count));
  return elements;
}

}  // namespace

std::vector<ImageShare> SharesOf(const ImageIndex& index, const Package& package, FrameId frame,
                                 LensWeights kind, ThreadPool& pool) {
  SelectOptions select;
  select.max_angle_rad = package.choices.max_angle_rad;
  const std::vector<FrameLens> lenses = LensesOfFrame(index, package, frame, kind, select, pool);
  const std::vector<LfImageId> ids = TakenImages(index, package, lenses, select, pool);
  const Intrinsics& plate = lenses.front().camera().pinhole.intrinsics;
  const std::vector<int> columns = SampledElements(plate.width_px);
  const std::vector<int> rows = SampledElements(plate.height_px);
  const size_t count = columns.size() * rows.size();
  const SampledWeights sampled(lenses, columns, rows);
  std::vector<double> weights(ids.size() * count);  // [LF image][element]
  pool.ForEach(ids.size(),
               [&](size_t i) { sampled.Of(ids[i], std::span(weights).subspan(i * count, count)); });
  std::vector<double> sums(count);
  for (size_t i = 0; i < weights.size(); ++i) sums[i % count] += weights[i];
  std::vector<ImageShare> shares;
  for (size_t i = 0; i < ids.size(); ++i) {
    ImageShare of_image{ids[i]};
    for (size_t element = 0; element < count; ++element) {
      const double weight = weights[i * count + element];
      if (weight == 0) continue;
      const double share = weight / sums[element];
      of_image.share += share / static_cast<double>(count);
      of_image.squared += share * share / static_cast<double>(count);
    }
    if (of_image.share > 0) shares.push_back(of_image);
  }
  return shares;
}

}  // namespace lf
