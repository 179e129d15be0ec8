// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/depth/sharp_plate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "lf/core/catmull_rom.h"

namespace lf {
namespace {

// Returns the light at a position of the view; none if a pixel that it needs is missing. Pixels
// beyond the border are those at the border.
std::optional<std::array<uint16_t, 3>> LightAt(const LensView& view, double x, double y) {
  const int width = view.light.width(), height = view.light.height();
  if (!(x >= 0 && x <= width - 1 && y >= 0 && y <= height - 1)) return std::nullopt;
  const int column = static_cast<int>(x), row = static_cast<int>(y);
  const std::array<double, 4> across = CatmullRomWeights(x - column),
                              down = CatmullRomWeights(y - row);
  std::array<double, 3> light = {};
  for (int j = 0; j < 4; ++j) {
    std::array<double, 3> of_row = {};
    for (int i = 0; i < 4; ++i) {
      const uint16_t* const pixel = &view.light.at(std::clamp(column + i - 1, 0, width - 1),
                                                   std::clamp(row + j - 1, 0, height - 1));
      if (pixel[LfPixels::kRayLane] == 0) return std::nullopt;
      for (size_t c = 0; c < 3; ++c)
        of_row[c] += across[static_cast<size_t>(i)] * LightOfRoot(pixel[c]);
    }
    for (size_t c = 0; c < 3; ++c) light[c] += down[static_cast<size_t>(j)] * of_row[c];
  }
  std::array<uint16_t, 3> rounded;
  for (size_t c = 0; c < 3; ++c)
    rounded[c] = static_cast<uint16_t>(std::lround(std::clamp(light[c], 0.0, 65535.0)));
  return rounded;
}

}  // namespace

void AddSharpRow(std::span<const LensView> views, const RenderCamera& frame, const FrameLens& lens,
                 const Image<float>& depths_w, int y, SensorPlate* plate) {
  for (const LensView& view : views) {
    const RayWeights weights = lens.WeightsOf(view.of.id);
    if (weights.are_none()) continue;
    // The position is (g a + b) / (g a.z + b.z) at the distance g: a and b are those of two planes.
    const PlanePositions near(view, frame, 0), far(view, frame, 1);
    for (int x = 0; x < plate->width(); ++x) {
      const uint32_t weight = weights.At(x, y);
      if (weight == 0) continue;
      const Vec3 b = near.At(x + 0.5, y + 0.5);
      const Vec3 a = far.At(x + 0.5, y + 0.5) - b;
      const Vec3 at = double{depths_w.at(x, y)} * a + b;
      if (!(at.z() > 0)) continue;
      const auto light = LightAt(view, at.x() / at.z() - (view.rect.x_begin + 0.5),
                                 at.y() / at.z() - (view.rect.y_begin + 0.5));
      if (!light) continue;
      for (int c = 0; c < 3; ++c)
        plate->Add(x, y, c, {uint64_t{weight} * (*light)[static_cast<size_t>(c)], weight});
    }
  }
}

}  // namespace lf
