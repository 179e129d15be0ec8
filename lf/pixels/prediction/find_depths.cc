// SPDX-License-Identifier: Apache-2.0
#include "lf/pixels/prediction/find_depths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "lf/pixels/prediction/predict.h"

namespace lf {
namespace {

constexpr int kMostReducedSide = 400;
constexpr double kMostMove = 0.25;         // share of the longer side of the image
constexpr double kBeyondInfinity = 0.125;  // share of the greatest inverse depth
constexpr int kBlockBits = 3;
constexpr int kBlock = 1 << kBlockBits;
constexpr double kLeftOut = 0.01;  // share of blocks at each end of the range that are left out
constexpr size_t kLeastBlocks = 12;

// An image and its camera, as often halved.
struct View {
  Image<uint8_t> image;
  PinholeView camera;
};

View HalvedOnce(const Image<uint8_t>& image, const PinholeView& camera) {
  View half{Image<uint8_t>(image.width() / 2, image.height() / 2), Halved(camera)};
  for (int y = 0; y < half.image.height(); ++y)
    for (int x = 0; x < half.image.width(); ++x)
      half.image.at(x, y) =
          static_cast<uint8_t>((image.at(2 * x, 2 * y) + image.at(2 * x + 1, 2 * y) +
                                image.at(2 * x, 2 * y + 1) + image.at(2 * x + 1, 2 * y + 1) + 2) /
                               4);
  return half;
}

View Reduced(const Image<uint8_t>& image, const PinholeView& camera, int halvings) {
  View view{image, camera};
  for (int i = 0; i < halvings; ++i) view = HalvedOnce(view.image, view.camera);
  return view;
}

// Returns the largest move, in pixels of `other`, of a pixel of `view` for each unit of inverse
// depth, or how fast pixels come nearer to `other` if this is larger, in units in which kMostMove
// of its longer side is the limit.
double MovePerInverseDepth(const View& view, const View& other) {
  const Mat3 to_ray = view.camera.intrinsics.inverse();
  const RigidTransform other_from_view =
      other.camera.cam_from_world * view.camera.cam_from_world.Inverse();
  const Vec3 step = other.camera.intrinsics * other_from_view.translation;
  double most = 0;
  for (const double across : {0.0, 0.5, 1.0})
    for (const double down : {0.0, 0.5, 1.0}) {
      const Vec3 pixel(across * view.image.width(), down * view.image.height(), 1);
      const Vec3 far = other.camera.intrinsics * (other_from_view.rotation * (to_ray * pixel));
      const double w = std::abs(far.z());
      if (!(w > 0)) continue;
      const double move_x = (step.x() - far.x() / far.z() * step.z()) / w;
      const double move_y = (step.y() - far.y() / far.z() * step.z()) / w;
      // The depth of a pixel in `other` may halve.
      const double nearer = 2 * kMostMove * std::max(other.image.width(), other.image.height()) *
                            std::abs(step.z()) / w;
      most = std::max({most, std::hypot(move_x, move_y), nearer});
    }
  return most;
}

// Returns for each block, row by row, the index of its depth; nothing if no depth stands out.
std::vector<std::optional<int>> DepthsOfBlocks(const View& view, const View& other,
                                               const PlaneWarp& warp) {
  PredictionPlan plan{{warp},
                      MakeBlockField(view.image.width(), view.image.height(), kBlockBits, 1)};
  const ReferencePart<uint8_t> part = {other.image.view(), 0, 0, other.image.width(),
                                       other.image.height()};
  const int columns = view.image.width() / kBlock, rows = view.image.height() / kBlock;
  const auto count = static_cast<size_t>(columns) * static_cast<size_t>(rows);
  std::vector<std::array<int, kDepthSteps>> costs(count);
  Image<uint8_t> predicted(view.image.width(), view.image.height());
  for (int depth = 0; depth < kDepthSteps; ++depth) {
    std::fill(plan.blocks.depths.begin(), plan.blocks.depths.end(), static_cast<uint8_t>(depth));
    Predict<uint8_t>(plan, {&part, 1}, {0, 0, predicted.width(), predicted.height()},
                     predicted.view());
    for (size_t block = 0; block < count; ++block) {
      const int left = static_cast<int>(block) % columns * kBlock;
      const int top = static_cast<int>(block) / columns * kBlock;
      int sum = 0;
      for (int y = top; y < top + kBlock; ++y)
        for (int x = left; x < left + kBlock; ++x)
          sum += std::abs(predicted.at(x, y) - view.image.at(x, y));
      costs[block][static_cast<size_t>(depth)] = sum;
    }
  }
  std::vector<std::optional<int>> depths(count);
  for (size_t block = 0; block < count; ++block) {
    std::array<int, kDepthSteps> sorted = costs[block];
    const auto best =
        static_cast<int>(std::min_element(sorted.begin(), sorted.end()) - sorted.begin());
    const int least = sorted[static_cast<size_t>(best)];
    const auto quarter = sorted.begin() + kDepthSteps / 4;
    std::nth_element(sorted.begin(), quarter, sorted.end());
    // Three quarters of the depths are clearly worse than the best, by a grey step on average.
    if (*quarter > 2 * least + kBlock * kBlock) depths[block] = best;
  }
  return depths;
}

// Returns the part of the range that blocks have, with a step of the range more at both ends;
// nothing if there are hardly any.
std::optional<InverseDepthRange> Narrowed(const View& view, const View& other,
                                          const InverseDepthRange& range) {
  const std::optional<PlaneWarp> warp = MakePlaneWarp(view.camera, other.camera, range);
  if (!warp) return std::nullopt;
  std::vector<int> found;
  for (const std::optional<int>& depth : DepthsOfBlocks(view, other, *warp))
    if (depth) found.push_back(*depth);
  if (found.size() < kLeastBlocks) return std::nullopt;
  std::sort(found.begin(), found.end());
  const auto left_out = static_cast<size_t>(kLeftOut * static_cast<double>(found.size()));
  const double step = (range.greatest - range.least) / (kDepthSteps - 1);
  const double first = found[left_out] - 1, last = found[found.size() - 1 - left_out] + 1;
  return InverseDepthRange{std::max(range.least, range.least + step * first),
                           std::min(range.greatest, range.least + step * last)};
}

}  // namespace

InverseDepthRange FindInverseDepths(const Image<uint8_t>& image, const PinholeView& view,
                                    const Image<uint8_t>& other, const PinholeView& other_view) {
  int halvings = 0;
  while (std::max(image.width(), image.height()) >> halvings > kMostReducedSide) ++halvings;
  const View here = Reduced(image, view, halvings);
  const View there = Reduced(other, other_view, halvings);
  const double move = MovePerInverseDepth(here, there);
  const double most = kMostMove * std::max(here.image.width(), here.image.height()) / move;
  if (!(move > 0) || !std::isfinite(most)) return {0, 1};
  const InverseDepthRange whole = {-kBeyondInfinity * most, most};
  if (std::min(here.image.width(), here.image.height()) < kBlock) return whole;
  const std::optional<InverseDepthRange> first = Narrowed(here, there, whole);
  if (!first) return whole;
  return Narrowed(here, there, *first).value_or(*first);
}

}  // namespace lf
