// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/load/measure_footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

namespace lf {
namespace {

constexpr double kLeastStep = 0.08;  // least radiance by which the two sides of an edge differ
constexpr double kFlat = 0.1;        // largest step beside an edge, as a share of the edge's step
constexpr int kLeastEdges = 200;
// Fewer edges of a mosaic, which shows few, may all be the same one, repeated in a pattern.
constexpr int kLeastEdgesOfMosaics = 500;
// Pixels show points if a smaller share of the edges has a value between their two sides.
constexpr double kMostOfPoints = 0.3;
constexpr int kMostSide_px = 2048;  // most width and height of the part of an LF image that is read

struct Edges {
  int count = 0;
  int with_value_between = 0;
};

// Counts the edge at the middle one of five pixels in a row, column or diagonal, if there is an
// edge.
void CountEdge(const std::array<double, 5>& value, double least_step, Edges* edges) {
  const double step = value[3] - value[1];
  const double flat = kFlat * std::abs(step);
  if (std::abs(step) < least_step || std::abs(value[1] - value[0]) > flat ||
      std::abs(value[4] - value[3]) > flat)
    return;
  constexpr double kEnd = 0.15;
  const double between = (value[2] - value[1]) / step;
  if (between < -kEnd || between > 1 + kEnd) return;  // the pixel is on a thin line, not at an edge
  ++edges->count;
  if (between > kEnd && between < 1 - kEnd) ++edges->with_value_between;
}

void CountEdges(const LfPixels& pixels, double least_step, Edges* edges) {
  constexpr int kLane = 1;  // lane of the green values
  const int width = pixels.rect.width(), height = pixels.rect.height();
  // In a mosaic, only diagonals have successive pixels that recorded green. Interpolated values
  // would lie between the two sides of an edge whatever pixels show.
  const bool is_mosaic = pixels.recorded != BayerPattern::kNone;
  const auto recorded_green = [&](int x, int y) {
    return !is_mosaic ||
           BayerChannel(pixels.recorded, pixels.rect.x_begin + x, pixels.rect.y_begin + y) == kLane;
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!recorded_green(x, y)) continue;
      for (const bool is_second : {false, true}) {
        const int dx = is_mosaic || !is_second ? 1 : 0;
        const int dy = is_second ? 1 : is_mosaic ? -1 : 0;
        if (x < 2 * dx || x + 2 * dx >= width || y < 2 * std::abs(dy) ||
            y + 2 * std::abs(dy) >= height)
          continue;
        std::array<double, 5> value;
        bool any_masked = false;
        for (int k = -2; k <= 2; ++k) {
          value[static_cast<size_t>(k + 2)] = pixels.radiance.at(x + k * dx, y + k * dy, kLane);
          any_masked |= pixels.any_masked && pixels.IsMasked(x + k * dx, y + k * dy);
        }
        if (!any_masked) CountEdge(value, least_step, edges);
      }
    }
}

}  // namespace

Result<PixelFootprint> MeasureFootprint(const LightField& light_field, const LfImageStore& store) {
  constexpr size_t kImages = 3, kTries = 3;
  Edges edges;
  LfPixels pixels;
  for (size_t i = 0; i < kImages; ++i) {
    if (i > 0 && light_field.size() <= i) break;
    const size_t first = (2 * i + 1) * light_field.size() / (2 * kImages);
    // The next LF image takes the place of one that cannot be read, so that the answer does not
    // depend on how many edges are left.
    for (size_t n = first; n < std::min(first + kTries, light_field.size()); ++n) {
      const LfImageId id{static_cast<uint32_t>(n)};
      const Intrinsics& k = light_field.Camera(id).intrinsics;
      const int width = std::min(k.width_px, kMostSide_px),
                height = std::min(k.height_px, kMostSide_px);
      const int x = (k.width_px - width) / 2, y = (k.height_px - height) / 2;
      Result<LfPixels> loaded =
          LoadWithoutThrowing(store, id, {x, y, x + width, y + height},
                              light_field.image_names[id.value], std::move(pixels));
      if (!loaded && loaded.error().kind != ErrorKind::kInput) return loaded.error();
      pixels = loaded ? *std::move(loaded) : LfPixels();
      if (loaded) break;
    }
    if (pixels.radiance.channels() == LfPixels::kRgbLanes)
      CountEdges(pixels, kLeastStep * light_field.encoding.Scale(), &edges);
  }
  const bool is_mosaic = light_field.encoding.bayer != BayerPattern::kNone;
  const bool shows_points = edges.count >= (is_mosaic ? kLeastEdgesOfMosaics : kLeastEdges) &&
                            edges.with_value_between < kMostOfPoints * edges.count;
  return shows_points ? PixelFootprint::kPoint : PixelFootprint::kArea;
}

Result<PixelFootprint> FootprintOf(const LightField& light_field, const LfImageStore& store) {
  if (light_field.encoding.footprint) return *light_field.encoding.footprint;
  return MeasureFootprint(light_field, store);
}

}  // namespace lf
