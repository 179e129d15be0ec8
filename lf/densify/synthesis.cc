// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/synthesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "lf/core/check.h"
#include "lf/densify/bicubic.h"
#include "lf/densify/source_view.h"
#include "lf/densify/trust.h"

namespace lf {
namespace {

constexpr int kColours = LfPixels::kRayLane, kLanes = LfPixels::kRgbLanes;

// Candidate depths of the pixels of a chunk of a row, the votes for them, and their points in the
// images of the sources.
struct Chunk {
  int x_begin = 0, y = 0, count = 0;
  std::array<int, kChunk> candidates = {};        // number of candidates of each pixel
  std::array<int, kChunk> elected = {};           // number of the elected candidate
  alignas(64) float depth[kMostSources][kChunk];  // [candidate][pixel]
  alignas(64) float votes[kMostSources][kChunk];
  alignas(64) float error[kMostSources][kMostSources][kChunk];  // [candidate][source][pixel]
  SeenPoints seen[kMostSources][kMostSources];
};

class Synthesizer {
 public:
  Synthesizer(const PinholeCamera& camera, std::span<const Source> sources,
              const InverseDepths& range, double tolerance, InterruptFlag interrupted,
              SynthesisMemory* memory)
      : width_(camera.intrinsics.width_px),
        height_(camera.intrinsics.height_px),
        tolerance_(static_cast<float>(tolerance)),
        per_tolerance_(static_cast<float>(1 / tolerance)),
        farthest_(static_cast<float>(range.least)),
        nothing_{sources[0].image->black, sources[0].image->black, sources[0].image->black, 1},
        transparent_(LanesOf(nothing_.data())),
        interrupted_(interrupted),
        candidates_(memory->candidates),
        holes_(memory->holes),
        image_(memory->image) {
    candidates_.resize(sources.size());
    for (size_t s = 0; s < sources.size(); ++s) {
      views_.emplace_back(camera, sources[s], range);
      candidates_[s].Resize(width_, height_, 1);
      views_[s].Project(&candidates_[s], interrupted_);
    }
    Carve();
    FillHoles();
  }

  void Run() {
    image_.light.Resize(width_, height_, kLanes);
    image_.trust.Resize(width_, height_, 1);
    size_t weak = 0, transparent = 0;
    const auto chunk = std::make_unique<Chunk>();
    for (int y = 0; y < height_ && !IsSet(interrupted_); ++y)
      for (int x = 0; x < width_; x += kChunk) {
        chunk->x_begin = x;
        chunk->y = y;
        chunk->count = std::min(kChunk, width_ - x);
        const int most = Vote(chunk.get());
        Show(*chunk, most, &weak, &transparent);
      }
    const double shown = static_cast<double>(width_) * height_ - static_cast<double>(transparent);
    image_.weak_share = static_cast<double>(weak) / std::max(shown, 1.0);
  }

 private:
  bool IsCarved(int x, int y, float depth) const {
    return std::any_of(views_.begin(), views_.end(),
                       [&](const SourceView& view) { return view.SeesNothingAt(x, y, depth); });
  }

  // Removes the candidates at which nothing can be.
  void Carve() {
    if (std::none_of(views_.begin(), views_.end(),
                     [](const SourceView& view) { return view.HasEmpty(); }))
      return;
    for (Image<float>& candidates : candidates_)
      for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
          float& depth = candidates.at(x, y);
          if (depth != kNoDepth && IsCarved(x, y, depth)) depth = kNoDepth;
        }
  }

  // Finds a depth for the pixels without a candidate: step by step, a pixel takes the least inverse
  // depth of the eight pixels around it that have one. Pixels farther than kReach from all
  // candidates take the least of the scene.
  void FillHoles() {
    constexpr int kReach = 24;
    holes_.Resize(width_, height_, 1);
    std::fill(holes_.pixels().begin(), holes_.pixels().end(), kNoDepth);
    std::vector<std::array<int, 2>> open;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        float& depth = holes_.at(x, y);
        for (const Image<float>& candidates : candidates_) {
          const float candidate = candidates.at(x, y);
          if (candidate != kNoDepth && (depth == kNoDepth || candidate < depth)) depth = candidate;
        }
        if (depth == kNoDepth) open.push_back({x, y});
      }
    for (int reach = 1; reach < kReach && !open.empty() && !IsSet(interrupted_); ++reach) {
      std::vector<std::array<int, 2>> still_open;
      std::vector<std::pair<std::array<int, 2>, float>> filled;
      for (const auto& [x, y] : open) {
        float least = kNoDepth;
        for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height_ - 1); ++j)
          for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
            const float depth = holes_.at(i, j);
            if (depth != kNoDepth && (least == kNoDepth || depth < least)) least = depth;
          }
        if (least == kNoDepth)
          still_open.push_back({x, y});
        else
          filled.push_back({{x, y}, least});
      }
      for (const auto& [at, depth] : filled) holes_.at(at[0], at[1]) = depth;
      open = std::move(still_open);
    }
    for (const auto& [x, y] : open) holes_.at(x, y) = farthest_;
  }

  // Finds the candidates of a chunk's pixels: the depths of all sources, but for those that are
  // nearly that of a source before. A pixel without candidate gets the depth around it. Returns the
  // largest number of candidates of a pixel, or 1.
  int FindCandidates(Chunk* chunk) const {
    // Candidates this near to each other, in tolerances, are one.
    constexpr float kSame = 0.5f;
    const float same = kSame * tolerance_;
    const auto count = static_cast<size_t>(chunk->count);
    int most = 0;
    chunk->candidates.fill(0);
    for (const Image<float>& candidates : candidates_) {
      const float* depths = candidates.row(chunk->y) + chunk->x_begin;
      for (size_t i = 0; i < count; ++i) {
        if (depths[i] == kNoDepth) continue;
        bool is_known = false;
        for (int k = 0; k < chunk->candidates[i]; ++k)
          is_known |= std::abs(chunk->depth[k][i] - depths[i]) < same;
        if (is_known) continue;
        chunk->depth[chunk->candidates[i]++][i] = depths[i];
        most = std::max(most, chunk->candidates[i]);
      }
    }
    for (size_t i = 0; i < count; ++i)
      if (chunk->candidates[i] == 0)
        chunk->depth[0][i] = holes_.at(chunk->x_begin + static_cast<int>(i), chunk->y);
    return std::max(most, 1);
  }

  // Finds the candidates of a chunk's pixels, the votes for them, and the elected ones. Returns the
  // largest number of candidates of a pixel, or 1.
  int Vote(Chunk* chunk) const {
    constexpr float kNearer = 0.02f;  // lead that a farther candidate needs, and a nearer one lacks
    const int most = FindCandidates(chunk);
    const auto count = static_cast<size_t>(chunk->count);
    chunk->elected.fill(0);
    for (int k = 0; k < most; ++k) {
      // Pixels with fewer candidates are computed as well, with any depth.
      for (size_t i = 0; k > 0 && i < count; ++i)
        if (k >= chunk->candidates[i]) chunk->depth[k][i] = chunk->depth[0][i];
      std::fill(chunk->votes[k], chunk->votes[k] + count, 0.0f);
      for (size_t s = 0; s < views_.size(); ++s)
        views_[s].See(chunk->x_begin, chunk->y, chunk->count, chunk->depth[k], per_tolerance_,
                      &chunk->seen[k][s], chunk->error[k][s], chunk->votes[k]);
      for (size_t i = 0; i < count; ++i) {
        if (k >= chunk->candidates[i]) continue;
        const int best = chunk->elected[i];
        const bool is_nearer = chunk->depth[k][i] > chunk->depth[best][i];
        if (chunk->votes[k][i] > chunk->votes[best][i] + (is_nearer ? -kNearer : kNearer))
          chunk->elected[i] = k;
      }
    }
    for (size_t i = 0; i < count; ++i)
      if (chunk->candidates[i] == 0) chunk->votes[0][i] = 0;
    return most;
  }

  // Writes the pixels of a chunk, and counts those on whose depth few sources agree, and those that
  // are transparent.
  void Show(const Chunk& chunk, int most, size_t* weak, size_t* transparent) {
    constexpr float kWeak = 0.4f;
    const auto count = static_cast<size_t>(chunk.count);
    std::array<Mixture, kChunk> mixtures;
    for (int k = 0; k < most; ++k) Mix(chunk, k, &mixtures);
    for (size_t i = 0; i < count; ++i) {
      const int x = chunk.x_begin + static_cast<int>(i), y = chunk.y;
      uint16_t* light = &image_.light.at(x, y);
      uint8_t& trust = image_.trust.at(x, y);
      if (chunk.candidates[i] == 0 && IsCarved(x, y, chunk.depth[0][i])) {
        std::copy(nothing_.begin(), nothing_.end(), light);
        trust = LfPixels::kTrusted;
        ++*transparent;
        continue;
      }
      const float votes = chunk.votes[chunk.elected[i]][i];
      if (votes < kWeak) ++*weak;
      trust = Finish(mixtures[i], votes, light);
    }
  }

  // The colours of a pixel's candidates, each times its share.
  struct Mixture {
    PixelLanes colour = {};
    float shares = 0;
    float spread = 0;  // of the colours at the elected depth
  };

  // Adds candidate k of all pixels that have one, unless it has many fewer votes than the elected
  // one.
  void Mix(const Chunk& chunk, int k, std::array<Mixture, kChunk>* mixtures) const {
    constexpr float kClose = 0.6f;  // candidates with so many fewer votes have no part
    std::array<int, kChunk> pixels;
    std::array<float, kChunk> shares;
    size_t count = 0;
    for (int i = 0; i < chunk.count; ++i) {
      const auto at = static_cast<size_t>(i);
      if (k >= std::max(chunk.candidates[at], 1)) continue;
      const float rest = 1 - (chunk.votes[chunk.elected[at]][at] - chunk.votes[k][at]) / kClose;
      if (!(rest > 0)) continue;
      shares[count] = rest * rest * rest;
      pixels[count++] = i;
    }
    if (count == 0) return;
    std::array<PointColours, kMostSources> colours;
    for (size_t s = 0; s < views_.size(); ++s)
      views_[s].Sample(chunk.seen[k][s], {pixels.data(), count}, &colours[s]);
    for (size_t p = 0; p < count; ++p) {
      const auto i = static_cast<size_t>(pixels[p]);
      Mixture& mixture = (*mixtures)[i];
      PixelLanes colour;
      if (!ColourOf(chunk, k, colours, i, &colour,
                    k == chunk.elected[i] ? &mixture.spread : nullptr))
        continue;
      mixture.colour += shares[p] * colour;
      mixture.shares += shares[p];
    }
  }

  // Writes a pixel, 0 if no source shows it. Returns the trust in it.
  uint8_t Finish(const Mixture& mixture, float votes, uint16_t* pixel) const {
    if (!(mixture.shares > 0)) {
      std::fill(pixel, pixel + kLanes, uint16_t{0});
      return 0;
    }
    const PixelLanes lanes = mixture.colour / mixture.shares;
    const float colour[kLanes] = {lanes[0], lanes[1], lanes[2], lanes[3]};
    RoundPixel(colour, nothing_[0], pixel);
    // Transparent parts are known.
    const float opacity = OpacityOfLane(colour[kColours]);
    return static_cast<uint8_t>(opacity * TrustOf(votes, mixture.spread) +
                                (1 - opacity) * LfPixels::kTrusted + 0.5f);
  }

  // Computes the colour of pixel i if it has the depth of candidate k. False if no source shows it.
  //   spread  receives the spread of the colours of the sources that agree on the depth; may be
  //   null
  bool ColourOf(const Chunk& chunk, int k, const std::array<PointColours, kMostSources>& colours,
                size_t i, PixelLanes* result, float* spread) const {
    // The more sources agree on the depth, the less the others count.
    constexpr float kFewVotes = 0.02f;
    // If sources with so much of the weight are opaque, a small error of the depth moved the others
    // to an outline.
    constexpr float kMostly = 0.7f, kNearlyOpaque = 0.99f;
    struct Sampled {
      PixelLanes colour;
      float weight, agreement, opacity;
    };
    std::array<Sampled, kMostSources> sampled;
    size_t count = 0;
    float opaque = 0, whole = 0;
    for (size_t s = 0; s < views_.size(); ++s) {
      if (!colours[s].is_shown[i]) continue;
      Sampled& sample = sampled[count++];
      std::memcpy(&sample.colour, colours[s].lanes[i], sizeof(sample.colour));
      sample.weight = views_[s].weight();
      sample.agreement = AgreementOf(chunk.error[k][s][i]);
      sample.opacity = OpacityOfLane(colours[s].lanes[i][kColours]);
      whole += sample.weight;
      if (sample.opacity > kNearlyOpaque) opaque += sample.weight;
    }
    const bool is_opaque = opaque >= kMostly * whole;
    PixelLanes agreed = {}, all = {};
    float agreed_sum = 0, all_sum = 0;
    std::array<WeighedColour, kMostSources> weighed;
    size_t weighed_count = 0;
    for (const Sampled& sample : std::span(sampled.data(), count)) {
      if (is_opaque && sample.opacity <= kNearlyOpaque) continue;
      const float weight = sample.weight * sample.agreement;
      // The part of the source's pixel that is transparent agrees that nothing is at the place.
      const float through = sample.weight * (1 - sample.agreement) * (1 - sample.opacity);
      agreed += weight * sample.colour;
      if (through > 0) agreed += through * transparent_;
      all += sample.weight * sample.colour;
      weighed[weighed_count++] = {sample.colour, weight};
      agreed_sum += weight + through;
      all_sum += sample.weight;
    }
    if (!(all_sum > 0)) return false;
    if (spread != nullptr) *spread = SpreadOf({weighed.data(), weighed_count});
    const float trust = agreed_sum / (agreed_sum + kFewVotes);
    *result = (1 - trust) / all_sum * all;
    if (agreed_sum > 0) *result += trust / agreed_sum * agreed;
    return true;
  }

  const int width_, height_;
  const float tolerance_, per_tolerance_, farthest_;
  const std::array<uint16_t, kLanes> nothing_;  // a transparent pixel
  const PixelLanes transparent_;                // nothing_, as lanes
  const InterruptFlag interrupted_;
  std::vector<SourceView> views_;
  std::vector<Image<float>>& candidates_;  // [source]
  Image<float>& holes_;  // for pixels without a candidate: a depth from around them
  VirtualImage& image_;
};

}  // namespace

const VirtualImage& Synthesize(const PinholeCamera& camera, std::span<const Source> sources,
                               const InverseDepths& range, double tolerance,
                               InterruptFlag interrupted, SynthesisMemory* memory) {
  LF_CHECK(!sources.empty() && sources.size() <= kMostSources && tolerance > 0);
  Synthesizer(camera, sources, range, tolerance, interrupted, memory).Run();
  return memory->image;
}

VirtualImage Synthesize(const PinholeCamera& camera, std::span<const Source> sources,
                        const InverseDepths& range, double tolerance, InterruptFlag interrupted) {
  SynthesisMemory memory;
  Synthesize(camera, sources, range, tolerance, interrupted, &memory);
  return std::move(memory.image);
}

}  // namespace lf
