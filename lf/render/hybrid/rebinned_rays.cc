// SPDX-License-Identifier: Apache-2.0
#include "lf/render/hybrid/rebinned_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "lf/core/check.h"
#include "lf/render/collect/collect.h"
#include "lf/selection/ideal_cells.h"
#include "lf/selection/overlap.h"

namespace lf {
namespace {

// Approximate largest number of LF pixels whose rays are computed before these rays are inserted
// into the map. A ray that waits to be inserted takes 16 bytes.
constexpr long long kPixelsAtOnce = 4 << 20;
// If all rays are kept, LF images are divided into strips of this number of rows, which limits the
// number of rays that wait to be inserted.
constexpr int kStripRows = 64;
// At most kEstimatedFrom LF images are used to estimate the number of rays that the frames of a
// section need. All rays are kept if no section's estimate exceeds kFitShare times
// max_cells_per_section_.
constexpr size_t kEstimatedFrom = 256;
constexpr double kFitShare = 0.9;
// Number of cells expected for each estimated ray: kRoom if all rays are kept, kRoomByEdges if only
// rays at edges are kept.
constexpr double kRoom = 1.1, kRoomByEdges = 0.15;

bool Covers(const CoverageMap& map, const Slab& slab, CellKey cell) {
  return map.Covers(MiddleOf(slab, cell));
}

}  // namespace

// Consecutive frames of asking_ that share a slab, and their rays.
struct RebinnedRays::Section {
  SlabSection plan;        // begin and end are indices of asking_
  CoverageMap in_the_end;  // covers the rays that finished frames need
  CoverageMap previews;    // covers the rays that previews of the current phase need
  Expected expected;
  std::unique_ptr<RayMap> map;
  uint32_t phase = 0;
  uint32_t ranks_done = 0;
  // The cells of the map, cached; unset if the map has changed since.
  std::optional<std::vector<BinnedCell>> cells = {};
};

RebinnedRays::RebinnedRays(const ImageIndex& index, const FilmSlabs& slabs,
                           std::vector<RebinnedFrame> frames, bool collects,
                           const SelectOptions& select, const RebinSettings& options,
                           ThreadPool& pool)
    : light_field_(index.light_field()),
      frames_(std::move(frames)),
      select_(select),
      options_(options),
      pool_(pool),
      stored_values_(StoredValueTable(light_field_.encoding)) {
  for (const RebinnedFrame& frame : frames_) {
    const AskedPixels asked(frame.gaps, collects, options_.previews);
    const std::optional<size_t> slab = slabs.SlabOf(frame.id);
    if (asked.AsksForAny() && slab) asking_.push_back({&frame, *slab, asked});
  }
  MakeSections(slabs);
  MakeMaps(index);
  for (const auto& section : sections_) Begin(0, *section);
}

// Makes a section of each group of consecutive frames of asking_ with the same slab. The bounds of
// a section (SlabSection::bounds) contain only the rays of its frames in this pass, so that
// coverage maps are not coarser than necessary.
void RebinnedRays::MakeSections(const FilmSlabs& slabs) {
  for (size_t begin = 0; begin < asking_.size();) {
    const size_t slab = asking_[begin].slab;
    std::vector<FrameQueries> queries;
    size_t end = begin;
    for (; end < asking_.size() && asking_[end].slab == slab; ++end)
      queries.push_back(asking_[end].frame->gaps.QueriesAt(LensGaps::kInTheEnd));
    auto section = std::make_unique<Section>();
    section->plan = slabs.section(slab);
    section->plan.begin = begin;
    section->plan.end = end;
    if (const std::optional<SlabBounds> bounds = BoundsOf(section->plan.slab, queries))
      section->plan.bounds = *bounds;
    section->in_the_end = CoverageMap(section->plan, queries, options_.coverage, pool_);
    sections_.push_back(std::move(section));
    begin = end;
  }
}

RebinnedRays::~RebinnedRays() = default;

// Estimates the number of rays that finished frames need: finds, for some LF images spread over the
// order, the share of their pixels that Section::in_the_end covers. Then decides which rays are
// kept, and makes the maps.
void RebinnedRays::MakeMaps(const ImageIndex& index) {
  std::vector<RenderCamera> reached;
  for (const AskingFrame& asking : asking_) reached.push_back(asking.asked.camera());
  const std::vector<SelectedImage> images = SelectImages(index, reached, select_, pool_);
  const size_t step = 1 + images.size() / kEstimatedFrom;
  const size_t asked = (images.size() + step - 1) / step;
  std::vector<double> totals;  // estimated rays of each section
  for (const auto& section : sections_) {
    std::vector<double> rays(asked);
    pool_.ForEach(asked, [&](size_t i) {
      const SelectedImage& image = images[i * step];
      rays[i] = static_cast<double>(image.rect.pixel_count()) *
                CoveredShare(section->plan.slab, light_field_.Camera(image.id), image.rect,
                             section->in_the_end);
    });
    totals.push_back(std::accumulate(rays.begin(), rays.end(), 0.0) * static_cast<double>(step));
  }
  const size_t most = std::max<size_t>(1, options_.max_cells / std::max<size_t>(1, totals.size()));
  max_cells_per_section_ = most;
  const double most_asked = totals.empty() ? 0 : *std::max_element(totals.begin(), totals.end());
  keeps_all_ =
      options_.kept == KeptRays::kAll ||
      (options_.kept == KeptRays::kAuto && most_asked <= kFitShare * static_cast<double>(most));
  for (size_t i = 0; i < sections_.size(); ++i) {
    Section& section = *sections_[i];
    section.expected.pixel_count = totals[i];
    section.expected.allocated_cells =
        static_cast<size_t>(totals[i] * (keeps_all_ ? kRoom : kRoomByEdges));
    for (size_t k = section.plan.begin; k < section.plan.end; ++k)
      section.expected.frame_count += asking_[k].asked.asks_in_the_end() ? 1 : 0;
    section.map =
        std::make_unique<RayMap>(most, options_.allocates ? section.expected.allocated_cells : 0);
  }
}

// Begins a phase (PhaseOf()): updates the coverage of previews, and drops the cells that only
// earlier previews needed.
void RebinnedRays::Begin(uint32_t phase, Section& section) {
  section.phase = phase;
  std::vector<FrameQueries> queries;
  for (size_t i = section.plan.begin; i < section.plan.end; ++i)
    if (asking_[i].asked.IsPreviewed(phase))
      queries.push_back(asking_[i].frame->gaps.QueriesAt(phase));
  if (queries.empty() && section.previews.is_empty()) return;
  CoverageOptions coarse = options_.coverage;
  coarse.cells_across = std::max(1, coarse.cells_across / 2);
  section.previews = CoverageMap(section.plan, queries, coarse, pool_);
  section.cells.reset();
  section.map->DropUnless(
      [&section](CellKey cell) {
        return Covers(section.in_the_end, section.plan.slab, cell) ||
               Covers(section.previews, section.plan.slab, cell);
      },
      pool_);
}

uint32_t RebinnedRays::ranks_done() const {
  uint32_t least = UINT32_MAX;
  for (const auto& section : sections_) least = std::min(least, section->ranks_done);
  return least;
}
uint32_t RebinnedRays::ranks_done(size_t section) const { return sections_[section]->ranks_done; }
const RayMap& RebinnedRays::map(size_t section) const { return *sections_[section]->map; }
RebinnedRays::Expected RebinnedRays::expected(size_t section) const {
  return sections_[section]->expected;
}

void RebinnedRays::SortCells() {
  for (const auto& section : sections_)
    if (!section->cells) section->cells = section->map->Cells(pool_);
}

void RebinnedRays::Restore(size_t number, RayMap map, uint32_t ranks_done) {
  Section& section = *sections_[number];
  // Restores the coverage of previews that was valid when the last LF image was taken.
  if (ranks_done > 0) Begin(PhaseOf(ranks_done - 1), section);
  *section.map = std::move(map);
  section.ranks_done = ranks_done;
  section.cells.reset();
}

PixelRect RebinnedRays::RectOf(LfImageId id, uint32_t rank, size_t begin, size_t end) const {
  const PinholeCamera camera = light_field_.Camera(id);
  std::vector<IdealCell> cells;
  if (camera.intrinsics.has_distortion()) cells = MakeIdealCells(camera.intrinsics);
  const ImageOverlap overlap(camera, cells, select_.reach);
  PixelRect rect;
  for (size_t i = begin; i < end; ++i)
    rect = Bounds(rect,
                  asking_[i].asked.RectOf(light_field_.cameras[id.value], overlap, rank, select_));
  return rect;
}

PixelRect RebinnedRays::RectOf(LfImageId id, uint32_t rank) const {
  return GrownBy(RectOf(id, rank, 0, asking_.size()), PixelsAround(options_.rebin, true),
                 light_field_.Camera(id).intrinsics);
}

// Returns the entry of asking_ for frames_[frame]; null if the frame needs no rebinned rays or has
// no slab.
const RebinnedRays::AskingFrame* RebinnedRays::Asking(size_t frame) const {
  const auto found = std::find_if(asking_.begin(), asking_.end(), [&](const AskingFrame& asking) {
    return asking.frame == &frames_[frame];
  });
  return found == asking_.end() ? nullptr : &*found;
}

const RenderCamera* RebinnedRays::ReachedCamera(size_t frame) const {
  const AskingFrame* const asking = Asking(frame);
  return asking == nullptr ? nullptr : &asking->asked.camera();
}

void RebinnedRays::Take(std::span<const BatchImage> images, uint32_t rank_end) {
  ideal_pixels_.Keep(light_field_, images,
                     [&](size_t count, const auto& body) { pool_.ForEach(count, body); });
  for (const auto& section : sections_) {
    if (rank_end <= section->ranks_done) continue;
    const auto first = std::find_if(images.begin(), images.end(), [&](const BatchImage& image) {
      return image.rank >= section->ranks_done;
    });
    const auto left = images.subspan(static_cast<size_t>(first - images.begin()));
    section->ranks_done = rank_end;
    if (left.empty()) continue;
    // A batch never extends into the next phase, because CollectOptions::decision_ranks ends
    // batches there.
    const uint32_t phase = PhaseOf(left.front().rank);
    LF_CHECK(PhaseOf(left.back().rank) == phase);
    if (phase != section->phase) Begin(phase, *section);
    Rebin(left, *section);
  }
}

void RebinnedRays::Rebin(std::span<const BatchImage> images, Section& section) {
  if (section.in_the_end.is_empty() && section.previews.is_empty()) return;
  struct Task {
    const BatchImage* image;
    PixelRect rect;
  };
  std::vector<PixelRect> rects(images.size());
  pool_.ForEach(images.size(), [&](size_t i) {
    rects[i] = Intersection(images[i].pixels.rect, RectOf(images[i].id, images[i].rank,
                                                          section.plan.begin, section.plan.end));
  });
  const bool by_edges = !keeps_all_ || !section.previews.is_empty();
  std::vector<Task> tasks;
  for (size_t i = 0; i < images.size(); ++i) {
    if (rects[i].empty()) continue;
    // If rays at edges are kept (for previews, or because not all rays fit), an LF image is not
    // divided into strips, so that its edges are computed only once.
    const int rows = by_edges ? rects[i].y_end : kStripRows;
    for (int y = rects[i].y_begin / rows * rows; y < rects[i].y_end; y += rows)
      tasks.push_back(
          {&images[i], Intersection(rects[i], {rects[i].x_begin, y, rects[i].x_end, y + rows})});
  }
  const RebinCoverage coverage = {keeps_all_ ? &section.in_the_end : nullptr,
                                  {keeps_all_ ? nullptr : &section.in_the_end, &section.previews}};
  std::vector<BinnedRays> rays;
  for (size_t begin = 0; begin < tasks.size();) {
    // If rays that are not at edges are averaged into existing cells, the result depends on which
    // LF images are inserted together. LF images are then inserted one at a time, so that the
    // division into batches makes no difference.
    size_t end = begin;
    for (long long pixels = 0; end < tasks.size() && (pixels == 0 || pixels < kPixelsAtOnce);
         ++end) {
      if (options_.rebin.averages_others && end > begin && tasks[end].image != tasks[begin].image)
        break;
      pixels += tasks[end].rect.pixel_count();
    }
    rays.resize(end - begin);
    pool_.ForEach(rays.size(), [&](size_t i) {
      const ThreadCpuTimer timer;
      const Task& task = tasks[begin + i];
      rays[i].Clear();
      const LfCamera& lf_camera = light_field_.cameras[task.image->id.value];
      RebinImage(section.plan.slab, light_field_.Camera(task.image->id), task.image->id,
                 task.image->pixels, task.rect, stored_values_,
                 ideal_pixels_.Of(lf_camera.intrinsics_index).get(), options_.rebin, &coverage,
                 *section.map, &rays[i]);
      cpu_ns_ += timer.Nanoseconds();
    });
    for (const BinnedRays& of_task : rays) looked_at_ += of_task.looked_at;
    InsertRays(rays, pool_, section.map.get(), &cpu_ns_);
    begin = end;
  }
  section.cells.reset();
}

SplatFrame RebinnedRays::SplatBy(std::span<const FrameRay> rays, const FrameQueries& queries,
                                 const LensPointSets& points, const PointShares* shares) const {
  const Intrinsics& plate = queries.camera.pinhole.intrinsics;
  return options_.is_reference
             ? SplatReference(rays, plate.width_px, plate.height_px, points, queries.kernel, pool_,
                              shares, options_.nearest)
             : Splat(rays, plate.width_px, plate.height_px, points, queries.kernel, pool_, shares);
}

SplatFrame RebinnedRays::SplatOf(const Section& section, const FrameQueries& queries) const {
  const FrameReach reach = ReachOf(queries.kernel, queries.points);
  AskedSquares squares;
  if (queries.shares) squares = queries.shares->Squares(reach.plate_px);
  const LargeVector<FrameRay> rays =
      FrameRaysOf(section.plan.slab, *section.cells, queries.camera, reach, pool_, squares);
  return SplatBy(rays, queries, queries.points, queries.shares ? &*queries.shares : nullptr);
}

// Interpolates a frame, with distances between rays measured on the planes of the slab
// (options_.reparameterise is false). Splats the rays of each lens point separately, and returns
// the mean of these pictures.
SplatFrame RebinnedRays::SplatOfPoints(const Section& section, const FrameQueries& queries) const {
  const Intrinsics& plate = queries.camera.pinhole.intrinsics;
  SplatFrame sum{Image<float>(plate.width_px, plate.height_px, 3),
                 Image<float>(plate.width_px, plate.height_px)};
  const LensPointSets& points = queries.points;
  const size_t count = points.sets[0].size();
  LF_CHECK(points.k == 1);
  for (size_t i = 0; i < count; ++i) {
    LensPointSets point;
    point.sets = {{points.sets[0][i]}};
    point.spreads = {{points.SpreadOf(0, i)}};
    std::optional<PointShares> share;
    if (queries.shares) share = queries.shares->OfPoint(i);
    const LargeVector<FrameRay> rays =
        FrameRaysThrough(points.sets[0][i], section.plan.slab, *section.cells, queries.camera,
                         ReachOf(queries.kernel, point), pool_);
    const SplatFrame splat = SplatBy(rays, queries, point, share ? &*share : nullptr);
    pool_.ForEach(static_cast<size_t>(plate.height_px), [&](size_t row) {
      const int y = static_cast<int>(row);
      for (int x = 0; x < plate.width_px; ++x) {
        const float found = splat.share.at(x, y);
        sum.share.at(x, y) += found / static_cast<float>(count);
        for (int c = 0; c < 3; ++c)
          sum.rgb.at(x, y, c) += found / static_cast<float>(count) * splat.rgb.at(x, y, c);
      }
    });
  }
  for (int y = 0; y < plate.height_px; ++y)
    for (int x = 0; x < plate.width_px; ++x)
      for (int c = 0; c < 3 && sum.share.at(x, y) > 0; ++c)
        sum.rgb.at(x, y, c) /= sum.share.at(x, y);
  return sum;
}

Completion RebinnedRays::Complete(size_t frame, uint32_t rank) {
  const LensGaps& gaps = frames_[frame].gaps;
  const Intrinsics& plate = gaps.camera().pinhole.intrinsics;
  Completion completion{Image<float>(plate.width_px, plate.height_px, 3),
                        Image<float>(plate.width_px, plate.height_px)};
  const AskingFrame* const asking = Asking(frame);
  if (asking == nullptr || !gaps.AsksAt(rank)) return completion;
  const auto number = static_cast<size_t>(asking - asking_.data());
  const auto section = std::find_if(sections_.begin(), sections_.end(),
                                    [number](const auto& one) { return number < one->plan.end; });
  if (!(*section)->cells) (*section)->cells = (*section)->map->Cells(pool_);
  const FrameQueries queries = gaps.QueriesAt(rank);
  SplatFrame splat =
      options_.reparameterise ? SplatOf(**section, queries) : SplatOfPoints(**section, queries);
  completion.rgb = std::move(splat.rgb);
  if (!queries.shares) {
    for (size_t i = 0; i < splat.share.pixels().size(); ++i)
      completion.share.pixels()[i] = splat.share.pixels()[i] > 0 ? 1.0F : 0.0F;
    return completion;
  }
  const PointShares asked = queries.shares->MeansOfSets(queries.points);
  pool_.ForEach(static_cast<size_t>(plate.height_px), [&](size_t row) {
    const int y = static_cast<int>(row), k = queries.points.k;
    for (int x = 0; x < plate.width_px; ++x) {
      float not_collected = 0;
      asked.At(x, y, static_cast<size_t>(y % k) * k + static_cast<size_t>(x % k), 1,
               &not_collected);
      const float interpolated = splat.share.at(x, y);
      if (interpolated > 0)
        completion.share.at(x, y) =
            interpolated / (interpolated + std::max(0.0F, 1 - not_collected));
    }
  });
  return completion;
}

RebinnedRays::Facts RebinnedRays::facts() const {
  Facts facts{sections_.size(), 0,     looked_at_, static_cast<double>(cpu_ns_) * 1e-9,
              keeps_all_,       false, false};
  for (const auto& section : sections_) {
    facts.cell_count += section->map->size();
    facts.is_full = facts.is_full || section->map->limit() < UINT64_MAX;
    facts.is_too_coarse = facts.is_too_coarse || section->map->is_too_coarse();
  }
  return facts;
}

std::vector<std::string> RebinnedRays::Describe() const {
  std::vector<std::string> lines;
  for (const auto& section : sections_) {
    const SlabSection& plan = section->plan;
    const double distance_w =
        (plan.slab.uv.origin_world - plan.slab.st.origin_world).dot(plan.slab.st.Normal());
    lines.push_back(fmt::format(
        "slab {} of {}: {} frames, planes {:.4g} apart, cells {:.3g} wide on the st plane and "
        "{:.3g} on the uv plane (world units), {:.1f} % of the rays in its bounds needed",
        lines.size() + 1, sections_.size(), plan.end - plan.begin, distance_w, plan.slab.r_st_w,
        plan.slab.r_uv_w, 100 * section->in_the_end.share()));
  }
  return lines;
}

}  // namespace lf
