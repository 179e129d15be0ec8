// SPDX-License-Identifier: Apache-2.0
#include "lf/rebinning/rebin_image.h"

#include <algorithm>

#include "lf/core/check.h"
#include "lf/rebinning/pixel_chances.h"
#include "lf/rebinning/probability_steps.h"

namespace lf {
namespace {

// Computes the colours of pixels of a mosaic whose eight neighbours are all in LfPixels and not
// masked. All pixels take the same steps without a branch, because the processor could not predict
// branches that depend on a pixel's place in the Bayer pattern.
class InnerMosaic {
 public:
  explicit InnerMosaic(const LfPixels& pixels) {
    if (pixels.bayer == BayerPattern::kNone) return;
    const auto stride = static_cast<std::ptrdiff_t>(pixels.radiance.width());
    for (int place = 0; place < 4; ++place) {
      const int x = place % 2, y = place / 2, own = BayerChannel(pixels.bayer, x, y);
      FourOffsets* const of = offsets_[place].data();
      of[own] = {0, 0, 0, 0};
      if (own == 1) {
        const int beside = BayerChannel(pixels.bayer, x + 1, y);
        of[beside] = {-1, -1, 1, 1};
        of[2 - beside] = {-stride, -stride, stride, stride};
      } else {
        of[1] = {-1, 1, -stride, stride};
        of[2 - own] = {-stride - 1, -stride + 1, stride - 1, stride + 1};
      }
    }
  }

  // Each channel is the value of the pixel itself, or the mean of two or four neighbours. It is
  // always computed as the mean of four values, among which a pixel may occur several times.
  std::array<uint16_t, 3> At(const uint16_t* v, int x, int y) const {
    std::array<uint16_t, 3> rgb;
    const std::array<FourOffsets, 3>& of = offsets_[2 * (y & 1) + (x & 1)];
    for (int c = 0; c < 3; ++c) {
      const uint32_t sum = uint32_t{v[of[c][0]]} + v[of[c][1]] + v[of[c][2]] + v[of[c][3]];
      rgb[c] = static_cast<uint16_t>((sum + 2) / 4);
    }
    return rgb;
  }

 private:
  using FourOffsets = std::array<std::ptrdiff_t, 4>;
  std::array<std::array<FourOffsets, 3>, 4> offsets_ = {};  // [place in the pattern][channel]
};

std::array<uint16_t, 3> RgbOfMosaic(const LfPixels& pixels, const InnerMosaic& inner, int x,
                                    int y) {
  const PixelRect& rect = pixels.rect;
  if (!pixels.any_masked && x > rect.x_begin && x + 1 < rect.x_end && y > rect.y_begin &&
      y + 1 < rect.y_end)
    return inner.At(pixels.radiance.row(y - rect.y_begin) + (x - rect.x_begin), x, y);
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
    // If no unmasked neighbour recorded this channel, the pixel counts as grey: its own channel is
    // used.
    const int from = counts[c] > 0 ? c : own;
    rgb[c] = static_cast<uint16_t>((sums[from] + counts[from] / 2) / counts[from]);
  }
  return rgb;
}

// Computes each channel of a pixel as the mean, weighted by a Gaussian, of the pixels around it
// that recorded this channel.
class ColourFilter {
 public:
  explicit ColourFilter(double sigma_px) : taps_(MakeTaps(sigma_px)) {}

  bool is_none() const { return taps_.radius() == 0; }
  int radius() const { return taps_.radius(); }

  std::array<uint16_t, 3> At(const LfPixels& pixels, int x, int y) const {
    const PixelRect around =
        Intersection({x - radius(), y - radius(), x + radius() + 1, y + radius() + 1}, pixels.rect);
    const bool is_mosaic = pixels.bayer != BayerPattern::kNone;
    std::array<uint64_t, 3> sums{}, weights{};
    for (int row = around.y_begin; row < around.y_end; ++row)
      for (int column = around.x_begin; column < around.x_end; ++column) {
        const int i = column - pixels.rect.x_begin, k = row - pixels.rect.y_begin;
        if (pixels.IsMasked(i, k)) continue;
        const uint64_t weight =
            uint64_t{taps_.values[std::abs(column - x)]} * taps_.values[std::abs(row - y)];
        const auto add = [&](int channel, uint16_t value) {
          sums[channel] += weight * value;
          weights[channel] += weight;
        };
        if (is_mosaic)
          add(BayerChannel(pixels.bayer, column, row), pixels.radiance.at(i, k));
        else
          for (int c = 0; c < 3; ++c) add(c, pixels.radiance.at(i, k, c));
      }
    // If no unmasked pixel around recorded this channel, the pixel counts as grey: its own channel
    // is used.
    const int own = is_mosaic ? BayerChannel(pixels.bayer, x, y) : 1;
    std::array<uint16_t, 3> rgb{};
    for (int c = 0; c < 3; ++c) {
      const int from = weights[c] > 0 ? c : own;
      if (weights[from] > 0)
        rgb[c] = static_cast<uint16_t>((sums[from] + weights[from] / 2) / weights[from]);
    }
    return rgb;
  }

 private:
  SmoothingTaps taps_;
};

std::array<uint16_t, 3> RgbOf(const LfPixels& pixels, const InnerMosaic& inner, int x, int y) {
  if (pixels.bayer != BayerPattern::kNone) return RgbOfMosaic(pixels, inner, x, y);
  const uint16_t* const v = pixels.radiance.row(y - pixels.rect.y_begin) +
                            static_cast<size_t>(x - pixels.rect.x_begin) * LfPixels::kRgbLanes;
  return {v[0], v[1], v[2]};
}

// Adds the rays of one LF image to BinnedRays, row by row.
class ImageRebinner {
 public:
  ImageRebinner(const Slab& slab, const PinholeCamera& lf_camera, LfImageId id,
                const LfPixels& pixels, const RebinOptions& options, const RayMap& map,
                BinnedRays* rays)
      : forms_(MakeCellForms(slab, lf_camera)),
        pixels_(pixels),
        inner_(pixels),
        filter_(options.colour_sigma_px),
        width_px_(lf_camera.intrinsics.width_px),
        chances_(options.seed, id),
        averages_others_(options.averages_others),
        map_(map),
        rays_(*rays) {}

  // Chooses rays of columns [begin, end) by their p and adds them to the kept rays. Adds the rays
  // that are not chosen, except those of masked pixels, to the other rays if
  // options.averages_others is true.
  //   p            the probabilities of these columns
  //   position(x)  the ideal position of the pixel
  template <class Position>
  void Row(const uint16_t* p, int y, int begin, int end, const Position& position) {
    chances_.Choose(static_cast<uint64_t>(y) * width_px_ + begin,
                    {p, static_cast<size_t>(end - begin)}, &chosen_);
    for (const uint32_t i : chosen_) {
      const int x = begin + static_cast<int>(i);
      Add(x, y, position(x), &rays_.kept);
    }
    rays_.looked_at += end - begin;
    if (!averages_others_) return;
    auto next = chosen_.begin();
    for (int x = begin; x < end; ++x) {
      if (next != chosen_.end() && begin + static_cast<int>(*next) == x)
        ++next;
      else if (!IsMasked(x, y))
        Add(x, y, position(x), &rays_.others);
    }
  }

  // Adds the rays of all unmasked pixels of columns [begin, end) to the kept rays.
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
      (*shards)[RayMap::ShardOf(*key)].push_back(
          {*key, filter_.is_none() ? RgbOf(pixels_, inner_, x, y) : filter_.At(pixels_, x, y)});
  }

  const SlabForms forms_;
  const LfPixels& pixels_;
  const InnerMosaic inner_;
  const ColourFilter filter_;
  const int width_px_;
  const PixelChances chances_;
  std::vector<uint32_t> chosen_;
  const bool averages_others_;
  const RayMap& map_;
  BinnedRays& rays_;
};

// Number of rows whose probabilities are computed together: the L2 cache holds them and their
// pixels.
constexpr int kBandRows = 64;
static_assert(kBandRows % RebinCoverage::kBlock == 0);

// Pixels within a band of kBandRows rows that are covered by the same kind of map of RebinCoverage:
// `whole` or `by_edges`.
struct PixelRun {
  PixelRect rect;
  bool is_whole;            // true if RebinCoverage::whole covers them
  const IdealPatch* patch;  // the patch with these pixels; null without distortion
};

// Finds the covered squares of an LF image. Neighbouring squares of a row that the same kind of map
// covers form one run. Squares begin at multiples of their side, so that coverage does not depend
// on the part of the image that is read.
class CoveredRuns {
 public:
  //   coverage  null: all pixels are kept with the probability of Eq. 4.4
  CoveredRuns(const Slab& slab, const PinholeCamera& lf_camera, const RebinCoverage* coverage)
      : forms_(MakeSlabForms(slab, lf_camera)), coverage_(coverage) {}

  // Appends the runs of a rectangle.
  //   patch           contains the rectangle; null without lens distortion
  //   position(x, y)  returns the ideal position of the pixel position (x, y)
  template <class Position>
  void Find(const PixelRect& rect, const IdealPatch* patch, const Position& position,
            std::vector<PixelRun>* runs) const {
    if (coverage_ == nullptr) {
      for (int y = rect.y_begin / kBandRows * kBandRows; y < rect.y_end; y += kBandRows)
        runs->push_back(
            {Intersection({rect.x_begin, y, rect.x_end, y + kBandRows}, rect), false, patch});
      return;
    }
    constexpr int kBlock = RebinCoverage::kBlock;
    for (int y = rect.y_begin / kBlock * kBlock; y < rect.y_end; y += kBlock) {
      bool continues = false;  // true if the square to the left is covered
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
          runs->push_back({block, is_whole, patch});
        continues = is_covered;
      }
    }
  }

 private:
  const SlabForms forms_;
  const RebinCoverage* coverage_;
};

}  // namespace

int PixelsAround(const RebinOptions& options, bool is_mosaic) {
  return std::max({PixelsAround(options.probability, is_mosaic),
                   ColourFilter(options.colour_sigma_px).radius(), is_mosaic ? 1 : 0});
}

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
        rect, nullptr, [](double x, double y) { return Vec3(x, y, 1); }, &runs);
  else
    for (const IdealPatch& patch : ideal_pixels->patches())
      covered.Find(
          Intersection(patch.rect, rect), &patch,
          [&patch](double x, double y) {
            const PixelRect& all = patch.rect;
            return patch.ArcAt(std::clamp((y - all.y_begin) / all.height(), 0.0, 1.0))
                .At(std::clamp((x - all.x_begin) / all.width(), 0.0, 1.0));
          },
          &runs);
  const auto band_of = [](const PixelRun& run) { return run.rect.y_begin / kBandRows; };
  std::stable_sort(runs.begin(), runs.end(),
                   [&](const PixelRun& a, const PixelRun& b) { return band_of(a) < band_of(b); });
  ImageRebinner rebinner(slab, lf_camera, id, pixels, options, map, rays);
  for (auto begin = runs.begin(); begin != runs.end();) {
    const auto end = std::find_if(
        begin, runs.end(), [&](const PixelRun& run) { return band_of(run) != band_of(*begin); });
    static thread_local Image<uint16_t> p;
    PixelRect of_p;
    for (auto run = begin; run != end; ++run)
      if (!run->is_whole) of_p = Bounds(of_p, run->rect);
    ProbabilityMap(pixels, of_p, stored_values, options.probability, &p);
    for (; begin != end; ++begin)
      for (int y = begin->rect.y_begin; y < begin->rect.y_end; ++y) {
        const auto add = [&](const auto& position) {
          const int x = begin->rect.x_begin;
          if (begin->is_whole)
            rebinner.WholeRow(y, x, begin->rect.x_end, position);
          else
            rebinner.Row(p.row(y - of_p.y_begin) + (x - of_p.x_begin), y, x, begin->rect.x_end,
                         position);
        };
        if (begin->patch == nullptr) {
          add([y](int x) { return Vec3(x + 0.5, y + 0.5, 1); });
        } else {
          const IdealArc arc = begin->patch->Scanline(y);
          add([&arc](int x) { return arc.At(arc.Parameter(x)); });
        }
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
          rect, nullptr, [](double x, double y) { return Vec3(x, y, 1); }, &runs);
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
