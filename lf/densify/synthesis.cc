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

namespace lf {
namespace {

constexpr int kColours = LfPixels::kRayLane;
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
        if (source_.image->light.at(x, y, kColours) == 0) continue;
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
    const float there = DepthAt(static_cast<int>(place.u_px), static_cast<int>(place.v_px));
    return {true, place.u_px, place.v_px, (there - z / place.w) * per_tolerance};
  }
  bool Sample(const Seen& seen, float colour[LfPixels::kRgbLanes]) const {
    return SampleBicubic(source_.image->light, seen.u_px, seen.v_px, colour);
  }

 private:
  float DepthAt(int x, int y) const {
    return first_ + static_cast<float>(source_.plane->at(x, y)) * step_;
  }

  const Source source_;
  const PairMap from_source_, to_source_;
  const float step_, first_;
};

// A candidate depth of a pixel and the votes for it.
struct Candidate {
  float depth = 0;
  float votes = 0;
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
        interrupted_(interrupted) {
    for (const Source& source : sources) {
      views_.emplace_back(camera, source, range);
      candidates_.emplace_back(width_, height_);
      views_.back().Project(&candidates_.back(), interrupted_);
    }
    FillHoles();
  }

  VirtualImage Run() const {
    constexpr float kWeak = 0.4f;
    VirtualImage image{Image<uint16_t>(width_, height_, LfPixels::kRgbLanes), 0};
    size_t weak = 0;
    std::array<Candidate, kMostSources> elected;
    for (int y = 0; y < height_ && !IsSet(interrupted_); ++y)
      for (int x = 0; x < width_; ++x) {
        const size_t count = Vote(x, y, &elected);
        if (elected[0].votes < kWeak) ++weak;
        Mix(x, y, {elected.data(), count}, &image.light.at(x, y));
      }
    image.weak_share = static_cast<double>(weak) / (static_cast<double>(width_) * height_);
    return image;
  }

 private:
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

  // Writes the candidates of a pixel with their votes, the elected one first. Returns their number,
  // at least 1.
  size_t Vote(int x, int y, std::array<Candidate, kMostSources>* result) const {
    // Candidates this near to each other, in tolerances, are one.
    constexpr float kSame = 0.3f;
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
      float votes = 0;
      for (const SourceView& view : views_) {
        const SourceView::Seen seen = view.See(static_cast<float>(x) + 0.5f,
                                               static_cast<float>(y) + 0.5f, depth, per_tolerance_);
        if (!seen.is_inside) continue;
        votes += view.weight() * Agreement(seen.error);
        if (seen.error < kThrough) votes -= kAgainst * view.weight();
      }
      found[count] = {depth, votes};
      if (count > 0 && votes > found[best].votes + (depth > found[best].depth ? -kNearer : kNearer))
        best = count;
      ++count;
    }
    if (count == 0) {
      found[0] = {holes_.at(x, y), 0};
      return 1;
    }
    std::swap(found[0], found[best]);
    return count;
  }

  // Writes the colour of a pixel; leaves it 0 if no source shows it.
  void Mix(int x, int y, std::span<const Candidate> elected, uint16_t* pixel) const {
    constexpr float kClose = 0.6f;  // candidates with so many fewer votes have no part
    float colour[kColours] = {}, sum = 0;
    for (const Candidate& candidate : elected) {
      const float rest = 1 - (elected[0].votes - candidate.votes) / kClose;
      if (!(rest > 0)) continue;
      const float share = rest * rest * rest;
      float at_depth[kColours];
      if (!ColourAt(x, y, candidate.depth, at_depth)) continue;
      for (int c = 0; c < kColours; ++c) colour[c] += share * at_depth[c];
      sum += share;
    }
    if (!(sum > 0)) return;
    for (int c = 0; c < kColours; ++c) pixel[c] = RoundToLight(colour[c] / sum);
    pixel[kColours] = 1;
  }

  // Computes the colour of a pixel if it has this depth. False if no source shows it.
  bool ColourAt(int x, int y, float depth, float result[kColours]) const {
    // The more sources agree on the depth, the less the others count.
    constexpr float kFewVotes = 0.02f;
    float agreed[kColours] = {}, agreed_sum = 0, all[kColours] = {}, all_sum = 0;
    for (const SourceView& view : views_) {
      const SourceView::Seen seen = view.See(static_cast<float>(x) + 0.5f,
                                             static_cast<float>(y) + 0.5f, depth, per_tolerance_);
      float colour[LfPixels::kRgbLanes];
      if (!seen.is_inside || !view.Sample(seen, colour)) continue;
      const float weight = view.weight() * Agreement(seen.error);
      for (int c = 0; c < kColours; ++c) {
        agreed[c] += weight * colour[c];
        all[c] += view.weight() * colour[c];
      }
      agreed_sum += weight;
      all_sum += view.weight();
    }
    if (!(all_sum > 0)) return false;
    const float trust = agreed_sum / (agreed_sum + kFewVotes);
    for (int c = 0; c < kColours; ++c)
      result[c] =
          (agreed_sum > 0 ? trust * agreed[c] / agreed_sum : 0) + (1 - trust) * all[c] / all_sum;
    return true;
  }

  const int width_, height_;
  const float tolerance_, per_tolerance_, farthest_;
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
