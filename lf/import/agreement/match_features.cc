// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lf/core/random.h"
#include "lf/import/agreement/image_features.h"

namespace lf {
namespace {

constexpr size_t kLeastMatches = 16;
constexpr double kLeastShare = 0.5;  // least share of the matches that lie on epipolar lines

// Returns the pairs of corners that are each other's nearest, by the angle between descriptors. The
// second nearest must be clearly farther away.
std::vector<FeatureMatch> MutualMatches(const ImageFeatures& a, const ImageFeatures& b) {
  constexpr float kMostRatio = 0.8f;  // distance to the nearest / distance to the second nearest
  // The largest and the second largest likeness (cosine) of each corner, and the index of the
  // largest.
  struct Best {
    float first = -1, second = -1;
    size_t index = 0;
    void Take(float likeness, size_t other) {
      if (likeness > first) {
        second = std::exchange(first, likeness);
        index = other;
      } else {
        second = std::max(second, likeness);
      }
    }
  };
  std::vector<Best> of_a(a.size()), of_b(b.size());
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t j = 0; j < b.size(); ++j) {
      const float likeness = a.descriptors[i].dot(b.descriptors[j]);
      of_a[i].Take(likeness, j);
      of_b[j].Take(likeness, i);
    }
  const auto distance = [](float cosine) { return std::sqrt(std::max(0.f, 2 - 2 * cosine)); };
  std::vector<FeatureMatch> matches;
  for (size_t i = 0; i < a.size(); ++i) {
    const Best& back = of_b[of_a[i].index];
    if (back.index == i &&
        distance(of_a[i].first) < kMostRatio * distance(std::max(of_a[i].second, back.second)))
      matches.push_back({static_cast<uint32_t>(i), static_cast<uint32_t>(of_a[i].index)});
  }
  return matches;
}

// Positions moved and scaled so that the eight-point algorithm is well conditioned (Hartley 1997).
struct Normalised {
  explicit Normalised(const std::vector<Vec2>& points) {
    for (const Vec2& point : points) middle += point / static_cast<double>(points.size());
    for (const Vec2& point : points)
      scale += (point - middle).norm() / static_cast<double>(points.size());
    scale = std::sqrt(2) / std::max(scale, 1e-9);
  }
  Vec3 Of(const Vec2& point) const {
    return {(point.x() - middle.x()) * scale, (point.y() - middle.y()) * scale, 1};
  }
  Vec2 middle = Vec2::Zero();
  double scale = 0;
};

// Returns the fundamental matrix F of eight or more pairs, for which b F a = 0.
Mat3 FundamentalOf(const std::vector<std::pair<Vec3, Vec3>>& pairs) {
  Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
  for (const auto& [a, b] : pairs) {
    Eigen::Matrix<double, 9, 1> row;
    row << b.x() * a, b.y() * a, b.z() * a;
    normal += row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
  const Eigen::Matrix<double, 9, 1> f = solver.eigenvectors().col(0);
  Mat3 result;
  result << f.segment<3>(0).transpose(), f.segment<3>(3).transpose(), f.segment<3>(6).transpose();
  return result;
}

// Returns the squared distance of a pair from the epipolar geometry (Sampson).
double Distance2(const Mat3& f, const Vec3& a, const Vec3& b) {
  const Vec3 fa = f * a, fb = f.transpose() * b;
  const double slope = fa.head<2>().squaredNorm() + fb.head<2>().squaredNorm();
  const double residual = b.dot(fa);
  return slope > 0 ? residual * residual / slope : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<FeatureMatch> MatchFeatures(const ImageFeatures& a, const ImageFeatures& b,
                                        double tolerance_px) {
  constexpr uint64_t kTrials = 200;
  if (a.size() < kLeastMatches || b.size() < kLeastMatches) return {};
  const std::vector<FeatureMatch> matches = MutualMatches(a, b);
  if (matches.size() < kLeastMatches) return {};
  const Normalised of_a(a.at_px), of_b(b.at_px);
  std::vector<std::pair<Vec3, Vec3>> pairs;
  for (const FeatureMatch& match : matches)
    pairs.push_back({of_a.Of(a.at_px[match.a]), of_b.Of(b.at_px[match.b])});
  const double tolerance = tolerance_px * std::min(of_a.scale, of_b.scale);
  std::vector<size_t> best;
  const auto try_matrix = [&](const Mat3& f) {
    std::vector<size_t> inside;
    for (size_t i = 0; i < pairs.size(); ++i)
      if (Distance2(f, pairs[i].first, pairs[i].second) < tolerance * tolerance)
        inside.push_back(i);
    if (inside.size() > best.size()) best = std::move(inside);
  };
  for (uint64_t trial = 0; trial < kTrials; ++trial) {
    std::vector<std::pair<Vec3, Vec3>> sample;
    for (uint64_t i = 0; i < 8; ++i)
      sample.push_back(pairs[RandomBits(61, trial, i) % pairs.size()]);
    try_matrix(FundamentalOf(sample));
  }
  for (int round = 0; round < 2 && best.size() >= 8; ++round) {
    std::vector<std::pair<Vec3, Vec3>> inside;
    for (const size_t i : best) inside.push_back(pairs[i]);
    try_matrix(FundamentalOf(inside));
  }
  if (best.size() < kLeastMatches ||
      static_cast<double>(best.size()) < kLeastShare * static_cast<double>(matches.size()))
    return {};
  std::vector<FeatureMatch> result;
  for (const size_t i : best) result.push_back(matches[i]);
  return result;
}

}  // namespace lf
