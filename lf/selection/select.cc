// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/select.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lf/core/check.h"
#include "lf/light_field/model/time_slices.h"
#include "lf/selection/overlap.h"
#include "lf/selection/seen_region.h"

namespace lf {
namespace {

// Number of frames that are processed together. It limits the memory: each pair of a frame and a
// leaf of the camera tree that it visits takes 8 bytes.
constexpr size_t kFramesTogether = 64;
constexpr size_t kLeavesPerTask = 4;

// Caches the IdealCells of the last LF camera, because neighbouring LF cameras mostly have the same
// intrinsics.
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

void Prefetch(const LfCamera& camera) {
  constexpr size_t kLineBytes = 64;
  const auto* const bytes = reinterpret_cast<const char*>(&camera);
  for (size_t at = 0; at < sizeof(camera); at += kLineBytes) __builtin_prefetch(bytes + at);
}

PixelRect WholeImage(const Intrinsics& k) { return {0, 0, k.width_px, k.height_px}; }

// A pair of a frame and a leaf of the camera tree whose LF cameras may have rays for the frame.
struct Visit {
  uint32_t leaf;
  uint32_t frame : 31;
  uint32_t all_inside : 1;
};

// Returns the visits (pairs of a frame and a leaf) of all frames, sorted by leaf, then by frame.
std::vector<Visit> VisitsOf(const CameraTree& tree, std::span<const SeenRegion> regions,
                            ThreadPool& pool) {
  std::vector<std::vector<Visit>> of_frames(regions.size());
  pool.ForEach(regions.size(), [&](size_t f) {
    tree.ForEachLeaf(regions[f], [&](size_t leaf, bool all_inside) {
      of_frames[f].push_back(
          {static_cast<uint32_t>(leaf), static_cast<uint32_t>(f), all_inside ? 1U : 0U});
    });
  });
  std::vector<size_t> begin(tree.leaf_count() + 1, 0);
  for (const std::vector<Visit>& visits : of_frames)
    for (const Visit& visit : visits) ++begin[visit.leaf + 1];
  for (size_t leaf = 0; leaf < tree.leaf_count(); ++leaf) begin[leaf + 1] += begin[leaf];
  std::vector<Visit> sorted(begin.back());
  for (const std::vector<Visit>& visits : of_frames)
    for (const Visit& visit : visits) sorted[begin[visit.leaf]++] = visit;
  return sorted;
}

// Selects the LF images of some frames.
class Selector {
 public:
  Selector(const ImageIndex& index, std::span<const TakingFrame> frames,
           const SelectOptions& options)
      : index_(index), frames_(frames), options_(options) {
    for (const TakingFrame& frame : frames) {
      regions_.emplace_back(frame.camera);
      outlines_.emplace_back(frame.camera, options.reach);
      slices_.emplace_back(index.light_field(), frame.camera.recording_time);
    }
  }

  std::vector<Visit> Visits(ThreadPool& pool) const {
    return VisitsOf(index_.tree(), regions_, pool);
  }

  // Appends to `found` the LF images of one leaf that at least one frame takes.
  //   visits  all visits of this leaf
  void Examine(std::span<const Visit> visits, CellsOfLast* cells,
               std::vector<SelectedImage>* found) const {
    const LightField& light_field = index_.light_field();
    const std::span<const LfImageId> ids = index_.tree().Leaf(visits.front().leaf);
    for (size_t i = 0; i < ids.size(); ++i) {
      const LfImageId id = ids[i];
      // The processor cannot foresee the next LF camera, because neighbours in space are scattered
      // in memory.
      if (i + 1 < ids.size()) Prefetch(light_field.cameras[ids[i + 1].value]);
      const LfCamera& lf_camera = light_field.cameras[id.value];
      const PinholeCamera camera = light_field.Camera(id);
      SelectedImage image;
      image.id = id;
      image.rank = index_.RankOf(id);
      std::optional<ImageOverlap> overlap;
      for (const Visit& visit : visits) {
        const size_t f = visit.frame;
        const TakingFrame& frame = frames_[f];
        if (!frame.ranks.Holds(image.rank)) continue;
        if (!slices_[f].Holds(id)) continue;
        if (visit.all_inside == 0 && regions_[f].Misses(camera.CentreWorld())) continue;
        if (!IsWithinAngle(lf_camera, frame.camera, options_)) continue;
        if (frame.takes && !frame.takes(id)) continue;
        PixelRect rect = WholeImage(camera.intrinsics);
        if (!options_.whole_images) {
          if (!overlap) overlap.emplace(camera, cells->Of(light_field, id), options_.reach);
          rect = overlap->Rect(outlines_[f]);
        }
        if (rect.empty()) continue;
        image.rect = Bounds(image.rect, rect);
        image.frame_count += 1;
        image.ray_count += static_cast<uint64_t>(rect.pixel_count());
      }
      if (image.frame_count > 0) found->push_back(image);
    }
  }

 private:
  const ImageIndex& index_;
  std::span<const TakingFrame> frames_;
  const SelectOptions& options_;
  std::vector<SeenRegion> regions_;
  std::vector<FrameOutline> outlines_;
  std::vector<SliceOfFrame> slices_;
};

bool IsInterrupted(const SelectOptions& options) {
  return options.interrupted != nullptr && *options.interrupted;
}

// Returns the index at which the visits of each leaf begin and, as the last entry, the number of
// visits.
std::vector<size_t> LeavesOf(std::span<const Visit> visits) {
  std::vector<size_t> begin;
  for (size_t i = 0; i < visits.size(); ++i)
    if (i == 0 || visits[i].leaf != visits[i - 1].leaf) begin.push_back(i);
  begin.push_back(visits.size());
  return begin;
}

// Sorts by rank in the order, and joins the entries of the same LF image, which were found for
// different frames.
void JoinByRank(std::vector<SelectedImage>* images) {
  std::sort(images->begin(), images->end(),
            [](const SelectedImage& a, const SelectedImage& b) { return a.rank < b.rank; });
  size_t count = 0;
  for (const SelectedImage& image : *images) {
    if (count > 0 && (*images)[count - 1].id == image.id) {
      SelectedImage& joined = (*images)[count - 1];
      joined.rect = Bounds(joined.rect, image.rect);
      joined.frame_count += image.frame_count;
      joined.ray_count += image.ray_count;
    } else {
      (*images)[count++] = image;
    }
  }
  images->resize(count);
}

}  // namespace

bool IsWithinAngle(const LfCamera& lf_camera, const RenderCamera& frame,
                   const SelectOptions& options) {
  if (!options.max_angle_rad) return true;
  const double cosine =
      lf_camera.cam_from_world.rotation.row(2).dot(frame.pinhole.cam_from_world.rotation.row(2));
  return cosine >= std::cos(*options.max_angle_rad);
}

std::vector<SelectedImage> SelectImages(const ImageIndex& index,
                                        std::span<const TakingFrame> frames,
                                        const SelectOptions& options, ThreadPool& pool) {
  std::vector<SelectedImage> images;
  for (size_t first = 0; first < frames.size(); first += kFramesTogether) {
    if (IsInterrupted(options)) break;
    const Selector selector(
        index, frames.subspan(first, std::min(kFramesTogether, frames.size() - first)), options);
    const std::vector<Visit> visits = selector.Visits(pool);
    const std::vector<size_t> begin = LeavesOf(visits);
    const size_t leaf_count = begin.size() - 1;
    std::vector<std::vector<SelectedImage>> found((leaf_count + kLeavesPerTask - 1) /
                                                  kLeavesPerTask);
    pool.ForEach(found.size(), [&](size_t task) {
      CellsOfLast cells;
      const size_t end = std::min(leaf_count, (task + 1) * kLeavesPerTask);
      for (size_t i = task * kLeavesPerTask; i < end && !IsInterrupted(options); ++i)
        selector.Examine(std::span(visits).subspan(begin[i], begin[i + 1] - begin[i]), &cells,
                         &found[task]);
    });
    for (const std::vector<SelectedImage>& part : found)
      images.insert(images.end(), part.begin(), part.end());
  }
  JoinByRank(&images);
  return images;
}

std::vector<SelectedImage> SelectImages(const ImageIndex& index,
                                        std::span<const RenderCamera> frames,
                                        const SelectOptions& options, ThreadPool& pool) {
  std::vector<TakingFrame> taking;
  for (const RenderCamera& frame : frames) taking.push_back({frame});
  return SelectImages(index, taking, options, pool);
}

RankRange RanksOfFirst(size_t image_count, const ImageIndex& index, const TakingFrame& frame,
                       const SelectOptions& options) {
  return RanksOfFirst(image_count, index, std::span(&frame, 1), options);
}

RankRange RanksOfFirst(size_t image_count, const ImageIndex& index,
                       std::span<const TakingFrame> instants, const SelectOptions& options) {
  LF_CHECK(image_count > 0);
  const LightField& light_field = index.light_field();
  struct Candidate {
    uint32_t rank;
    LfImageId id;
    size_t instant;
  };
  std::vector<Candidate> candidates;
  for (size_t i = 0; i < instants.size(); ++i) {
    const SeenRegion region(instants[i].camera);
    const SliceOfFrame slice(light_field, instants[i].camera.recording_time);
    index.tree().ForEachLeaf(region, [&](size_t leaf, bool all_inside) {
      for (const LfImageId id : index.tree().Leaf(leaf))
        if (slice.Holds(id) && (all_inside || !region.Misses(light_field.Camera(id).CentreWorld())))
          candidates.push_back({index.RankOf(id), id, i});
    });
  }
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::pair(a.rank, a.instant) < std::pair(b.rank, b.instant);
  });
  CellsOfLast cells;
  size_t found = 0;
  std::optional<uint32_t> last_found;  // rank of the last LF image that was found
  for (const auto& [rank, id, instant] : candidates) {
    if (IsInterrupted(options)) break;
    if (last_found == rank) continue;
    const TakingFrame& frame = instants[instant];
    if (!IsWithinAngle(light_field.cameras[id.value], frame.camera, options)) continue;
    if (frame.takes && !frame.takes(id)) continue;
    const PixelRect rect = ContributingRect(light_field.Camera(id), frame.camera,
                                            cells.Of(light_field, id), options.reach);
    if (rect.empty()) continue;
    last_found = rank;
    if (++found == image_count) return {0, rank + 1};
  }
  return {};
}

}  // namespace lf
