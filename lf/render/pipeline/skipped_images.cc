// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/skipped_images.h"

#include <algorithm>
#include <string_view>
#include <unordered_set>

#include "lf/selection/ideal_cells.h"

namespace lf {
namespace {

bool Takes(const FrameTakes& frame, const ImageIndex& index, LfImageId id) {
  const uint32_t rank = index.RankOf(id);
  if (!frame.ranks.Holds(rank) || (frame.shard && !frame.shard->Holds(rank))) return false;
  const PinholeCamera camera = index.light_field().Camera(id);
  std::vector<IdealCell> cells;
  if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
  const auto sees = [&](const RenderCamera& lens) {
    return !ContributingRect(camera, lens, cells, frame.reach).empty();
  };
  return std::any_of(frame.lenses.begin(), frame.lenses.end(),
                     [&](const FrameLens* lens) {
                       return !lens->WeightsOf(id).are_none() && sees(lens->camera());
                     }) ||
         std::any_of(frame.gaps.begin(), frame.gaps.end(), [&](const GapLens* gap) {
           return gap->exists() && gap->Takes(id) && sees(gap->CameraOf(id));
         });
}

}  // namespace

std::vector<std::string> SkippedOf(std::span<const SkippedImage> skipped, const ImageIndex& index,
                                   const FrameTakes& frame) {
  std::vector<std::string> names;
  if (skipped.empty()) return names;
  std::unordered_set<std::string_view> known;
  for (const SkippedImage& image : skipped) known.insert(image.name);
  const LightField& light_field = index.light_field();
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (known.contains(light_field.image_names[i]) && Takes(frame, index, LfImageId{i}))
      names.push_back(light_field.image_names[i]);
  return names;
}

}  // namespace lf
