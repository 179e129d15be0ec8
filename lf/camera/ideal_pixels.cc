#include "lf/camera/ideal_pixels.h"

#include <algorithm>

namespace lf {
namespace {

constexpr int kLongestArc_px = 512;

class ArcMaker {
 public:
  explicit ArcMaker(const Intrinsics& k)
      : k_(k), matrix_(k.Matrix()), inverse_(k.InverseMatrix()), map_(k.distortion) {}

  void AddScanline(int y, std::vector<IdealArc>* arcs) {
    const double centre_y = y + 0.5;
    // As long as the last one that fitted, so that few are tried in vain.
    int length = kLongestArc_px;
    for (int x = 0; x < k_.width_px;) {
      const int end = std::min(k_.width_px, x + length);
      if (end - x == 1) {
        if (const std::optional<Vec3> q = Position(x + 0.5, centre_y))
          arcs->push_back({x, end, {*q, *q, *q, *q}});
        // Tried again where the lens bends less.
        length = (end & 7) == 0 ? 8 : 1;
        x = end;
        continue;
      }
      const std::optional<IdealArc> arc = Fit(x, end, centre_y);
      if (!arc) {
        length = std::max(1, (end - x) / 2);
        continue;
      }
      arcs->push_back(*arc);
      x = end;
      // Longer ones are tried now and then.
      if (x % (8 * length) < length) length = std::min(2 * length, kLongestArc_px);
    }
  }

 private:
  std::optional<Vec3> Position(double x, double y) const { return IdealPosition(k_, map_, x, y); }

  // The cubic through the ideal positions of both ends and at the thirds between.
  std::optional<IdealArc> Fit(int begin, int end, double y) const {
    const double length = end - begin;
    Vec3 through[4];
    for (int i = 0; i < 4; ++i) {
      const std::optional<Vec3> q = Position(begin + length * i / 3, y);
      if (!q) return std::nullopt;
      through[i] = *q;
    }
    IdealArc arc{begin, end, {}};
    arc.control[0] = through[0];
    arc.control[1] =
        (-5 * through[0] + 18 * through[1] - 9 * through[2] + 2 * through[3]) * (1.0 / 6);
    arc.control[2] =
        (2 * through[0] - 9 * through[1] + 18 * through[2] - 5 * through[3]) * (1.0 / 6);
    arc.control[3] = through[3];
    // A cubic through four even points misses most near the middle of the outer thirds.
    for (const double t : {0.127, 0.873}) {
      const std::optional<Vec2> recorded = map_.Distort(inverse_ * arc.At(t));
      if (!recorded) return std::nullopt;
      const Vec3 p = matrix_ * Vec3(recorded->x(), recorded->y(), 1);
      if (!((p.head<2>() - Vec2(begin + length * t, y)).norm() <= IdealPixels::kTolerance_px))
        return std::nullopt;
    }
    return arc;
  }

  const Intrinsics& k_;
  Mat3 matrix_, inverse_;
  DistortionMap map_;
};

}  // namespace

std::optional<Vec3> IdealPosition(const Intrinsics& k, const DistortionMap& map, double x_px,
                                  double y_px) {
  const Vec3 distorted = k.InverseMatrix() * Vec3(x_px, y_px, 1);
  const std::optional<Vec3> direction = map.Undistort(distorted.head<2>());
  if (!direction) return std::nullopt;
  return k.Matrix() * *direction;
}

IdealPixels::IdealPixels(const Intrinsics& k) {
  ArcMaker maker(k);
  for (int y = 0; y < k.height_px; ++y) {
    row_begin_.push_back(arcs_.size());
    maker.AddScanline(y, &arcs_);
  }
  row_begin_.push_back(arcs_.size());
  arcs_.shrink_to_fit();
}

}  // namespace lf
