#include "lf/rebinning/rebin_image.h"

#include <algorithm>

#include "lf/core/check.h"
#include "lf/core/random.h"

namespace lf {
namespace {

// Sixteen random bits for every pixel of an LF image, four pixels at a time.
class PixelChances {
 public:
  PixelChances(uint64_t seed, LfImageId id) : stream_(MixBits(MixBits(seed) ^ id.value)) {}

  // The columns [begin, end) whose number is below their p, which is in 1 / 65535: that is certain.
  //   first  number of the pixel in column 0
  void Choose(uint64_t first, const uint16_t* p, int begin, int end, std::vector<int>* chosen) {
    chosen->resize(end - begin);
    size_t count = 0;
    for (int x = begin; x < end;) {
      const uint64_t pixel = first + x;
      uint64_t bits = MixBits(stream_ ^ (pixel / 4)) >> (16 * (pixel % 4));
      for (const int stop = std::min(end, x + 4 - static_cast<int>(pixel % 4)); x < stop; ++x) {
        // Written always, counted where it holds: no branch has to be foreseen.
        (*chosen)[count] = x;
        count += (bits & 0xffff) * 65535 >> 16 < p[x] ? 1 : 0;
        bits >>= 16;
      }
    }
    chosen->resize(count);
  }

 private:
  uint64_t stream_;
};

// Where all neighbours are there.
std::array<uint16_t, 3> RgbInside(const LfPixels& pixels, int x, int y) {
  const int own = BayerChannel(pixels.bayer, x, y);
  const auto stride = static_cast<std::ptrdiff_t>(pixels.radiance.width());
  const uint16_t* const v =
      pixels.radiance.row(y - pixels.rect.y_begin) + (x - pixels.rect.x_begin);
  const auto two = [](uint32_t a, uint32_t b) { return static_cast<uint16_t>((a + b + 1) / 2); };
  const auto four = [](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    return static_cast<uint16_t>((a + b + c + d + 2) / 4);
  };
  std::array<uint16_t, 3> rgb{};
  rgb[own] = v[0];
  if (own == 1) {
    const int beside = BayerChannel(pixels.bayer, x + 1, y);
    rgb[beside] = two(v[-1], v[1]);
    rgb[2 - beside] = two(v[-stride], v[stride]);
  } else {
    rgb[1] = four(v[-1], v[1], v[-stride], v[stride]);
    rgb[2 - own] = four(v[-stride - 1], v[-stride + 1], v[stride - 1], v[stride + 1]);
  }
  return rgb;
}

std::array<uint16_t, 3> RgbOfMosaic(const LfPixels& pixels, int x, int y) {
  const PixelRect& rect = pixels.rect;
  if (!pixels.any_masked && x > rect.x_begin && x + 1 < rect.x_end && y > rect.y_begin &&
      y + 1 < rect.y_end)
    return RgbInside(pixels, x, y);
  const int own = BayerChannel(pixels.bayer, x, y);
  std::array<uint32_t, 3> sums{}, counts{};
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      if (!pixels.rect.Contains(x + dx, y + dy)) continue;
      const int column = x + dx - pixels.rect.x_begin, row = y + dy - pixels.rect.y_begin;
      const int channel = BayerChannel(pixels.bayer, x + dx, y + dy);
      if ((channel == own && (dx != 0 || dy != 0)) || pixels.IsMasked(column, row)) continue;
      sums[channel] += pixels.radiance.at(column, row);
      ++counts[channel];
    }
  std::array<uint16_t, 3> rgb{};
  for (int c = 0; c < 3; ++c) {
    // At a border without such a neighbour: what was recorded, as if it were grey.
    const int from = counts[c] > 0 ? c : own;
    rgb[c] = static_cast<uint16_t>((sums[from] + counts[from] / 2) / counts[from]);
  }
  return rgb;
}

std::array<uint16_t, 3> RgbOf(const LfPixels& pixels, int x, int y) {
  if (pixels.bayer != BayerPattern::kNone) return RgbOfMosaic(pixels, x, y);
  const uint16_t* const v = pixels.radiance.row(y - pixels.rect.y_begin) +
                            static_cast<size_t>(x - pixels.rect.x_begin) * LfPixels::kRgbLanes;
  return {v[0], v[1], v[2]};
}

// The pixels of one LF image, row by row.
class ImageRebinner {
 public:
  ImageRebinner(const Slab& slab, const PinholeCamera& lf_camera, LfImageId id,
                const LfPixels& pixels, const RebinOptions& options, const RayMap& map,
                BinnedRays* rays)
      : forms_(MakeCellForms(slab, lf_camera)),
        pixels_(pixels),
        width_px_(lf_camera.intrinsics.width_px),
        chances_(options.seed, id),
        averages_others_(options.averages_others),
        map_(map),
        rays_(*rays) {}

  // Of columns [begin, end).  position(x): the ideal one of the pixel.
  template <class Position>
  void Row(const Image<uint16_t>& p, int y, int begin, int end, const Position& position) {
    const uint16_t* const of_row = p.row(y - pixels_.rect.y_begin) - pixels_.rect.x_begin;
    chances_.Choose(static_cast<uint64_t>(y) * width_px_, of_row, begin, end, &chosen_);
    for (const int x : chosen_) Add(x, y, position(x), &rays_.kept);
    rays_.looked_at += end - begin;
    if (!averages_others_) return;
    auto next = chosen_.begin();
    for (int x = begin; x < end; ++x) {
      if (next != chosen_.end() && *next == x)
        ++next;
      else if (!IsMasked(x, y))
        Add(x, y, position(x), &rays_.others);
    }
  }

  // The same, all of them.
  template <class Position>
  void WholeRow(int y, int begin, int end, const Position& position) {
    for (int x = begin; x < end; ++x)
      if (!IsMasked(x, y)) Add(x, y, position(x), &rays_.kept);
    rays_.looked_at += end - begin;
  }

 private:
  using Shards = std::array<std::vector<BinnedRay>, RayMap::kShards>;

  bool IsMasked(int x, int y) const {
    return pixels_.any_masked &&
           pixels_.IsMasked(x - pixels_.rect.x_begin, y - pixels_.rect.y_begin);
  }

  void Add(int x, int y, const Vec3& position, Shards* shards) {
    const std::optional<SlabPoint> cells = Parameterize(forms_, position);
    const std::optional<CellKey> key = cells ? KeyOf(*cells) : std::nullopt;
    if (key && map_.MayHold(*key))
      (*shards)[RayMap::ShardOf(*key)].push_back({*key, RgbOf(pixels_, x, y)});
  }

  const SlabForms forms_;
  const LfPixels& pixels_;
  const int width_px_;
  PixelChances chances_;
  std::vector<int> chosen_;
  const bool averages_others_;
  const RayMap& map_;
  BinnedRays& rays_;
};

// Pixels of some rows that are covered alike.
struct PixelRun {
  PixelRect rect;
  bool is_whole = false;
};

// The squares of an LF image that are covered, those side by side as one run. Squares begin at
// multiples of their side, so that the same pixels are covered whatever part of the image is there.
class CoveredRuns {
 public:
  //   coverage  null: all is kept by edges
  CoveredRuns(const Slab& slab, const PinholeCamera& lf_camera, const RebinCoverage* coverage)
      : forms_(MakeSlabForms(slab, lf_camera)), coverage_(coverage) {}

  //   position(x, y)  the ideal one of a place in the rectangle
  template <class Position>
  void Find(const PixelRect& rect, const Position& position, std::vector<PixelRun>* runs) const {
    if (coverage_ == nullptr && !rect.empty()) runs->push_back({rect, false});
    if (coverage_ == nullptr) return;
    constexpr int kBlock = RebinCoverage::kBlock;
    for (int y = rect.y_begin / kBlock * kBlock; y < rect.y_end; y += kBlock) {
      bool continues = false;  // the run before
      for (int x = rect.x_begin / kBlock * kBlock; x < rect.x_end; x += kBlock) {
        const PixelRect block = Intersection({x, y, x + kBlock, y + kBlock}, rect);
        const std::optional<SlabPoint> point =
            Parameterize(forms_, position(x + 0.5 * kBlock, y + 0.5 * kBlock));
        const auto is_in = [&](const CoverageMap* map) {
          return point && map != nullptr && map->Covers(*point);
        };
        const bool is_whole = is_in(coverage_->whole);
        const bool is_covered =
            is_whole || is_in(coverage_->by_edges[0]) || is_in(coverage_->by_edges[1]);
        if (is_covered && continues && runs->back().is_whole == is_whole)
          runs->back().rect.x_end = block.x_end;
        else if (is_covered)
          runs->push_back({block, is_whole});
        continues = is_covered;
      }
    }
  }

 private:
  const SlabForms forms_;
  const RebinCoverage* coverage_;
};

}  // namespace

void BinnedRays::Clear() {
  for (auto& shard : kept) shard.clear();
  for (auto& shard : others) shard.clear();
  looked_at = 0;
}

void RebinImage(const Slab& slab, const PinholeCamera& lf_camera, LfImageId id,
                const LfPixels& pixels, const PixelRect& rect,
                const std::vector<uint16_t>& stored_values, const IdealPixels* ideal_pixels,
                const RebinOptions& options, const RebinCoverage* coverage, const RayMap& map,
                BinnedRays* rays) {
  LF_CHECK(Intersection(rect, pixels.rect) == rect || rect.empty());
  LF_CHECK((ideal_pixels != nullptr) == lf_camera.intrinsics.has_distortion());
  if (rect.empty()) return;
  static thread_local std::vector<PixelRun> runs;
  runs.clear();
  const CoveredRuns covered(slab, lf_camera, coverage);
  if (ideal_pixels == nullptr)
    covered.Find(
        rect, [](double x, double y) { return Vec3(x, y, 1); }, &runs);
  else
    for (const IdealPatch& patch : ideal_pixels->patches())
      covered.Find(
          Intersection(patch.rect, rect),
          [&patch](double x, double y) {
            const PixelRect& all = patch.rect;
            return patch.ArcAt(std::clamp((y - all.y_begin) / all.height(), 0.0, 1.0))
                .At(std::clamp((x - all.x_begin) / all.width(), 0.0, 1.0));
          },
          &runs);
  if (runs.empty()) return;
  static thread_local Image<uint16_t> p;
  if (std::any_of(runs.begin(), runs.end(), [](const PixelRun& run) { return !run.is_whole; }))
    ProbabilityMap(pixels, stored_values, options.probability, &p);
  ImageRebinner rebinner(slab, lf_camera, id, pixels, options, map, rays);
  const auto add = [&](const PixelRun& run, int y, const auto& position) {
    if (run.is_whole)
      rebinner.WholeRow(y, run.rect.x_begin, run.rect.x_end, position);
    else
      rebinner.Row(p, y, run.rect.x_begin, run.rect.x_end, position);
  };
  if (ideal_pixels == nullptr) {
    for (const PixelRun& run : runs)
      for (int y = run.rect.y_begin; y < run.rect.y_end; ++y)
        add(run, y, [y](int x) { return Vec3(x + 0.5, y + 0.5, 1); });
    return;
  }
  for (const IdealPatch& patch : ideal_pixels->patches())
    for (const PixelRun& run : runs) {
      if (Intersection(run.rect, patch.rect).empty()) continue;
      for (int y = run.rect.y_begin; y < run.rect.y_end; ++y) {
        const IdealArc arc = patch.Scanline(y);
        add(run, y, [&arc](int x) { return arc.At(arc.Parameter(x)); });
      }
    }
}

double CoveredShare(const Slab& slab, const PinholeCamera& lf_camera, const PixelRect& rect,
                    const CoverageMap& map) {
  if (rect.empty()) return 0;
  std::vector<PixelRun> runs;
  PinholeCamera ideal = lf_camera;
  ideal.intrinsics.distortion = {};
  const RebinCoverage coverage = {&map, {}};
  CoveredRuns(slab, ideal, &coverage)
      .Find(
          rect, [](double x, double y) { return Vec3(x, y, 1); }, &runs);
  long long covered = 0;
  for (const PixelRun& run : runs) covered += run.rect.pixel_count();
  return static_cast<double>(covered) / static_cast<double>(rect.pixel_count());
}

void InsertRays(const std::vector<BinnedRays>& rays, ThreadPool& pool, RayMap* map,
                std::atomic<int64_t>* cpu_ns) {
  const auto for_each_shard = [&](const auto& add) {
    pool.ForEach(RayMap::kShards, [&](size_t shard) {
      const ThreadCpuTimer timer;
      for (const BinnedRays& of_image : rays) add(shard, of_image);
      if (cpu_ns != nullptr) *cpu_ns += timer.Nanoseconds();
    });
  };
  for_each_shard([&](size_t shard, const BinnedRays& from) { map->Add(shard, from.kept[shard]); });
  map->Trim(pool);
  for_each_shard([&](size_t shard, const BinnedRays& from) {
    if (!from.others[shard].empty()) map->AddToThoseThere(shard, from.others[shard]);
  });
}

}  // namespace lf
