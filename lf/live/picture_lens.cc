// SPDX-License-Identifier: Apache-2.0
#include "lf/live/picture_lens.h"

#include <optional>

#include "lf/collection/gather_sampling.h"

namespace lf {
namespace {

constexpr uint16_t kWeightOne = 256;  // weight 1 at a node

void AddImage(const FrameLens& lens, const LightField& light_field, const RenderCamera& frame,
              LfImageId id, PictureLens* picture) {
  PictureLens::Image image;
  image.index = id.value;
  if (const FrameWeights* weights = lens.weights()) {
    const size_t camera = *lens.IndexOf(id);
    image.blocks = weights->BlocksOf(camera);
    const std::span<const uint16_t> nodes = weights->NodesOf(camera);
    picture->nodes.insert(picture->nodes.end(), nodes.begin(), nodes.end());
  } else {
    picture->nodes.push_back(kWeightOne);
  }
  image.samples = SamplingOf(light_field.Camera(id), frame, PixelFilter::kBilinear).samples;
  picture->images.push_back(image);
}

}  // namespace

size_t UsedCount(const FrameLens& lens, const ImageIndex& index, const SelectOptions& select,
                 ThreadPool& pool) {
  const TakingFrame taking = {lens.camera(), {}, [&](LfImageId id) { return lens.Takes(id); }};
  return SelectImages(index, std::span(&taking, 1), select, pool).size();
}

PictureLens LensOfPicture(const LightField& light_field, const RenderCamera& frame,
                          LensWeights weights, ThreadPool& pool) {
  PictureLens picture;
  const ImageIndex index(light_field);
  SelectOptions select;
  select.reach = PixelReach::kNeighbours;
  const FrameLens lens(index, frame, weights, select, pool);
  picture.opening = lens.camera().aperture;
  picture.used_count = UsedCount(lens, index, select, pool);
  picture.camera_distance_w = lens.camera_distance_w();
  if (const auto facts = lens.facts()) picture.uncovered_share = facts->coverage.uncovered_share;
  if (const FrameWeights* of_lens = lens.weights()) {
    picture.columns = of_lens->columns();
    picture.rows = of_lens->rows();
    picture.has_feather = true;
  }
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (lens.Takes(LfImageId{i})) AddImage(lens, light_field, frame, LfImageId{i}, &picture);
  return picture;
}

}  // namespace lf
