#include "lf/camera/distortion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct ValueAndSlope {
  double value = 0;
  double slope = 0;
};

// The radial part of kRadialTangential, r * numerator(r^2) / denominator(r^2).
class RadialCurve {
 public:
  explicit RadialCurve(const std::array<double, 8>& p)
      : numerator_{p[0], p[1], p[4]}, denominator_{p[5], p[6], p[7]} {}

  // radial(s), s = r^2, and its derivative by s.
  ValueAndSlope Factor(double s) const {
    const ValueAndSlope n = Evaluate(numerator_, s), d = Evaluate(denominator_, s);
    return {n.value / d.value, (n.slope * d.value - n.value * d.slope) / (d.value * d.value)};
  }
  ValueAndSlope operator()(double r) const {
    const ValueAndSlope factor = Factor(r * r);
    return {r * factor.value, factor.value + 2 * r * r * factor.slope};
  }
  bool IsPole(double r) const { return !(Evaluate(denominator_, r * r).value > 0); }

 private:
  static ValueAndSlope Evaluate(const std::array<double, 3>& k, double s) {
    return {1 + s * (k[0] + s * (k[1] + s * k[2])), k[0] + s * (2 * k[1] + s * 3 * k[2])};
  }
  std::array<double, 3> numerator_, denominator_;
};

// theta (1 + k1 theta^2 + ...)
class FisheyeCurve {
 public:
  explicit FisheyeCurve(const std::array<double, 8>& p) : k_{p[0], p[1], p[2], p[3]} {}
  ValueAndSlope operator()(double theta) const {
    const double s = theta * theta;
    return {theta * (1 + s * (k_[0] + s * (k_[1] + s * (k_[2] + s * k_[3])))),
            1 + s * (3 * k_[0] + s * (5 * k_[1] + s * (7 * k_[2] + s * 9 * k_[3])))};
  }
  static bool IsPole(double) { return false; }

 private:
  std::array<double, 4> k_;
};

// The end of the first stretch on which the curve grows, at most `end`; position(i / steps) samples
// the stretch from 0 to `end`.
template <class Curve, class Position>
double GrowthLimit(const Curve& curve, const Position& position) {
  constexpr int kSteps = 1024;
  const auto grows = [&](double r) { return !curve.IsPole(r) && curve(r).slope > 0; };
  double inside = 0;
  for (int i = 1; i <= kSteps; ++i) {
    double outside = position(static_cast<double>(i) / kSteps);
    if (grows(outside)) {
      inside = outside;
      continue;
    }
    for (int step = 0; step < 60; ++step) {
      const double middle = 0.5 * (inside + outside);
      (grows(middle) ? inside : outside) = middle;
    }
    return inside;
  }
  return inside;
}

// r in [0, limit] with curve(r) = rd, by Newton's method that never leaves the bracket.
template <class Curve>
double SolveRadius(const Curve& curve, double rd, double limit) {
  double low = 0, high = limit;
  double r = std::min(rd, limit);
  for (int step = 0; step < 200; ++step) {
    const ValueAndSlope at = curve(r);
    const double error = at.value - rd;
    if (error == 0) return r;
    (error < 0 ? low : high) = r;
    double next = r - error / at.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - r) <= 1e-16 * limit + 1e-15 * r) return next;
    r = next;
  }
  return r;
}

// The two-dimensional map of kRadialTangential and its derivatives.
struct Bent {
  Vec2 value;
  Eigen::Matrix2d jacobian;
};

Bent Bend(const std::array<double, 8>& p, const RadialCurve& curve, const Vec2& u) {
  const double x = u.x(), y = u.y(), s = x * x + y * y;
  const double p1 = p[2], p2 = p[3];
  const ValueAndSlope radial = curve.Factor(s);
  Bent bent;
  bent.value = {x * radial.value + 2 * p1 * x * y + p2 * (s + 2 * x * x),
                y * radial.value + p1 * (s + 2 * y * y) + 2 * p2 * x * y};
  const double cross = 2 * x * y * radial.slope + 2 * p1 * x + 2 * p2 * y;
  bent.jacobian << radial.value + 2 * x * x * radial.slope + 2 * p1 * y + 6 * p2 * x, cross,  //
      cross, radial.value + 2 * y * y * radial.slope + 6 * p1 * y + 2 * p2 * x;
  return bent;
}

std::optional<Vec2> UnbendRadialTangential(const std::array<double, 8>& p, const Vec2& distorted,
                                           double limit, double distorted_limit) {
  const RadialCurve curve(p);
  const double rd = distorted.norm();
  const bool is_radial = p[2] == 0 && p[3] == 0;
  if (rd == 0 && is_radial) return Vec2(0, 0);
  if (rd > distorted_limit && is_radial) return std::nullopt;
  const double start = SolveRadius(curve, std::min(rd, 0.999 * distorted_limit), limit);
  if (is_radial) {
    const double r = rd > 0.999 * distorted_limit ? SolveRadius(curve, rd, limit) : start;
    return distorted * (r / rd);
  }
  Vec2 u = rd > 0 ? Vec2(distorted * (start / rd)) : Vec2(0, 0);
  constexpr double kAccurate = 1e-12;
  for (int step = 0; step < 50; ++step) {
    const Bent bent = Bend(p, curve, u);
    const Vec2 error = bent.value - distorted;
    const double determinant = bent.jacobian.determinant();
    if (!(determinant > 0)) return std::nullopt;
    const Vec2 correction = bent.jacobian.inverse() * error;
    u -= correction;
    if (!(correction.norm() <= 1e-15 * (1 + u.norm()))) continue;
    if (u.norm() > limit) return std::nullopt;
    return u;
  }
  if (!((Bend(p, curve, u).value - distorted).norm() <= kAccurate) || u.norm() > limit)
    return std::nullopt;
  return u;
}

}  // namespace

DistortionMap::DistortionMap(const Distortion& distortion)
    : distortion_(distortion), limit_(kInfinity), distorted_limit_(kInfinity) {
  const std::array<double, 8>& p = distortion.parameters;
  switch (distortion.model) {
    case DistortionModel::kNone:
      return;
    case DistortionModel::kRadialTangential: {
      const RadialCurve curve(p);
      constexpr double kWidest = RadiansFromDegrees(89.5);
      limit_ = GrowthLimit(curve, [](double t) { return std::tan(t * kWidest); });
      distorted_limit_ = curve(limit_).value;
      return;
    }
    case DistortionModel::kFisheye: {
      const FisheyeCurve curve(p);
      limit_ = GrowthLimit(curve, [](double t) { return t * kPi; });
      distorted_limit_ = curve(limit_).value;
      return;
    }
    case DistortionModel::kFov:
      LF_CHECK(p[0] > 0 && p[0] < kPi);
      distorted_limit_ = 0.5 * kPi / p[0];
      return;
  }
}

std::optional<Vec2> DistortionMap::Distort(const Vec3& direction) const {
  const std::array<double, 8>& p = distortion_.parameters;
  const double z = direction.z();
  if (distortion_.model == DistortionModel::kFisheye) {
    const double across = direction.head<2>().norm();
    const double theta = std::atan2(across, z);
    if (!(theta <= limit_)) return std::nullopt;
    if (across == 0) return z > 0 ? std::optional(Vec2(0, 0)) : std::nullopt;
    return Vec2(direction.head<2>() * (FisheyeCurve(p)(theta).value / across));
  }
  if (!(z > 0)) return std::nullopt;
  const Vec2 u = direction.head<2>() / z;
  switch (distortion_.model) {
    case DistortionModel::kRadialTangential: {
      if (!(u.norm() <= limit_)) return std::nullopt;
      const Bent bent = Bend(p, RadialCurve(p), u);
      if (!(bent.jacobian.determinant() > 0)) return std::nullopt;
      return bent.value;
    }
    case DistortionModel::kFov: {
      const double r = u.norm();
      const double scale = 2 * std::tan(0.5 * p[0]);
      // Near the axis atan(r s) / (r omega) is s / omega to rounding.
      const double factor = r < 1e-9 ? scale / p[0] : std::atan(r * scale) / (r * p[0]);
      return Vec2(u * factor);
    }
    default:
      return u;
  }
}

std::optional<Vec3> DistortionMap::Undistort(const Vec2& distorted) const {
  const std::array<double, 8>& p = distortion_.parameters;
  const double rd = distorted.norm();
  // sin(a) / rd, smooth at 0.
  const auto sine_per = [rd](double a, double slope_at_0) {
    return rd < 1e-12 ? slope_at_0 : std::sin(a) / rd;
  };
  switch (distortion_.model) {
    case DistortionModel::kNone:
      break;
    case DistortionModel::kRadialTangential: {
      const std::optional<Vec2> u = UnbendRadialTangential(p, distorted, limit_, distorted_limit_);
      if (!u) return std::nullopt;
      return Vec3(u->x(), u->y(), 1);
    }
    case DistortionModel::kFisheye: {
      if (rd > distorted_limit_) return std::nullopt;
      const double theta = SolveRadius(FisheyeCurve(p), rd, limit_);
      const double factor = sine_per(theta, 1);
      return Vec3(distorted.x() * factor, distorted.y() * factor, std::cos(theta));
    }
    case DistortionModel::kFov: {
      if (!(rd < distorted_limit_)) return std::nullopt;
      const double angle = rd * p[0];
      const double factor = sine_per(angle, p[0]);
      return Vec3(distorted.x() * factor, distorted.y() * factor,
                  std::cos(angle) * 2 * std::tan(0.5 * p[0]));
    }
  }
  return Vec3(distorted.x(), distorted.y(), 1);
}

}  // namespace lf
