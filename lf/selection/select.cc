#include "lf/selection/select.h"

#include <algorithm>
#include <utility>

#include "lf/core/check.h"
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
                      std::span<const PlaceRange> places, LfImageId id, uint32_t place,
                      std::span<const IdealCell> cells, PixelReach reach) {
  const ImageOverlap overlap(light_field.Camera(id), cells, reach);
  SelectedImage image;
  image.id = id;
  image.place = place;
  for (size_t f = 0; f < frames.size(); ++f) {
    if (!places.empty() && !places[f].Holds(place)) continue;
    const PixelRect rect = overlap.Rect(frames[f]);
    if (rect.empty()) continue;
    image.rect = Bounds(image.rect, rect);
    image.frame_count += 1;
    image.ray_count += static_cast<uint64_t>(rect.pixel_count());
  }
  return image;
}

}  // namespace

std::vector<LfImageId> ImageOrder(size_t image_count, uint64_t seed) {
  std::vector<std::pair<uint64_t, LfImageId>> keyed(image_count);
  for (uint32_t i = 0; i < image_count; ++i)
    keyed[i] = {RandomBits(seed, kShuffleStream, i), LfImageId{i}};
  std::sort(keyed.begin(), keyed.end());
  std::vector<LfImageId> order;
  for (const auto& [key, id] : keyed) order.push_back(id);
  return order;
}

std::vector<SelectedImage> SelectImages(const LightField& light_field,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool,
                                        std::span<const PlaceRange> places) {
  LF_CHECK(places.empty() || places.size() == frames.size());
  const size_t camera_count = light_field.size();
  const std::vector<LfImageId> order = ImageOrder(camera_count, options.seed);
  std::vector<uint32_t> place_of(camera_count);
  for (uint32_t place = 0; place < camera_count; ++place) place_of[order[place].value] = place;
  const size_t task_count = (camera_count + kCamerasPerTask - 1) / kCamerasPerTask;
  std::vector<std::vector<SelectedImage>> found(task_count);
  const auto is_interrupted = [&] {
    return options.interrupted != nullptr && *options.interrupted;
  };
  pool.ForEach(task_count, [&](size_t task) {
    if (is_interrupted()) return;
    const size_t end = std::min(camera_count, (task + 1) * kCamerasPerTask);
    CellsOfLast cells;
    for (size_t i = task * kCamerasPerTask; i < end; ++i) {
      const LfImageId id{static_cast<uint32_t>(i)};
      const SelectedImage image = Examine(light_field, frames, places, id, place_of[i],
                                          cells.Of(light_field, id), options.reach);
      if (image.frame_count > 0) found[task].push_back(image);
    }
  });
  std::vector<SelectedImage> images;
  for (const std::vector<SelectedImage>& part : found)
    images.insert(images.end(), part.begin(), part.end());
  std::sort(images.begin(), images.end(),
            [](const SelectedImage& a, const SelectedImage& b) { return a.place < b.place; });
  return images;
}

std::vector<PlaceRange> PlacesOfFirst(size_t image_count, const LightField& light_field,
                                      std::span<const RenderCamera> frames,
                                      const SelectOptions& options, ThreadPool& pool) {
  const std::vector<LfImageId> order = ImageOrder(light_field.size(), options.seed);
  std::vector<PlaceRange> ranges(frames.size());
  // Each frame walks along the order by itself.
  pool.ForEach(frames.size(), [&](size_t f) {
    CellsOfLast cells;
    size_t found = 0;
    for (uint32_t place = 0; place < order.size(); ++place) {
      if (options.interrupted != nullptr && *options.interrupted) return;
      if (found == image_count) {
        ranges[f].end = place;
        return;
      }
      const LfImageId id = order[place];
      const PixelRect rect = ContributingRect(light_field.Camera(id), frames[f],
                                              cells.Of(light_field, id), options.reach);
      found += rect.empty() ? 0 : 1;
    }
  });
  return ranges;
}

}  // namespace lf
