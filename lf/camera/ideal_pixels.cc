// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/ideal_pixels.h"

#include <algorithm>
#include <array>

#include "lf/core/quintic.h"

namespace lf {
namespace {

// Size of the largest patch. Patches are wide, because kernels work along scanlines.
constexpr int kLargestWidth_px = 1024, kLargestHeight_px = 64;

constexpr int kControls = IdealPatch::kControls;

using Points = std::array<Vec3, kControls>;

// Returns the control points of the arc that goes through `points` at t = kQuinticPlaces, where t
// runs from -1 to 1 along the arc (core/quintic.h).
Points ControlsThrough(const Points& points) {
  // Control point i is the sum over k of kValues[i][k] / kDivisors[k] times the coefficient of t^k.
  // These factors are values of the blossom (polar form) of t^k.
  constexpr int kValues[kControls][kControls] = {{1, -5, 10, -10, 5, -1}, {1, -3, 2, 2, -3, 1},
                                                 {1, -1, -2, 2, 1, -1},   {1, 1, -2, -2, 1, 1},
                                                 {1, 3, 2, -2, -3, -1},   {1, 5, 10, 10, 5, 1}};
  constexpr int kDivisors[kControls] = {1, 5, 10, 10, 5, 1};
  const Points powers = QuinticThrough(points);
  Points controls;
  for (size_t i = 0; i < kControls; ++i) {
    controls[i] = powers[0];
    for (size_t k = 1; k < kControls; ++k)
      controls[i] += powers[k] * (static_cast<double>(kValues[i][k]) / kDivisors[k]);
  }
  return controls;
}

class PatchMaker {
 public:
  PatchMaker(const Intrinsics& k, std::vector<IdealPatch>* patches)
      : k_(k),
        matrix_(k.Matrix()),
        inverse_(k.InverseMatrix()),
        map_(k.distortion),
        patches_(patches) {}

  // Adds patches for `rect`. A rectangle that no patch fits is halved, down to single pixels: into
  // a left and a right half if it is at least twice as wide as high, otherwise into an upper and a
  // lower one.
  void Add(const PixelRect& rect) {
    if (rect.empty()) return;
    if (rect.pixel_count() == 1) {
      AddPixel(rect);
      return;
    }
    IdealPatch patch{rect, {}};
    if (Fit(&patch)) {
      patches_->push_back(patch);
      return;
    }
    PixelRect first = rect, second = rect;
    if (rect.width() >= 2 * rect.height())
      first.x_end = second.x_begin = rect.x_begin + rect.width() / 2;
    else if (rect.height() > 1)
      first.y_end = second.y_begin = rect.y_begin + rect.height() / 2;
    else
      first.x_end = second.x_begin = rect.x_begin + 1;
    Add(first);
    Add(second);
  }

 private:
  std::optional<Vec3> Position(double x, double y) const { return IdealPosition(k_, map_, x, y); }

  void AddPixel(const PixelRect& rect) {
    const std::optional<Vec3> q = Position(rect.x_begin + 0.5, rect.y_begin + 0.5);
    if (!q) return;
    IdealPatch patch{rect, {}};
    for (auto& row : patch.control) std::fill(std::begin(row), std::end(row), *q);
    patches_->push_back(patch);
  }

  // Makes the patch go through the ideal positions of six by six points of its rectangle. Returns
  // false if one of these points has no ideal position, or if the error of the patch exceeds
  // kTolerance_px.
  bool Fit(IdealPatch* patch) const {
    const PixelRect& rect = patch->rect;
    Points rows[kControls];  // control points of the arc through each row of points
    for (size_t j = 0; j < kControls; ++j) {
      Points through;
      for (size_t i = 0; i < kControls; ++i) {
        const std::optional<Vec3> q =
            Position(rect.x_begin + rect.width() * UnitPlace(kQuinticPlaces[i]),
                     rect.y_begin + rect.height() * UnitPlace(kQuinticPlaces[j]));
        if (!q) return false;
        through[i] = *q;
      }
      rows[j] = ControlsThrough(through);
    }
    for (size_t i = 0; i < kControls; ++i) {
      Points through;
      for (size_t j = 0; j < kControls; ++j) through[j] = rows[j][i];
      const Points column = ControlsThrough(through);
      for (size_t j = 0; j < kControls; ++j) patch->control[j][i] = column[j];
    }
    for (const double v : kQuinticWorstPlaces)
      for (const double u : kQuinticWorstPlaces)
        if (!IsTrue(*patch, UnitPlace(u), UnitPlace(v))) return false;
    return true;
  }

  // Converts a place of core/quintic.h, in [-1, 1], to a parameter of the patch, in [0, 1].
  static double UnitPlace(double place) { return 0.5 * (1 + place); }

  bool IsTrue(const IdealPatch& patch, double u, double v) const {
    const std::optional<Vec2> recorded = map_.Distort(inverse_ * patch.ArcAt(v).At(u));
    if (!recorded) return false;
    const Vec3 p = matrix_ * Vec3(recorded->x(), recorded->y(), 1);
    const Vec2 truth(patch.rect.x_begin + patch.rect.width() * u,
                     patch.rect.y_begin + patch.rect.height() * v);
    return (p.head<2>() - truth).norm() <= IdealPixels::kTolerance_px;
  }

  const Intrinsics& k_;
  Mat3 matrix_, inverse_;
  DistortionMap map_;
  std::vector<IdealPatch>* patches_;
};

}  // namespace

std::optional<Vec3> IdealPosition(const Intrinsics& k, const DistortionMap& map, double x_px,
                                  double y_px) {
  const Vec3 distorted = k.InverseMatrix() * Vec3(x_px, y_px, 1);
  const std::optional<Vec3> direction = map.Undistort(distorted.head<2>());
  if (!direction) return std::nullopt;
  return k.Matrix() * *direction;
}

BezierWeights BezierWeightsAt(double t) {
  const double s = 1 - t, s2 = s * s, t2 = t * t;
  return {s2 * s2 * s,      5 * s2 * s2 * t, 10 * s2 * s * t2,
          10 * s2 * t2 * t, 5 * s * t2 * t2, t2 * t2 * t};
}

Vec3 IdealArc::At(double t) const {
  const BezierWeights weights = BezierWeightsAt(t);
  Vec3 sum = weights[0] * control[0];
  for (size_t i = 1; i < kControls; ++i) sum += weights[i] * control[i];
  return sum;
}

IdealArc IdealPatch::ArcAt(double v) const {
  const BezierWeights weights = BezierWeightsAt(v);
  IdealArc arc{rect.x_begin, rect.x_end, {}};
  for (int i = 0; i < kControls; ++i) {
    arc.control[i] = weights[0] * control[0][i];
    for (size_t j = 1; j < kControls; ++j) arc.control[i] += weights[j] * control[j][i];
  }
  return arc;
}

IdealPixels::IdealPixels(const Intrinsics& k) {
  PatchMaker maker(k, &patches_);
  for (int y = 0; y < k.height_px; y += kLargestHeight_px)
    for (int x = 0; x < k.width_px; x += kLargestWidth_px)
      maker.Add({x, y, std::min(k.width_px, x + kLargestWidth_px),
                 std::min(k.height_px, y + kLargestHeight_px)});
  patches_.shrink_to_fit();
}

}  // namespace lf
