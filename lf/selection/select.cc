#include "lf/selection/select.h"

#include <algorithm>

#include "lf/core/random.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

constexpr uint64_t kShuffleStream = 1;
constexpr size_t kCamerasPerTask = 64;

// The cells of the LF camera looked at last: neighbours mostly share their intrinsics.
class CellsOfLast {
 public:
  const std::vector<IdealCell>& Of(const LightField& light_field, LfImageId id) {
    const uint32_t index = light_field.cameras[id.value].intrinsics_index;
    if (index == index_) return cells_;
    index_ = index;
    const Intrinsics& k = light_field.intrinsics[index];
    cells_ = k.has_distortion() ? MakeIdealCells(k) : std::vector<IdealCell>();
    return cells_;
  }

 private:
  uint32_t index_ = UINT32_MAX;
  std::vector<IdealCell> cells_;
};

SelectedImage Examine(const LightField& light_field, std::span<const RenderCamera> frames,
                      LfImageId id, std::span<const IdealCell> cells, PixelReach reach) {
  const PinholeCamera camera = light_field.Camera(id);
  SelectedImage image;
  image.id = id;
  for (const RenderCamera& frame : frames) {
    const PixelRect rect = ContributingRect(camera, frame, cells, reach);
    if (rect.empty()) continue;
    image.rect = Bounds(image.rect, rect);
    image.frame_count += 1;
    image.ray_count += static_cast<uint64_t>(rect.pixel_count());
  }
  return image;
}

void Shuffle(std::vector<SelectedImage>* images, uint64_t seed) {
  const auto key = [seed](LfImageId id) { return RandomBits(seed, kShuffleStream, id.value); };
  std::sort(images->begin(), images->end(), [&](const SelectedImage& a, const SelectedImage& b) {
    const uint64_t key_a = key(a.id), key_b = key(b.id);
    return key_a != key_b ? key_a < key_b : a.id < b.id;
  });
}

}  // namespace

std::vector<SelectedImage> SelectImages(const LightField& light_field,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool) {
  const size_t camera_count = light_field.size();
  const size_t task_count = (camera_count + kCamerasPerTask - 1) / kCamerasPerTask;
  std::vector<std::vector<SelectedImage>> found(task_count);
  pool.ForEach(task_count, [&](size_t task) {
    const size_t end = std::min(camera_count, (task + 1) * kCamerasPerTask);
    CellsOfLast cells;
    for (size_t i = task * kCamerasPerTask; i < end; ++i) {
      const LfImageId id{static_cast<uint32_t>(i)};
      const SelectedImage image =
          Examine(light_field, frames, id, cells.Of(light_field, id), options.reach);
      if (image.frame_count > 0) found[task].push_back(image);
    }
  });
  std::vector<SelectedImage> images;
  for (const std::vector<SelectedImage>& part : found)
    images.insert(images.end(), part.begin(), part.end());
  Shuffle(&images, options.seed);
  if (options.max_image_count && images.size() > *options.max_image_count)
    images.resize(*options.max_image_count);
  return images;
}

}  // namespace lf
