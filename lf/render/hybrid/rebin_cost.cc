// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/rebin_cost.h"

#include <algorithm>
#include <ctime>

#include "lf/rebinning/frame_rays.h"
#include "lf/rebinning/ray_map.h"
#include "lf/render/collect/collect.h"

namespace lf {
namespace {

// Memory of a frame's ray: the cell in order, the ray, and its numbers in one or two tiles.
constexpr size_t kBytesPerRay = sizeof(BinnedCell) + sizeof(FrameRay) + 2 * sizeof(uint32_t);

// Returns the frames that are interpolated for the measurement: up to three, spread over the pass.
std::vector<size_t> MeasuredFrames(const std::vector<size_t>& asking) {
  constexpr size_t kMost = 3;
  std::vector<size_t> frames;
  const size_t count = std::min(kMost, asking.size());
  for (size_t i = 0; i < count; ++i)
    frames.push_back(asking[(2 * i + 1) * asking.size() / (2 * count)]);
  return frames;
}

double CompleteSeconds(RebinnedRays& rays, std::span<const size_t> frames) {
  if (frames.empty()) return 0;
  const double start_s = ProcessCpuSeconds();
  for (const size_t frame : frames) rays.Complete(frame, LensGaps::kInTheEnd);
  return (ProcessCpuSeconds() - start_s) / static_cast<double>(frames.size());
}

}  // namespace

double ProcessCpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

RebinCost CostOf(const RebinSample& sample, std::span<const RebinSection> sections,
                 size_t image_count, size_t max_cells, std::span<const size_t> expected) {
  const double pixels = std::max(1.0, static_cast<double>(sample.pixel_count));
  const double cells = std::max(1.0, static_cast<double>(sample.cell_count));
  RebinCost cost;
  double pixel_count = 0;
  size_t largest = 0;
  for (size_t i = 0; i < sections.size(); ++i) {
    const double kept =
        std::min(static_cast<double>(max_cells), sections[i].pixel_count / pixels * cells);
    const auto kept_count = static_cast<size_t>(kept);
    pixel_count += sections[i].pixel_count;
    cost.cell_count += kept_count;
    cost.map_bytes += RayMap::BytesFor(max_cells, expected[i], kept_count);
    largest = std::max(largest, kept_count);
    if (sections[i].frame_count == 0) continue;
    const double per_cell_s = std::max(0.0, sample.complete_s - sample.empty_s) / cells;
    cost.complete_s += sample.sort_s / cells * kept + static_cast<double>(sections[i].frame_count) *
                                                          (sample.empty_s + per_cell_s * kept);
  }
  cost.pixel_count = static_cast<uint64_t>(pixel_count);
  cost.frame_bytes = largest * kBytesPerRay;
  // The pixels of an LF image are found three times: when it is selected, read, and rebinned.
  constexpr double kFound = 3;
  cost.rebin_s = sample.rebin_s / pixels * pixel_count +
                 kFound * sample.find_s * static_cast<double>(image_count);
  return cost;
}

Result<RebinCost> MeasureRebinning(const ImageIndex& index, const LfImageStore& store,
                                   const FilmSlabs& slabs, std::vector<RebinnedFrame> frames,
                                   bool collects, const SelectOptions& select,
                                   RebinSettings options, const RayReading& reading, double begin_s,
                                   size_t most, ThreadPool& pool) {
  const double start_s = ProcessCpuSeconds();
  std::vector<size_t> asking;  // the frames that need rebinned rays when they are finished
  for (size_t f = 0; f < frames.size(); ++f)
    if (frames[f].gaps.asks_in_the_end()) asking.push_back(f);
  const size_t frame_count = frames.size();
  options.allocates = false;
  RebinnedRays rays(index, slabs, std::move(frames), collects, select, options, pool);
  begin_s += ProcessCpuSeconds() - start_s;

  std::vector<TakingFrame> taking;
  for (size_t f = 0; f < frame_count; ++f)
    if (const RenderCamera* const reached = rays.ReachedCamera(f)) taking.push_back({*reached});
  std::vector<SelectedImage> images = SelectImages(index, taking, select, pool);
  std::vector<SelectedImage> used;
  const double find_start_s = ProcessCpuSeconds();
  size_t found = 0;
  for (SelectedImage& image : images) {
    if (used.size() == most) break;
    ++found;
    if (rays.RectOf(image.id, image.rank).empty() || !store.IsThere(image.id)) continue;
    image.rect = {};  // none of its pixels is collected
    used.push_back(image);
  }
  RebinSample sample;
  sample.find_s =
      (ProcessCpuSeconds() - find_start_s) / static_cast<double>(std::max<size_t>(1, found));
  const std::vector<size_t> measured = MeasuredFrames(asking);
  CompleteSeconds(rays, measured);  // the first call also asks the system for memory
  sample.empty_s = CompleteSeconds(rays, measured);

  CollectOptions collect;
  collect.reading = reading;
  collect.rank_end = index.rank_end();
  collect.decision_ranks = kDecisionRanks;
  collect.consumer = &rays;
  if (!used.empty()) {
    LF_RETURN_IF_ERROR(Collect(index.light_field(), store, {}, used, collect, pool, nullptr));
  }
  const RebinnedRays::Facts facts = rays.facts();
  sample.pixel_count = facts.looked_at;
  sample.cell_count = facts.cell_count;
  sample.rebin_s = facts.cpu_s;
  const double sort_start_s = ProcessCpuSeconds();
  rays.SortCells();
  sample.sort_s = ProcessCpuSeconds() - sort_start_s;
  sample.complete_s = CompleteSeconds(rays, measured);

  std::vector<RebinSection> sections;
  std::vector<size_t> expected;
  for (size_t i = 0; i < rays.section_count(); ++i) {
    const RebinnedRays::Expected of_section = rays.expected(i);
    sections.push_back({of_section.frame_count, of_section.pixel_count});
    expected.push_back(of_section.allocated_cells);
  }
  RebinCost cost = CostOf(sample, sections, images.size(), rays.max_cells_per_section(), expected);
  cost.begin_s = begin_s;
  return cost;
}

}  // namespace lf
