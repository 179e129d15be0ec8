// SPDX-License-Identifier: Apache-2.0
#include "lf/import/agreement/image_features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lf {
namespace {

constexpr int kHalfWindow = 8;  // half width of the pixels that a descriptor describes
constexpr int kBorder = 12;     // least distance of a corner from the border of the image
constexpr int kBucketsPerRow = 8;
// Corners whose smaller eigenvalue is below this, of light from 0 to 1, are noise.
constexpr float kLeastResponse = 4e-5f;

struct Gradients {
  Image<float> dx, dy;
};

// Returns derivatives of the image, smoothed by 1 2 1 along both axes; NaN beside masked pixels.
Gradients GradientsOf(const Image<float>& light) {
  const int width = light.width(), height = light.height();
  Gradients result{Image<float>(width, height), Image<float>(width, height)};
  for (int y = 1; y + 1 < height; ++y) {
    const float *above = light.row(y - 1), *here = light.row(y), *below = light.row(y + 1);
    for (int x = 1; x + 1 < width; ++x) {
      result.dx.at(x, y) = 0.125f * (above[x + 1] - above[x - 1] + 2 * (here[x + 1] - here[x - 1]) +
                                     below[x + 1] - below[x - 1]);
      result.dy.at(x, y) = 0.125f * (below[x - 1] - above[x - 1] + 2 * (below[x] - above[x]) +
                                     below[x + 1] - above[x + 1]);
    }
  }
  return result;
}

// Sums 5 x 5 values around each pixel with the weights 1 4 6 4 1 along both axes.
Image<float> Blurred(const Image<float>& values) {
  constexpr std::array<float, 5> kWeights = {1 / 16.f, 4 / 16.f, 6 / 16.f, 4 / 16.f, 1 / 16.f};
  const int width = values.width(), height = values.height();
  Image<float> rows(width, height), result(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 2; x + 2 < width; ++x)
      for (int i = 0; i < 5; ++i)
        rows.at(x, y) += kWeights[static_cast<size_t>(i)] * values.at(x + i - 2, y);
  for (int y = 2; y + 2 < height; ++y)
    for (int i = 0; i < 5; ++i)
      for (int x = 0; x < width; ++x)
        result.at(x, y) += kWeights[static_cast<size_t>(i)] * rows.at(x, y + i - 2);
  return result;
}

// Returns the smaller eigenvalue of the structure tensor of each pixel; NaN near masked pixels.
Image<float> CornerResponse(const Gradients& gradients) {
  const int width = gradients.dx.width(), height = gradients.dx.height();
  Image<float> xx(width, height), xy(width, height), yy(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float dx = gradients.dx.at(x, y), dy = gradients.dy.at(x, y);
      xx.at(x, y) = dx * dx;
      xy.at(x, y) = dx * dy;
      yy.at(x, y) = dy * dy;
    }
  xx = Blurred(xx);
  xy = Blurred(xy);
  yy = Blurred(yy);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float half = (xx.at(x, y) - yy.at(x, y)) / 2;
      xx.at(x, y) =
          (xx.at(x, y) + yy.at(x, y)) / 2 - std::sqrt(half * half + xy.at(x, y) * xy.at(x, y));
    }
  return xx;
}

struct Corner {
  int x = 0, y = 0;
  float response = 0;
};

bool IsLargestAround(const Image<float>& response, int x, int y) {
  constexpr int kReach = 3;
  const float here = response.at(x, y);
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx) {
      if (!(response.at(x + dx, y + dy) <= here)) return false;  // also if it is NaN
    }
  return true;
}

// Returns the strongest corners of each of the buckets into which the image is divided, so that a
// textured part does not take all.
std::vector<Corner> SpreadCorners(const Image<float>& response, size_t most) {
  const int width = response.width(), height = response.height();
  const int bucket = std::max(1, (width + kBucketsPerRow - 1) / kBucketsPerRow);
  const auto columns = static_cast<size_t>((width + bucket - 1) / bucket);
  const auto rows = static_cast<size_t>((height + bucket - 1) / bucket);
  std::vector<std::vector<Corner>> buckets(columns * rows);
  float strongest = 0;
  for (int y = kBorder; y < height - kBorder; ++y)
    for (int x = kBorder; x < width - kBorder; ++x) {
      const float r = response.at(x, y);
      if (!(r > kLeastResponse) || !IsLargestAround(response, x, y)) continue;
      strongest = std::max(strongest, r);
      buckets[static_cast<size_t>(y / bucket) * columns + static_cast<size_t>(x / bucket)]
          .push_back({x, y, r});
    }
  std::vector<Corner> corners;
  const size_t share = std::max<size_t>(1, 2 * most / buckets.size());
  for (std::vector<Corner>& one : buckets) {
    std::sort(one.begin(), one.end(),
              [](const Corner& a, const Corner& b) { return a.response > b.response; });
    one.resize(std::min(one.size(), share));
    for (const Corner& corner : one)
      if (corner.response > 0.002f * strongest) corners.push_back(corner);
  }
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.response > b.response; });
  corners.resize(std::min(corners.size(), most));
  return corners;
}

// Returns the offset, along one axis, of the vertex of the parabola through three responses.
double Vertex(double before, double here, double after) {
  const double bend = before - 2 * here + after;
  return bend < 0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

Descriptor DescribedAt(const Gradients& gradients, const Corner& corner) {
  Descriptor result = Descriptor::Zero();
  for (int dy = -kHalfWindow; dy < kHalfWindow; ++dy)
    for (int dx = -kHalfWindow; dx < kHalfWindow; ++dx) {
      const float gx = gradients.dx.at(corner.x + dx, corner.y + dy);
      const float gy = gradients.dy.at(corner.x + dx, corner.y + dy);
      const float length = std::sqrt(gx * gx + gy * gy);
      if (!(length > 0)) continue;  // also if a pixel is masked
      const float far2 = static_cast<float>((dx + 0.5) * (dx + 0.5) + (dy + 0.5) * (dy + 0.5));
      const float weight = length * std::exp(-far2 / (2 * 64));
      // The value is shared between the nearest cells and directions.
      const double u = (dx + kHalfWindow + 0.5) / 4 - 0.5, v = (dy + kHalfWindow + 0.5) / 4 - 0.5;
      const double turn = (std::atan2(gy, gx) / kPi + 1) * 4;
      const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v)),
                t0 = static_cast<int>(std::floor(turn));
      for (int i = 0; i < 8; ++i) {
        const int column = u0 + (i & 1), row = v0 + (i >> 1 & 1), bin = (t0 + (i >> 2)) & 7;
        if (column < 0 || column > 3 || row < 0 || row > 3) continue;
        const double part = (1 - std::abs(u - column)) * (1 - std::abs(v - row)) *
                            (1 - std::abs(turn - (t0 + (i >> 2))));
        result[(row * 4 + column) * 8 + bin] += weight * static_cast<float>(part);
      }
    }
  if (!(result.norm() > 0)) return result;
  result.normalize();
  result = result.cwiseMin(0.2f);  // as Lowe: one strong edge must not outweigh all others
  return result.normalized();
}

}  // namespace

ImageFeatures FindFeatures(const ReducedImage& image, size_t most) {
  ImageFeatures features;
  if (std::min(image.light.width(), image.light.height()) <= 2 * kBorder) return features;
  const Gradients gradients = GradientsOf(image.light);
  const Image<float> response = CornerResponse(gradients);
  const std::vector<Corner> corners = SpreadCorners(response, most);
  for (const Corner& corner : corners) {
    const auto [x, y, here] = corner;
    const double dx = Vertex(response.at(x - 1, y), here, response.at(x + 1, y));
    const double dy = Vertex(response.at(x, y - 1), here, response.at(x, y + 1));
    features.at_px.push_back(Vec2(x + 0.5 + dx, y + 0.5 + dy) * image.divisor);
    features.descriptors.push_back(DescribedAt(gradients, corner));
  }
  return features;
}

}  // namespace lf
