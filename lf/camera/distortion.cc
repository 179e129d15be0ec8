// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/distortion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/core/check.h"

namespace lf {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

struct ValueAndSlope {
  double value = 0;
  double slope = 0;
};

// The radial part of kRadialTangential and kBrown: the radius rd = r numerator(r^2) /
// denominator(r^2), and its derivative by r.
class RadialCurve {
 public:
  explicit RadialCurve(const Distortion& distortion) {
    const DistortionParameters& p = distortion.parameters;
    numerator_ = {p[0], p[1], p[4], 0};
    if (distortion.model == DistortionModel::kBrown)
      numerator_[3] = p[5];
    else
      denominator_ = {p[5], p[6], p[7], 0};
  }

  // Returns numerator(s) / denominator(s), with s = r^2, and its derivative by s.
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
  static ValueAndSlope Evaluate(const std::array<double, 4>& k, double s) {
    return {1 + s * (k[0] + s * (k[1] + s * (k[2] + s * k[3]))),
            k[0] + s * (2 * k[1] + s * 3 * k[2] + s * s * 4 * k[3])};
  }
  std::array<double, 4> numerator_ = {}, denominator_ = {};  // factors of s, s^2, s^3 and s^4
};

// The radial part of kFisheye: the radius rd = theta (1 + k1 theta^2 + ... + k4 theta^8), and its
// derivative by theta.
class FisheyeCurve {
 public:
  explicit FisheyeCurve(const std::array<double, 4>& k) : k_(k) {}
  ValueAndSlope operator()(double theta) const {
    const double s = theta * theta;
    return {theta * (1 + s * (k_[0] + s * (k_[1] + s * (k_[2] + s * k_[3])))),
            1 + s * (3 * k_[0] + s * (5 * k_[1] + s * (7 * k_[2] + s * 9 * k_[3])))};
  }
  static bool IsPole(double) { return false; }

 private:
  std::array<double, 4> k_;
};

// The radial part of kRadialTangentialThinPrism: the radius theta (1 + k0 theta^2 + ... + k5
// theta^12), and its derivative by theta.
class LongFisheyeCurve {
 public:
  explicit LongFisheyeCurve(const DistortionParameters& p) {
    std::copy_n(p.begin(), k_.size(), k_.begin());
  }
  // Returns the factor 1 + k0 s + ... + k5 s^6, with s = theta^2, and its derivative by s.
  ValueAndSlope Factor(double s) const {
    ValueAndSlope factor{0, 0};
    for (size_t i = k_.size(); i-- > 0;) {
      factor.slope = factor.slope * s + factor.value;
      factor.value = factor.value * s + k_[i];
    }
    return {1 + s * factor.value, factor.value + s * factor.slope};
  }
  ValueAndSlope operator()(double theta) const {
    const double s = theta * theta;
    const ValueAndSlope factor = Factor(s);
    return {theta * factor.value, factor.value + 2 * s * factor.slope};
  }
  static bool IsPole(double) { return false; }

 private:
  std::array<double, 6> k_;
};

std::array<double, 4> FirstFour(const DistortionParameters& p) { return {p[0], p[1], p[2], p[3]}; }

// Returns the radial part of kThinPrism: the radius at angle theta is
// theta (1 + k1 theta^2 + ... + k4 theta^8).
FisheyeCurve ThinPrismCurve(const DistortionParameters& p) {
  return FisheyeCurve({p[0], p[1], p[4], p[5]});
}

// Returns the end of the interval [0, end) in which the curve increases; at most position(1). The
// curve is sampled at the radii position(t), with t from 0 to 1.
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

// Returns r in [0, limit] with curve(r) = rd, by Newton's method safeguarded by bisection.
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

// Image of a point under a two-dimensional map, and the derivatives of the map there.
struct Bent {
  Vec2 value;
  Eigen::Matrix2d jacobian;
};

// Returns the distorted position of u = (x, y) by kRadialTangential or kBrown.
Bent Bend(const DistortionParameters& p, const RadialCurve& curve, const Vec2& u) {
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

// Returns the distorted position of `at` = (u, v) by kThinPrism.
Bent BendThinPrism(const DistortionParameters& p, const Vec2& at) {
  const double u = at.x(), v = at.y(), s = u * u + v * v;
  const double p1 = p[2], p2 = p[3], sx1 = p[6], sy1 = p[7];
  const double radial = 1 + s * (p[0] + s * (p[1] + s * (p[4] + s * p[5])));
  const double slope = p[0] + s * (2 * p[1] + s * (3 * p[4] + s * 4 * p[5]));
  Bent bent;
  bent.value = {u * radial + 2 * p1 * u * v + p2 * (s + 2 * u * u) + sx1 * s,
                v * radial + 2 * p2 * u * v + p1 * (s + 2 * v * v) + sy1 * s};
  const double cross = 2 * u * v * slope + 2 * p1 * u + 2 * p2 * v;
  bent.jacobian << radial + 2 * u * u * slope + 2 * p1 * v + 6 * p2 * u + 2 * sx1 * u,
      cross + 2 * sx1 * v,  //
      cross + 2 * sy1 * u, radial + 2 * v * v * slope + 6 * p1 * v + 2 * p2 * u + 2 * sy1 * v;
  return bent;
}

// Returns the distorted position of `at` = (u, v) by kRadialTangentialThinPrism.
Bent BendRadialTangentialThinPrism(const DistortionParameters& p, const Vec2& at) {
  const double u = at.x(), v = at.y();
  const ValueAndSlope radial = LongFisheyeCurve(p).Factor(u * u + v * v);
  const double cross = 2 * u * v * radial.slope;
  Eigen::Matrix2d inner;                                    // derivatives of (a, b) by (u, v)
  inner << radial.value + 2 * u * u * radial.slope, cross,  //
      cross, radial.value + 2 * v * v * radial.slope;
  const double a = u * radial.value, b = v * radial.value, q = a * a + b * b;
  const double p0 = p[6], p1 = p[7], s0 = p[8], s1 = p[9], s2 = p[10], s3 = p[11];
  const double slope_x = 2 * (s0 + 2 * s1 * q), slope_y = 2 * (s2 + 2 * s3 * q);
  Bent bent;
  bent.value = {a + p0 * (q + 2 * a * a) + 2 * p1 * a * b + q * (s0 + s1 * q),
                b + p1 * (q + 2 * b * b) + 2 * p0 * a * b + q * (s2 + s3 * q)};
  Eigen::Matrix2d outer;  // derivatives of (xd, yd) by (a, b)
  outer << 1 + 6 * p0 * a + 2 * p1 * b + slope_x * a, 2 * p0 * b + 2 * p1 * a + slope_x * b,  //
      2 * p1 * a + 2 * p0 * b + slope_y * a, 1 + 6 * p1 * b + 2 * p0 * a + slope_y * b;
  bent.jacobian = outer * inner;
  return bent;
}

// Returns the point that bend() maps to `distorted`, by Newton's method from `start`. None if the
// iteration finds no such point, or one that is farther than `limit` from the origin.
template <class BendIt>
std::optional<Vec2> Unbend(const BendIt& bend, const Vec2& distorted, Vec2 start, double limit) {
  constexpr double kAccurate = 1e-12;
  Vec2& u = start;
  for (int step = 0; step < 50; ++step) {
    const Bent bent = bend(u);
    const Vec2 error = bent.value - distorted;
    const double determinant = bent.jacobian.determinant();
    if (!(determinant > 0)) return std::nullopt;
    const Vec2 correction = bent.jacobian.inverse() * error;
    u -= correction;
    if (!(correction.norm() <= 1e-15 * (1 + u.norm()))) continue;
    if (u.norm() > limit) return std::nullopt;
    return u;
  }
  if (!((bend(u).value - distorted).norm() <= kAccurate) || u.norm() > limit) return std::nullopt;
  return u;
}

std::optional<Vec2> UnbendRadialTangential(const Distortion& distortion, const Vec2& distorted,
                                           double limit, double distorted_limit) {
  const DistortionParameters& p = distortion.parameters;
  const RadialCurve curve(distortion);
  const double rd = distorted.norm();
  const bool is_radial = p[2] == 0 && p[3] == 0;
  if (rd == 0 && is_radial) return Vec2(0, 0);
  if (rd > distorted_limit && is_radial) return std::nullopt;
  const double start = SolveRadius(curve, std::min(rd, 0.999 * distorted_limit), limit);
  if (is_radial) {
    const double r = rd > 0.999 * distorted_limit ? SolveRadius(curve, rd, limit) : start;
    return distorted * (r / rd);
  }
  const Vec2 u = rd > 0 ? Vec2(distorted * (start / rd)) : Vec2(0, 0);
  return Unbend([&](const Vec2& at) { return Bend(p, curve, at); }, distorted, u, limit);
}

// Returns the direction whose ideal fish-eye image bend() maps to `distorted`. None if the
// iteration does not find that image, or if the image is farther than `limit` from the origin. The
// iteration starts at the solution for the radial part alone.
template <class Curve, class BendIt>
std::optional<Vec3> UnbendEquidistant(const Curve& curve, const BendIt& bend, const Vec2& distorted,
                                      double limit, double distorted_limit) {
  const double rd = distorted.norm();
  const double start = SolveRadius(curve, std::min(rd, 0.999 * distorted_limit), limit);
  const Vec2 u = rd > 0 ? Vec2(distorted * (start / rd)) : Vec2(0, 0);
  const std::optional<Vec2> at = Unbend(bend, distorted, u, limit);
  if (!at) return std::nullopt;
  const double theta = at->norm();
  const double factor = theta < 1e-12 ? 1 : std::sin(theta) / theta;
  return Vec3(at->x() * factor, at->y() * factor, std::cos(theta));
}

// Returns the image of a direction (X, Y, Z) in an ideal fish-eye: (X, Y) theta / sqrt(X^2 + Y^2),
// where theta is the angle from the optical axis. None if theta exceeds `limit`, or if the
// direction is exactly backwards.
std::optional<Vec2> Equidistant(const Vec3& direction, double limit) {
  const double across = direction.head<2>().norm();
  const double theta = std::atan2(across, direction.z());
  if (!(theta <= limit)) return std::nullopt;
  if (across == 0) return direction.z() > 0 ? std::optional(Vec2(0, 0)) : std::nullopt;
  return Vec2(direction.head<2>() * (theta / across));
}

// The limits of a distortion, as members of DistortionMap.
struct Limits {
  double limit = kNoLimit;
  double distorted_limit = kNoLimit;
};

template <class Curve, class Position>
Limits LimitsOf(const Curve& curve, const Position& position) {
  const double limit = GrowthLimit(curve, position);
  return {limit, curve(limit).value};
}

Limits FindLimits(const Distortion& distortion) {
  const DistortionParameters& p = distortion.parameters;
  const auto angle = [](double t) { return t * kPi; };
  switch (distortion.model) {
    case DistortionModel::kNone:
      return {};
    case DistortionModel::kRadialTangential:
    case DistortionModel::kBrown: {
      constexpr double kWidest = RadiansFromDegrees(89.5);
      return LimitsOf(RadialCurve(distortion), [](double t) { return std::tan(t * kWidest); });
    }
    case DistortionModel::kFisheye:
      return LimitsOf(FisheyeCurve(FirstFour(p)), angle);
    case DistortionModel::kFov:
      return {kNoLimit, 0.5 * kPi / p[0]};
    case DistortionModel::kDivision:
      // At this rd, r = rd / (1 + k rd^2) has its maximum (k > 0) or a pole (k < 0).
      return {kNoLimit, p[0] == 0 ? kNoLimit : 1 / std::sqrt(std::abs(p[0]))};
    case DistortionModel::kUnified: {
      // rd approaches 1 / far as r goes to infinity.
      const double far = p[0] * std::sqrt(p[1]);
      return {kNoLimit, far > 0 ? 1 / far : kNoLimit};
    }
    case DistortionModel::kThinPrism:
      return LimitsOf(ThinPrismCurve(p), angle);
    case DistortionModel::kRadialTangentialThinPrism:
      return LimitsOf(LongFisheyeCurve(p), angle);
  }
  return {};
}

// Returns FindLimits(distortion). Remembers the results for the distortions that the thread asked
// for last, because finding the limits takes tens of microseconds, and a light field has few lenses
// but maps are made for each LF image and frame.
Limits RememberedLimits(const Distortion& distortion) {
  struct Known {
    Distortion distortion;  // none at first, which has no limits
    Limits limits;
  };
  constexpr size_t kMostKnown = 8;
  thread_local std::array<Known, kMostKnown> known;
  thread_local size_t oldest = 0;
  for (const Known& k : known)
    if (k.distortion == distortion) return k.limits;
  known[oldest] = {distortion, FindLimits(distortion)};
  const Limits& limits = known[oldest].limits;
  oldest = (oldest + 1) % kMostKnown;
  return limits;
}

}  // namespace

bool IsDistortion(const Distortion& distortion) {
  const DistortionParameters& p = distortion.parameters;
  switch (distortion.model) {
    case DistortionModel::kFov:
      return p[0] > 0 && p[0] < kPi;
    case DistortionModel::kUnified:
      return p[0] >= 0 && p[0] <= 1 && p[1] > 0;
    default:
      return true;
  }
}

DistortionMap::DistortionMap(const Distortion& distortion) : distortion_(distortion) {
  LF_CHECK(IsDistortion(distortion));
  const Limits limits = RememberedLimits(distortion);
  limit_ = limits.limit;
  distorted_limit_ = limits.distorted_limit;
}

std::optional<Vec2> DistortionMap::Distort(const Vec3& direction) const {
  const DistortionParameters& p = distortion_.parameters;
  const double z = direction.z();
  if (distortion_.model == DistortionModel::kFisheye) {
    const double across = direction.head<2>().norm();
    const double theta = std::atan2(across, z);
    if (!(theta <= limit_)) return std::nullopt;
    if (across == 0) return z > 0 ? std::optional(Vec2(0, 0)) : std::nullopt;
    return Vec2(direction.head<2>() * (FisheyeCurve(FirstFour(p))(theta).value / across));
  }
  const bool is_long = distortion_.model == DistortionModel::kRadialTangentialThinPrism;
  if (is_long || distortion_.model == DistortionModel::kThinPrism) {
    const std::optional<Vec2> at = Equidistant(direction, limit_);
    if (!at) return std::nullopt;
    const Bent bent = is_long ? BendRadialTangentialThinPrism(p, *at) : BendThinPrism(p, *at);
    return bent.jacobian.determinant() > 0 ? std::optional(bent.value) : std::nullopt;
  }
  if (!(z > 0)) return std::nullopt;
  const Vec2 u = direction.head<2>() / z;
  switch (distortion_.model) {
    case DistortionModel::kRadialTangential:
    case DistortionModel::kBrown: {
      if (!(u.norm() <= limit_)) return std::nullopt;
      const Bent bent = Bend(p, RadialCurve(distortion_), u);
      if (!(bent.jacobian.determinant() > 0)) return std::nullopt;
      return bent.value;
    }
    case DistortionModel::kFov: {
      const double r = u.norm();
      const double scale = 2 * std::tan(0.5 * p[0]);
      // Near the axis, atan(r scale) / (r omega) equals scale / omega up to rounding.
      const double factor = r < 1e-9 ? scale / p[0] : std::atan(r * scale) / (r * p[0]);
      return Vec2(u * factor);
    }
    case DistortionModel::kDivision: {
      const double root = 1 - 4 * p[0] * u.squaredNorm();
      if (!(root > 0)) return std::nullopt;
      return Vec2(u * (2 / (1 + std::sqrt(root))));
    }
    case DistortionModel::kUnified:
      return Vec2(u / (p[0] * std::sqrt(p[1] * u.squaredNorm() + 1) + 1 - p[0]));
    default:
      return u;
  }
}

std::optional<Vec3> DistortionMap::Undistort(const Vec2& distorted) const {
  const DistortionParameters& p = distortion_.parameters;
  const double rd = distorted.norm();
  // Returns sin(a) / rd, or its limit `slope_at_0` if rd is almost 0.
  const auto sine_per = [rd](double a, double slope_at_0) {
    return rd < 1e-12 ? slope_at_0 : std::sin(a) / rd;
  };
  switch (distortion_.model) {
    case DistortionModel::kNone:
      break;
    case DistortionModel::kRadialTangential:
    case DistortionModel::kBrown: {
      const std::optional<Vec2> u =
          UnbendRadialTangential(distortion_, distorted, limit_, distorted_limit_);
      if (!u) return std::nullopt;
      return Vec3(u->x(), u->y(), 1);
    }
    case DistortionModel::kFisheye: {
      if (rd > distorted_limit_) return std::nullopt;
      const double theta = SolveRadius(FisheyeCurve(FirstFour(p)), rd, limit_);
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
    case DistortionModel::kDivision:
      if (!(rd < distorted_limit_)) return std::nullopt;
      return Vec3(distorted.x(), distorted.y(), 1 + p[0] * rd * rd);
    case DistortionModel::kUnified: {
      if (!(rd < distorted_limit_)) return std::nullopt;
      const double root = 1 - (2 * p[0] - 1) * p[1] * rd * rd;
      const double depth =
          (1 - p[1] * p[0] * p[0] * rd * rd) / (p[0] * std::sqrt(std::max(0.0, root)) + 1 - p[0]);
      return depth > 0 ? std::optional(Vec3(distorted.x(), distorted.y(), depth)) : std::nullopt;
    }
    case DistortionModel::kThinPrism:
      return UnbendEquidistant(
          ThinPrismCurve(p), [&p](const Vec2& at) { return BendThinPrism(p, at); }, distorted,
          limit_, distorted_limit_);
    case DistortionModel::kRadialTangentialThinPrism:
      return UnbendEquidistant(
          LongFisheyeCurve(p),
          [&p](const Vec2& at) { return BendRadialTangentialThinPrism(p, at); }, distorted, limit_,
          distorted_limit_);
  }
  return Vec3(distorted.x(), distorted.y(), 1);
}

}  // namespace lf
