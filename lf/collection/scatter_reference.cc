// SPDX-License-Identifier: Apache-2.0
#include "lf/collection/ray_model.h"
#include "lf/collection/scatter.h"

namespace lf {

uint64_t ScatterReference(const PinholeCamera& lf_camera, const LfPixels& pixels,
                          const RenderCamera& render_camera, const PixelRect& rect,
                          SensorPlate* plate, const RayWeights& weights) {
  LF_CHECK(Intersection(rect, pixels.rect) == rect || rect.empty());
  const auto add = [&](const PlateElement& element, int channel, uint16_t v) {
    const uint64_t weight = weights.At(element.x, element.y);
    plate->Add(element.x, element.y, channel, {weight * v, weight});
  };
  uint64_t accepted = 0;
  const auto add_all = [&](const RayModel& model) {
    for (int y = rect.y_begin; y < rect.y_end; ++y) {
      for (int x = rect.x_begin; x < rect.x_end; ++x) {
        const int column = x - pixels.rect.x_begin;
        const int row = y - pixels.rect.y_begin;
        if (pixels.IsMasked(column, row)) continue;
        const std::optional<PlateElement> element = model.Collect(x, y);
        if (!element) continue;
        ++accepted;
        if (pixels.bayer != BayerPattern::kNone) {
          add(*element, BayerChannel(pixels.bayer, x, y), pixels.radiance.at(column, row));
          continue;
        }
        for (int channel = 0; channel < SensorPlate::kChannels; ++channel)
          add(*element, channel, pixels.radiance.at(column, row, channel));
      }
    }
  };
  // A ray may pass through several pieces of a focal surface: one element looks at a place that is
  // in front of the place of another one. Each of these elements gets it.
  ForEachPiece(render_camera,
               [&](const RenderCamera& piece) { add_all(RayModel(lf_camera, piece)); });
  return accepted;
}

}  // namespace lf
