// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/place_depth.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "lf/focus/depth_sweep.h"
#include "lf/focus/focus_pick.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

constexpr int kColumns = 16, kRows = 11;  // cells of the image; each has at most one place
constexpr double kLeastTexture = 0.006;   // least TextureAt() of a place
// Least Smoothness() of a place: neighbouring pixels of noise do not correlate.
constexpr double kLeastSmoothness = 0.25;
// Smaller standard deviations of a patch count as this one, so that mere noise does not correlate.
constexpr double kLeastDeviation = 0.002;
constexpr double kLeastAgreement = 0.65;  // least Peak::score of a depth that is found
// Share of views that must agree on a depth. The other views may be unable to see the place.
constexpr double kAgreeing = 0.6;
constexpr size_t kLeastViews = 2;
// Step of the largest disparity from one depth of a sweep to the next, in reduced pixels.
constexpr double kStep_px = 0.5;
constexpr double kMostDisplaced = 0.45;  // largest disparity tested, in widths of the image
constexpr double kLeastMove_px = 1;      // in reduced pixels; places that move less are not used
constexpr double kStill = 0.9;           // least agreement of views on a place that does not move
// Displacement, in reduced pixels, from which a view tells whether a place moves: less hardly
// changes the pixels of a patch.
constexpr double kStillMove_px = 2;
constexpr size_t kMostRings = 6;
constexpr int kViewsPerRing = 6;
// Radii of the two innermost rings, in spacings of LF cameras. Sparse captures need the first,
// because LF images farther apart differ.
constexpr double kInnerRing = 1, kSecondRing = 2;
constexpr double kRingFactor = 4;  // radius of the other rings, relative to the next smaller ring
// Least cosine of the angle between the optical axes of compared LF cameras.
constexpr double kLeastCosine = 0.8;

// Returns the sum of value(i) over the pixels i of a patch. It is computed in about as many
// independent chains of additions as a processor runs at the same time.
template <typename Value>
double SumOf(const Value& value) {
  constexpr size_t kChains = 9;
  static_assert(kPatchSize % kChains == 0);
  std::array<double, kChains> sums = {};
  for (size_t i = 0; i < kPatchSize; i += kChains)
    for (size_t chain = 0; chain < kChains; ++chain) sums[chain] += value(i + chain);
  double sum = 0;
  for (const double of_chain : sums) sum += of_chain;
  return sum;
}

// Subtracts the mean from the patch. Returns the standard deviation; NaN if a value is NaN.
double Centre(Patch* patch) {
  const double sum = SumOf([&](size_t i) { return static_cast<double>((*patch)[i]); });
  const auto mean = static_cast<float>(sum / kPatchSize);
  for (float& value : *patch) value -= mean;
  const double squares =
      SumOf([&](size_t i) { return static_cast<double>((*patch)[i]) * (*patch)[i]; });
  return std::sqrt(squares / kPatchSize);
}

// Reads all pixels of the patch; each value equals ReducedImage::At(). Returns false if the patch
// extends beyond the image.
bool Sample(const ReducedImage& image, const PatchGrid& grid, Patch* patch) {
  const Image<float>& light = image.light;
  const double scale = 1.0 / image.divisor;
  const Vec2 step_x = scale * grid.step_x, step_y = scale * grid.step_y;
  const Vec2 first = scale * grid.centre - Vec2(0.5, 0.5) - kHalfPatch * (step_x + step_y);
  for (const int i : {0, kPatchSide - 1})
    for (const int j : {0, kPatchSide - 1}) {
      const Vec2 corner = first + i * step_x + j * step_y;
      if (!(corner.x() >= 0 && corner.y() >= 0 && corner.x() < light.width() - 1 &&
            corner.y() < light.height() - 1))
        return false;
    }
  // Parallel cameras show the place at the same scale, so that all pixels of the patch are
  // interpolated with the same weights.
  constexpr double kSamePixel = 1e-7;
  if ((step_x - Vec2(1, 0)).norm() + (step_y - Vec2(0, 1)).norm() < kSamePixel) {
    const int column = static_cast<int>(first.x()), row = static_cast<int>(first.y());
    const auto u = static_cast<float>(first.x() - column), v = static_cast<float>(first.y() - row);
    for (int j = 0; j < kPatchSide; ++j) {
      const float* upper = light.row(row + j) + column;
      const float* lower = light.row(row + j + 1) + column;
      for (int i = 0; i < kPatchSide; ++i)
        (*patch)[static_cast<size_t>(j) * kPatchSide + static_cast<size_t>(i)] =
            (1 - v) * ((1 - u) * upper[i] + u * upper[i + 1]) +
            v * ((1 - u) * lower[i] + u * lower[i + 1]);
    }
    return true;
  }
  for (int j = 0; j < kPatchSide; ++j)
    for (int i = 0; i < kPatchSide; ++i) {
      const double x = first.x() + i * step_x.x() + j * step_y.x();
      const double y = first.y() + i * step_x.y() + j * step_y.y();
      const int column = static_cast<int>(x), row = static_cast<int>(y);
      const auto u = static_cast<float>(x - column), v = static_cast<float>(y - row);
      const float* upper = light.row(row) + column;
      const float* lower = light.row(row + 1) + column;
      (*patch)[static_cast<size_t>(j) * kPatchSide + static_cast<size_t>(i)] =
          (1 - v) * ((1 - u) * upper[0] + u * upper[1]) + v * ((1 - u) * lower[0] + u * lower[1]);
    }
  return true;
}

// Subtracts the mean from `other` and returns its correlation with the place's patch; -1 if a pixel
// of `other` is NaN.
double Correlation(const Place& place, Patch* other) {
  const double deviation = Centre(other);
  if (std::isnan(deviation)) return -1;
  const double product =
      SumOf([&](size_t i) { return static_cast<double>(place.patch[i]) * (*other)[i]; });
  return product / (kPatchSize * std::max(place.deviation, kLeastDeviation) *
                    std::max(deviation, kLeastDeviation));
}

}  // namespace

std::optional<PatchGrid> PatchSeenBy(const View& view, const Place& place, double depth_w) {
  const auto at = [&](double x, double y) {
    return view.rays.RecordedAt(place.At(depth_w, x, y) - view.rays.centre_world());
  };
  const auto centre = at(0, 0), right = at(kHalfPatch, 0), down = at(0, kHalfPatch);
  if (!centre || !right || !down) return std::nullopt;
  return PatchGrid{*centre, (*right - *centre) / kHalfPatch, (*down - *centre) / kHalfPatch};
}

double CorrelationAt(const View& view, const Place& place, double depth_w) {
  const std::optional<PatchGrid> grid = PatchSeenBy(view, place, depth_w);
  if (!grid) return -1;
  Patch patch;
  return Sample(*view.image, *grid, &patch) ? Correlation(place, &patch) : -1;
}

namespace {

// Returns the mean of the largest 60 % of the correlations, but at least of two; -1 if there are
// fewer than two. Sorts the correlations.
double Agreement(std::vector<double>* correlations) {
  if (correlations->size() < kLeastViews) return -1;
  const auto count = static_cast<size_t>(kAgreeing * static_cast<double>(correlations->size()));
  return MeanOfLargest(correlations, std::max(kLeastViews, count));
}

double AgreementAt(std::span<const View> views, const Place& place, double depth_w) {
  std::vector<double> correlations;
  for (const View& view : views)
    if (const double correlation = CorrelationAt(view, place, depth_w); correlation > -1)
      correlations.push_back(correlation);
  return Agreement(&correlations);
}

// Returns true if the place is a watermark, which is at the same pixel position in every image: the
// views in which a place at this depth is clearly displaced show it where it is in its own image.
// Objects where the axes of the cameras meet hardly move, and tell nothing.
bool IsStill(const Rings& rings, const Place& place, double depth_w, int divisor) {
  std::vector<double> correlations;
  for (const std::vector<View>& ring : rings)
    for (const View& view : ring) {
      const auto at = view.rays.RecordedAt(place.At(depth_w, 0, 0) - view.rays.centre_world());
      if (!at || (*at - place.at_px).norm() < kStillMove_px * divisor) continue;
      Patch patch;
      for (int i = 0; i < kPatchSize; ++i)
        patch[static_cast<size_t>(i)] = view.image->At(
            place.at_px + divisor * Vec2(i % kPatchSide - kHalfPatch, i / kPatchSide - kHalfPatch));
      const double correlation = Correlation(place, &patch);
      if (correlation > -1) correlations.push_back(correlation);
    }
  return Agreement(&correlations) >= kStill;
}

// Returns the largest disparity between the place's image and a view, in reduced pixels, at the
// depth of one world unit. The disparity is inversely proportional to the depth.
double PixelsPerW(std::span<const View> views, const Intrinsics& k, int divisor) {
  double baseline_w = 0;
  for (const View& view : views) baseline_w = std::max(baseline_w, view.offset_w);
  return std::max(1e-12, k.fx_px * baseline_w / divisor);
}

// The depth of a sweep at which the views agree best.
struct Peak {
  // `score` is the agreement of the views at this depth, `rival` the agreement at the best local
  // maximum elsewhere; -1 if there is none.
  double score = -1, rival = -1;
  double per_w = 0;                     // 1 / depth, interpolated between the depths of the sweep
  double from_per_w = 0, to_per_w = 0;  // range of 1 / depth around per_w that is almost as good
};

Peak FindPeak(const DepthSweep& sweep, std::span<const View> views, const Place& place) {
  std::vector<double> scores(sweep.count);
  for (size_t i = 0; i < sweep.count; ++i)
    scores[i] = AgreementAt(views, place, sweep.Depth(static_cast<double>(i)));
  const size_t best =
      static_cast<size_t>(std::max_element(scores.begin(), scores.end()) - scores.begin());
  Peak peak;
  peak.score = scores[best];
  constexpr double kNearlyAsGood = 0.1;
  const auto is_good = [&](size_t i) { return scores[i] >= peak.score - kNearlyAsGood; };
  size_t first = best, last = best;
  while (first > 0 && is_good(first - 1)) --first;
  while (last + 1 < scores.size() && is_good(last + 1)) ++last;
  constexpr size_t kPeakWidth = 3;
  peak.rival = PeakElsewhere(scores, first, last, kPeakWidth, peak.rival);
  const double at = VertexAround(scores, best, [](double score) { return score > -1; });
  peak.per_w = sweep.PerW(at);
  peak.from_per_w = sweep.PerW(static_cast<double>(first) - 1);
  peak.to_per_w = std::max(0.0, sweep.PerW(static_cast<double>(last) + 1));
  return peak;
}

}  // namespace

std::optional<FoundDepth> DepthOf(const Rings& rings, const Place& place, const Intrinsics& k,
                                  int divisor, double nearest_w, NoDepth* why) {
  const auto none = [&](NoDepth reason) {
    if (why) *why = reason;
    return std::nullopt;
  };
  double px_per_w = PixelsPerW(rings[0], k, divisor);
  DepthSweep sweep;
  sweep.from_per_w = kMostDisplaced * k.width_px / divisor / px_per_w;
  if (nearest_w > 0) sweep.from_per_w = std::min(sweep.from_per_w, 1 / nearest_w);
  sweep.step_per_w = kStep_px / px_per_w;
  sweep.count = static_cast<size_t>(sweep.from_per_w / sweep.step_per_w) + 1;
  Peak peak = FindPeak(sweep, rings[0], place);
  if (peak.score < kLeastAgreement) return none(NoDepth::kDisagreement);
  // Rejects a place if the agreement is almost as good elsewhere: LF images of a repeated pattern
  // agree at several depths.
  constexpr double kClear = 0.1, kLeastClear = 0.3;
  const double clear = std::min(1.0, (peak.score - peak.rival) / kClear);
  if (clear < kLeastClear) return none(NoDepth::kAmbiguous);
  double score = peak.score;
  for (size_t ring = 1; ring < rings.size(); ++ring) {
    const double finer_px_per_w = PixelsPerW(rings[ring], k, divisor);
    DepthSweep finer{peak.from_per_w, kStep_px / finer_px_per_w, 0};
    finer.count = static_cast<size_t>((peak.from_per_w - peak.to_per_w) / finer.step_per_w) + 1;
    constexpr size_t kMostSteps = 4000;
    if (finer.count > kMostSteps) break;
    const Peak found = FindPeak(finer, rings[ring], place);
    if (found.score < kLeastAgreement) break;
    peak = found;
    px_per_w = finer_px_per_w;
    score = std::max(score, found.score);
  }
  const double moves_px = peak.per_w * px_per_w;
  if (moves_px < kLeastMove_px) return none(NoDepth::kFar);
  const double distance_w = 1 / peak.per_w;
  if (IsStill(rings, place, distance_w, divisor)) return none(NoDepth::kAmbiguous);
  const double agreement = std::clamp((score - kLeastAgreement) / (0.95 - kLeastAgreement), 0., 1.);
  return FoundDepth{distance_w, place.weight * clear * agreement, 0.25 / moves_px};
}

namespace {

// Returns the square root of the smaller eigenvalue of the mean of g g^T over a patch, where g is
// the gradient of `light` per reduced pixel. The result is 0 on straight edges, whose disparity is
// known only across the edge.
double TextureAt(const Image<float>& light, int x, int y) {
  double xx = 0, xy = 0, yy = 0;
  for (int j = y - kHalfPatch; j <= y + kHalfPatch; ++j)
    for (int i = x - kHalfPatch; i <= x + kHalfPatch; ++i) {
      const double dx = light.at(i + 1, j) - light.at(i - 1, j);
      const double dy = light.at(i, j + 1) - light.at(i, j - 1);
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  const double mean = (xx + yy) / 2;
  const double least = mean - std::sqrt(std::pow((xx - yy) / 2, 2) + xy * xy);
  return std::sqrt(std::max(0.0, least) / kPatchSize) / 2;  // NaN becomes 0
}

// Returns the correlation between the pixels of a patch with mean 0 and the pixels beside and below
// them.
double Smoothness(const Patch& patch) {
  double product = 0, squares = 0;
  for (size_t y = 0; y + 1 < kPatchSide; ++y)
    for (size_t x = 0; x + 1 < kPatchSide; ++x) {
      const double here = patch[y * kPatchSide + x];
      const double beside = patch[y * kPatchSide + x + 1];
      const double below = patch[(y + 1) * kPatchSide + x];
      product += here * (beside + below);
      squares += here * here + (beside * beside + below * below) / 2;
    }
  return squares > 0 ? product / squares : 0;
}

// Returns the place with the most texture in one cell of the image; none if its texture is too weak
// or mere noise, or the image too small.
std::optional<Place> PlaceIn(const LightField& field, LfImageId camera, const ReducedImage& image,
                             int column, int row) {
  const int border = kHalfPatch + 1, width = image.light.width() - 2 * border,
            height = image.light.height() - 2 * border;
  if (width < kColumns || height < kRows) return std::nullopt;
  double best = 0;
  int best_x = 0, best_y = 0;
  for (int y = row * height / kRows; y < (row + 1) * height / kRows; y += 3)
    for (int x = column * width / kColumns; x < (column + 1) * width / kColumns; x += 3)
      if (const double texture = TextureAt(image.light, x + border, y + border); texture > best) {
        best = texture;
        best_x = x + border;
        best_y = y + border;
      }
  if (best < kLeastTexture) return std::nullopt;
  const PinholeCamera pinhole = field.Camera(camera);
  const int d = image.divisor;
  const auto direction = [&](double x, double y) -> std::optional<Vec3> {
    const std::optional<Ray> ray = RayOfLfPixel(pinhole, x, y);
    if (!ray) return std::nullopt;
    const double depth = pinhole.ForwardWorld().dot(ray->direction);
    return depth > 0 ? std::optional(Vec3(ray->direction / depth)) : std::nullopt;
  };
  Place place;
  place.at_px = Vec2((best_x + 0.5) * d, (best_y + 0.5) * d);
  const auto centre = direction(place.at_px.x(), place.at_px.y());
  const auto right = direction(place.at_px.x() + d, place.at_px.y());
  const auto down = direction(place.at_px.x(), place.at_px.y() + d);
  if (!centre || !right || !down) return std::nullopt;
  place.origin = pinhole.CentreWorld();
  place.direction = *centre;
  place.right = *right - *centre;
  place.down = *down - *centre;
  for (int i = 0; i < kPatchSize; ++i)
    place.patch[static_cast<size_t>(i)] =
        image.light.at(best_x + i % kPatchSide - kHalfPatch, best_y + i / kPatchSide - kHalfPatch);
  place.deviation = Centre(&place.patch);
  if (Smoothness(place.patch) < kLeastSmoothness) return std::nullopt;
  const Intrinsics& k = pinhole.intrinsics;
  const Vec2 off = (place.at_px - Vec2(k.width_px, k.height_px) / 2) / (0.5 * k.width_px);
  constexpr double kMiddle = 0.5;  // standard deviation of the weight, as a share of half the width
  place.weight = std::min(1.0, best / (3 * kLeastTexture)) *
                 std::exp(-0.5 * off.squaredNorm() / (kMiddle * kMiddle));
  return place;
}

}  // namespace

std::vector<Place> TexturedPlaces(const LightField& field, LfImageId camera,
                                  const ReducedImage& image) {
  std::vector<Place> places;
  for (int i = 0; i < kColumns * kRows; ++i)
    if (const auto place = PlaceIn(field, camera, image, i % kColumns, i / kColumns))
      places.push_back(*place);
  return places;
}

Rings ChooseRings(const LightField& field, LfImageId camera) {
  struct Candidate {
    LfImageId id;
    Vec2 place;
    double distance_w;
  };
  const PinholeCamera middle = field.Camera(camera);
  std::vector<Candidate> candidates;
  double reach_w = 0;
  for (uint32_t i = 0; i < field.size(); ++i) {
    const PinholeCamera other = field.Camera(LfImageId{i});
    if (i == camera.value || other.ForwardWorld().dot(middle.ForwardWorld()) < kLeastCosine)
      continue;
    const Vec3 offset = other.CentreWorld() - middle.CentreWorld();
    const Vec2 place(middle.RightWorld().dot(offset), middle.UpWorld().dot(offset));
    candidates.push_back({LfImageId{i}, place, offset.norm()});
    reach_w = std::max(reach_w, place.norm());
  }
  Rings rings;
  double radius_w = kInnerRing * MedianSpacing(field);
  for (size_t ring = 0; ring < kMostRings && (ring == 0 || radius_w <= 1.2 * reach_w);
       ++ring, radius_w *= ring == 1 ? kSecondRing / kInnerRing : kRingFactor) {
    std::vector<View> views;
    for (int i = 0; i < kViewsPerRing; ++i) {
      const double angle = 2 * kPi * (i + 0.5 * static_cast<double>(ring % 2)) / kViewsPerRing;
      const Vec2 wanted(radius_w * std::cos(angle), radius_w * std::sin(angle));
      const auto nearest = std::min_element(
          candidates.begin(), candidates.end(), [&](const Candidate& a, const Candidate& b) {
            return (a.place - wanted).norm() < (b.place - wanted).norm();
          });
      if (nearest == candidates.end()) break;
      const double away = nearest->place.norm() / radius_w;
      if (ring > 0 && (away < 0.5 || away > 2)) continue;
      if (nearest->distance_w <= 0) continue;
      const bool is_there = std::any_of(views.begin(), views.end(),
                                        [&](const View& view) { return view.id == nearest->id; });
      if (!is_there)
        views.push_back({nearest->id, RayThrough(field.Camera(nearest->id), middle.ForwardWorld()),
                         nearest->place.norm()});
    }
    if (ring == 0 || views.size() >= kLeastViews) rings.push_back(std::move(views));
  }
  return rings;
}

}  // namespace lf
