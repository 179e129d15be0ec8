#include "lf/camera/ideal_pixels.h"

#include <algorithm>

namespace lf {
namespace {

// Wide, since kernels work along scanlines.
constexpr int kLargestWidth_px = 256, kLargestHeight_px = 64;

// Control points of the cubic through four even points.
void ThroughFour(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3, Vec3* control) {
  control[0] = p0;
  control[1] = (-5 * p0 + 18 * p1 - 9 * p2 + 2 * p3) * (1.0 / 6);
  control[2] = (2 * p0 - 9 * p1 + 18 * p2 - 5 * p3) * (1.0 / 6);
  control[3] = p3;
}

class PatchMaker {
 public:
  PatchMaker(const Intrinsics& k, std::vector<IdealPatch>* patches)
      : k_(k),
        matrix_(k.Matrix()),
        inverse_(k.InverseMatrix()),
        map_(k.distortion),
        patches_(patches) {}

  // Halves what does not fit, the longer side first, down to single pixels.
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

  // Through the ideal positions of four by four points.
  bool Fit(IdealPatch* patch) const {
    const PixelRect& rect = patch->rect;
    Vec3 rows[4][4];  // control points of the scanlines through the points
    for (int j = 0; j < 4; ++j) {
      Vec3 through[4];
      for (int i = 0; i < 4; ++i) {
        const std::optional<Vec3> q =
            Position(rect.x_begin + rect.width() * i / 3.0, rect.y_begin + rect.height() * j / 3.0);
        if (!q) return false;
        through[i] = *q;
      }
      ThroughFour(through[0], through[1], through[2], through[3], rows[j]);
    }
    for (int i = 0; i < 4; ++i) {
      Vec3 column[4];
      ThroughFour(rows[0][i], rows[1][i], rows[2][i], rows[3][i], column);
      for (int j = 0; j < 4; ++j) patch->control[j][i] = column[j];
    }
    // A cubic through four even points misses most near the middle of the outer thirds.
    for (const double v : {0.127, 0.5, 0.873})
      for (const double u : {0.127, 0.5, 0.873})
        if (!IsTrue(*patch, u, v)) return false;
    return true;
  }

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

IdealArc IdealPatch::ArcAt(double v) const {
  const double s = 1 - v;
  const double weight[4] = {s * s * s, 3 * s * s * v, 3 * s * v * v, v * v * v};
  IdealArc arc{rect.x_begin, rect.x_end, {}};
  for (int i = 0; i < 4; ++i)
    arc.control[i] = weight[0] * control[0][i] + weight[1] * control[1][i] +
                     weight[2] * control[2][i] + weight[3] * control[3][i];
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
