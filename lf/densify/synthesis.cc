// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/synthesis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "lf/core/check.h"
#include "lf/densify/bicubic.h"
#include "lf/densify/pair_map.h"
#include "lf/densify/trust.h"

namespace lf {
namespace {

constexpr int kColours = LfPixels::kRayLane, kLanes = LfPixels::kRgbLanes;
constexpr float kNoDepth = -1e30f;

// Agreement of two inverse depths whose difference is `error` tolerances: 1 if it is 0, 0 from 2
// on. (Tukey's biweight, with its power of a polynomial instead of an exponential function, which
// has other bits on other machines.)
float Agreement(float error) {
  const float left = std::max(0.0f, 1 - 0.25f * error * error);
  return left * left * left;
}

// The pixels of one source, seen from the virtual camera.
class SourceView {
 public:
  SourceView(const PinholeCamera& camera, const Source& source, const InverseDepths& range)
      : source_(source),
        from_source_(MapBetween(source.image->camera, camera)),
        to_source_(MapBetween(camera, source.image->camera)),
        step_(static_cast<float>(range.Step())),
        // The number 1 stands for the least inverse depth.
        first_(static_cast<float>(range.least - range.Step())) {}

  float weight() const { return source_.weight; }

  // Writes the nearest depth that the source shows at each pixel of the virtual image.
  void Project(Image<float>* candidates, InterruptFlag interrupted) const {
    constexpr float kReach = 0.75f;
    const DepthPlane& plane = *source_.plane;
    const int width = candidates->width(), height = candidates->height();
    std::fill(candidates->pixels().begin(), candidates->pixels().end(), kNoDepth);
    for (int y = 0; y < plane.height() && !IsSet(interrupted); ++y)
      for (int x = 0; x < plane.width(); ++x) {
        if (source_.image->light.at(x, y, kColours) == 0 ||
            IsTransparent(&source_.image->tones.at(x, y)))
          continue;
        const float z = DepthAt(x, y);
        const PairMap::Place place =
            from_source_.At(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, z);
        if (!(place.w > 0)) continue;
        const float u = place.u_px - 0.5f, v = place.v_px - 0.5f;
        if (!(u > -1 && v > -1 && u < static_cast<float>(width) && v < static_cast<float>(height)))
          continue;
        const float depth = z / place.w;
        const int left = static_cast<int>(std::floor(u)), top = static_cast<int>(std::floor(v));
        for (int j = top; j <= top + 1; ++j)
          for (int i = left; i <= left + 1; ++i) {
            if (i < 0 || j < 0 || i >= width || j >= height) continue;
            if (std::abs(static_cast<float>(i) - u) > kReach ||
                std::abs(static_cast<float>(j) - v) > kReach)
              continue;
            candidates->at(i, j) = std::max(candidates->at(i, j), depth);
          }
      }
  }

  // A point of the virtual image in the source's image.
  struct Seen {
    bool is_inside = false;
    float u_px = 0, v_px = 0;
    // The source's inverse depth at the place, less that of the point, in tolerances: negative if
    // the source sees through the point.
    float error = 0;
  };
  Seen See(float x, float y, float z, float per_tolerance) const {
    const PairMap::Place place = to_source_.At(x, y, z);
    const DepthPlane& plane = *source_.plane;
    if (!(place.w > 0 && place.u_px >= 0 && place.v_px >= 0 &&
          place.u_px < static_cast<float>(plane.width()) &&
          place.v_px < static_cast<float>(plane.height())))
      return {};
    const std::optional<float> there = DepthSeenAt(place);
    const float error = there ? (*there - z / place.w) * per_tolerance : kSeenThrough;
    return {true, place.u_px, place.v_px, error};
  }
  bool Sample(const Seen& seen, float colour[kLanes]) const {
    return SampleBicubic(source_.image->light, seen.u_px, seen.v_px, colour);
  }
  bool HasEmpty() const { return !source_.image->empty.empty(); }
  // Returns true if the source shows that nothing is at a point of the virtual image.
  bool SeesNothingAt(float x, float y, float z) const {
    return HasEmpty() && IsMarkedAt(source_.image->empty, to_source_.At(x, y, z));
  }

 private:
  static constexpr float kSeenThrough = -1e6f;

  bool ShowsNothing(int x, int y) const { return IsTransparent(&source_.image->tones.at(x, y)); }
  float DepthAt(int x, int y) const {
    return first_ + static_cast<float>(source_.plane->at(x, y)) * step_;
  }
  // Returns the depth of the nearest pixel. A transparent pixel has none: it stands for the outline
  // among the four pixels around the place. Returns nullopt if there is no outline.
  std::optional<float> DepthSeenAt(const PairMap::Place& place) const {
    const int x = static_cast<int>(place.u_px), y = static_cast<int>(place.v_px);
    if (!HasEmpty() || !ShowsNothing(x, y)) return DepthAt(x, y);
    const DepthPlane& plane = *source_.plane;
    const int beside =
        std::clamp(place.u_px - static_cast<float>(x) < 0.5f ? x - 1 : x + 1, 0, plane.width() - 1);
    const int below = std::clamp(place.v_px - static_cast<float>(y) < 0.5f ? y - 1 : y + 1, 0,
                                 plane.height() - 1);
    if (!ShowsNothing(beside, y)) return DepthAt(beside, y);
    if (!ShowsNothing(x, below)) return DepthAt(x, below);
    if (!ShowsNothing(beside, below)) return DepthAt(beside, below);
    return std::nullopt;
  }

  const Source source_;
  const PairMap from_source_, to_source_;
  const float step_, first_;
};

// A candidate depth of a pixel, the votes for it, and the point in each source's image.
struct Candidate {
  float depth = 0;
  float votes = 0;
  std::array<SourceView::Seen, kMostSources> seen;
};

class Synthesizer {
 public:
  Synthesizer(const PinholeCamera& camera, std::span<const Source> sources,
              const InverseDepths& range, double tolerance, InterruptFlag interrupted)
      : width_(camera.intrinsics.width_px),
        height_(camera.intrinsics.height_px),
        tolerance_(static_cast<float>(tolerance)),
        per_tolerance_(static_cast<float>(1 / tolerance)),
        farthest_(static_cast<float>(range.least)),
        nothing_{sources[0].image->black, sources[0].image->black, sources[0].image->black, 1},
        interrupted_(interrupted) {
    for (const Source& source : sources) {
      views_.emplace_back(camera, source, range);
      candidates_.emplace_back(width_, height_);
      views_.back().Project(&candidates_.back(), interrupted_);
    }
    Carve();
    FillHoles();
  }

  VirtualImage Run() const {
    constexpr float kWeak = 0.4f;
    VirtualImage image{Image<uint16_t>(width_, height_, LfPixels::kRgbLanes),
                       Image<uint8_t>(width_, height_), 0};
    size_t weak = 0, transparent = 0;
    std::array<Candidate, kMostSources> elected;
    for (int y = 0; y < height_ && !IsSet(interrupted_); ++y)
      for (int x = 0; x < width_; ++x) {
        const size_t count = Vote(x, y, &elected);
        if (count == 0) {
          std::copy(nothing_.begin(), nothing_.end(), &image.light.at(x, y));
          image.trust.at(x, y) = LfPixels::kTrusted;
          ++transparent;
          continue;
        }
        if (elected[0].votes < kWeak) ++weak;
        image.trust.at(x, y) = Mix({elected.data(), count}, &image.light.at(x, y));
      }
    const double shown = static_cast<double>(width_) * height_ - static_cast<double>(transparent);
    image.weak_share = static_cast<double>(weak) / std::max(shown, 1.0);
    return image;
  }

 private:
  bool IsCarved(int x, int y, float depth) const {
    return std::any_of(views_.begin(), views_.end(), [&](const SourceView& view) {
      return view.SeesNothingAt(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, depth);
    });
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
    holes_ = Image<float>(width_, height_, 1, kNoDepth);
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

  // Fills a candidate without votes.
  void See(int x, int y, float depth, Candidate* candidate) const {
    candidate->depth = depth;
    candidate->votes = 0;
    for (size_t i = 0; i < views_.size(); ++i)
      candidate->seen[i] = views_[i].See(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                                         depth, per_tolerance_);
  }

  // Writes the candidates of a pixel with their votes, the elected one first. Returns their number;
  // 0 if nothing is at the pixel.
  size_t Vote(int x, int y, std::array<Candidate, kMostSources>* result) const {
    // Candidates this near to each other, in tolerances, are one.
    constexpr float kSame = 0.5f;
    // A vote against a depth counts less, because planes are wrong near outlines.
    constexpr float kThrough = -1.5f, kAgainst = 0.7f;
    constexpr float kNearer = 0.02f;  // lead that a farther candidate needs, and a nearer one lacks
    std::array<Candidate, kMostSources>& found = *result;
    size_t count = 0, best = 0;
    for (const Image<float>& candidates : candidates_) {
      const float depth = candidates.at(x, y);
      if (depth == kNoDepth) continue;
      bool is_known = false;
      for (size_t i = 0; i < count; ++i)
        is_known |= std::abs(found[i].depth - depth) < kSame * tolerance_;
      if (is_known) continue;
      Candidate& candidate = found[count];
      See(x, y, depth, &candidate);
      float votes = 0;
      for (size_t i = 0; i < views_.size(); ++i) {
        const SourceView::Seen& seen = candidate.seen[i];
        if (!seen.is_inside) continue;
        votes += views_[i].weight() * Agreement(seen.error);
        if (seen.error < kThrough) votes -= kAgainst * views_[i].weight();
      }
      candidate.votes = votes;
      if (count > 0 && votes > found[best].votes + (depth > found[best].depth ? -kNearer : kNearer))
        best = count;
      ++count;
    }
    if (count == 0) {
      See(x, y, holes_.at(x, y), &found[0]);
      return IsCarved(x, y, found[0].depth) ? 0 : 1;
    }
    std::swap(found[0], found[best]);
    return count;
  }

  // Writes the colour of a pixel; leaves it 0 if no source shows it. Returns the trust in it.
  uint8_t Mix(std::span<const Candidate> elected, uint16_t* pixel) const {
    constexpr float kClose = 0.6f;  // candidates with so many fewer votes have no part
    float colour[kLanes] = {}, sum = 0, spread = 0;
    for (const Candidate& candidate : elected) {
      const float rest = 1 - (elected[0].votes - candidate.votes) / kClose;
      if (!(rest > 0)) continue;
      const float share = rest * rest * rest;
      float at_depth[kLanes];
      float* const wants_spread = &candidate == elected.data() ? &spread : nullptr;
      if (!ColourOf(candidate, at_depth, wants_spread)) continue;
      for (int c = 0; c < kLanes; ++c) colour[c] += share * at_depth[c];
      sum += share;
    }
    if (!(sum > 0)) return 0;
    for (float& lane : colour) lane /= sum;
    RoundPixel(colour, nothing_[0], pixel);
    // Transparent parts are known.
    const float opacity = OpacityOfLane(colour[kColours]);
    return static_cast<uint8_t>(opacity * TrustOf(elected[0].votes, spread) +
                                (1 - opacity) * LfPixels::kTrusted + 0.5f);
  }

  // Computes the colour of a pixel if it has this depth. False if no source shows it.
  //   spread  receives the spread of the colours of the sources that agree on the depth; may be
  //   null
  bool ColourOf(const Candidate& candidate, float result[kLanes], float* spread) const {
    // The more sources agree on the depth, the less the others count.
    constexpr float kFewVotes = 0.02f;
    // If sources with so much of the weight are opaque, a small error of the depth moved the others
    // to an outline.
    constexpr float kMostly = 0.7f, kNearlyOpaque = 0.99f;
    struct Sampled {
      float colour[kLanes];
      float weight, agreement, opacity;
    };
    std::array<Sampled, kMostSources> sampled;
    size_t count = 0;
    float opaque = 0, whole = 0;
    for (size_t i = 0; i < views_.size(); ++i) {
      const SourceView::Seen& seen = candidate.seen[i];
      Sampled& sample = sampled[count];
      if (!seen.is_inside || !views_[i].Sample(seen, sample.colour)) continue;
      sample.weight = views_[i].weight();
      sample.agreement = Agreement(seen.error);
      sample.opacity = OpacityOfLane(sample.colour[kColours]);
      whole += sample.weight;
      if (sample.opacity > kNearlyOpaque) opaque += sample.weight;
      ++count;
    }
    const bool is_opaque = opaque >= kMostly * whole;
    float agreed[kLanes] = {}, agreed_sum = 0, all[kLanes] = {}, all_sum = 0;
    std::array<WeighedColour, kMostSources> colours;
    size_t colour_count = 0;
    for (const Sampled& sample : std::span(sampled.data(), count)) {
      if (is_opaque && sample.opacity <= kNearlyOpaque) continue;
      const float weight = sample.weight * sample.agreement;
      // The part of the source's pixel that is transparent agrees that nothing is at the place.
      const float through = sample.weight * (1 - sample.agreement) * (1 - sample.opacity);
      for (int c = 0; c < kLanes; ++c) {
        agreed[c] += weight * sample.colour[c] + through * nothing_[static_cast<size_t>(c)];
        all[c] += sample.weight * sample.colour[c];
      }
      colours[colour_count++] = {{sample.colour[0], sample.colour[1], sample.colour[2]}, weight};
      agreed_sum += weight + through;
      all_sum += sample.weight;
    }
    if (!(all_sum > 0)) return false;
    if (spread != nullptr) *spread = SpreadOf({colours.data(), colour_count});
    const float trust = agreed_sum / (agreed_sum + kFewVotes);
    for (int c = 0; c < kLanes; ++c)
      result[c] =
          (agreed_sum > 0 ? trust * agreed[c] / agreed_sum : 0) + (1 - trust) * all[c] / all_sum;
    return true;
  }

  const int width_, height_;
  const float tolerance_, per_tolerance_, farthest_;
  const std::array<uint16_t, kLanes> nothing_;  // a transparent pixel
  const InterruptFlag interrupted_;
  std::vector<SourceView> views_;
  std::vector<Image<float>> candidates_;
  Image<float> holes_;  // for pixels without a candidate: a depth from around them
};

}  // namespace

VirtualImage Synthesize(const PinholeCamera& camera, std::span<const Source> sources,
                        const InverseDepths& range, double tolerance, InterruptFlag interrupted) {
  LF_CHECK(!sources.empty() && sources.size() <= kMostSources && tolerance > 0);
  return Synthesizer(camera, sources, range, tolerance, interrupted).Run();
}

}  // namespace lf
