// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exposure/exposure_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace lf {
namespace {

// Largest number of LF images that are completely in memory at the same time.
constexpr size_t kMostAtOnce = 16;
// Values from this share of the largest radiance on count as clipped, because demosaicing and JPEG
// do not keep the largest value exactly.
constexpr double kClippedFrom = 0.97;

int DivisorOf(int width_px, int most_px) { return std::max(1, (width_px + most_px - 1) / most_px); }

// Returns the smallest 16-bit radiance (light_field/model/radiance.h) that counts as clipped in the
// LF image: kClippedFrom of the largest radiance that its file can hold. An integer file holds a
// radiance of at most 1, even if the light field can hold more.
double ClippedFrom(const RadianceEncoding& encoding, const std::string& name) {
  const double of_file = std::min(encoding.max_radiance, DefaultMaxRadiance({&name, 1}));
  return encoding.pedestal + kClippedFrom * of_file * encoding.Scale();
}

Image<uint16_t> LightOf(const LfPixels& pixels, int divisor, double pedestal, double clipped) {
  const int d = divisor;
  Image<uint16_t> light(pixels.rect.width() / d, pixels.rect.height() / d, 3);
  const double scale = kLightSteps / (65535 - pedestal) / (d * d);
  for (int y = 0; y < light.height(); ++y)
    for (int x = 0; x < light.width(); ++x) {
      bool is_kept = true;
      std::array<double, 3> sums = {};
      for (int row = y * d; row < (y + 1) * d; ++row)
        for (int column = x * d; column < (x + 1) * d; ++column) {
          is_kept = is_kept && !pixels.IsMasked(column, row);
          for (int c = 0; c < 3; ++c) {
            const double v = pixels.radiance.at(column, row, c);
            is_kept = is_kept && v < clipped;
            sums[static_cast<size_t>(c)] += v - pedestal;
          }
        }
      for (int c = 0; c < 3; ++c)
        light.at(x, y, c) = is_kept ? static_cast<uint16_t>(std::lround(std::clamp(
                                          1 + sums[static_cast<size_t>(c)] * scale, 0., 65535.)))
                                    : 0;
    }
  return light;
}

}  // namespace

std::array<float, 3> ExposureView::LightsAt(const Vec2& place_px) const {
  const int divisor = grey->divisor;
  const double x = place_px.x() / divisor - 0.5, y = place_px.y() / divisor - 0.5;
  // Positions exactly at the centres of the last column or row are inside.
  if (!(x >= 0 && y >= 0 && x <= light.width() - 1 && y <= light.height() - 1)) return {};
  const int column = std::min(static_cast<int>(x), light.width() - 2);
  const int row = std::min(static_cast<int>(y), light.height() - 2);
  if (column < 0 || row < 0) return {};
  const auto u = static_cast<float>(x - column), v = static_cast<float>(y - row);
  const uint16_t* upper = light.row(row) + ptrdiff_t{3} * column;
  const uint16_t* lower = light.row(row + 1) + ptrdiff_t{3} * column;
  std::array<float, 3> lights;
  for (size_t c = 0; c < 3; ++c) {
    if (upper[c] == 0 || upper[c + 3] == 0 || lower[c] == 0 || lower[c + 3] == 0) return {};
    lights[c] = (1 - v) * ((1 - u) * upper[c] + u * upper[c + 3]) +
                v * ((1 - u) * lower[c] + u * lower[c + 3]);
  }
  return lights;
}

size_t ViewBytes(const Intrinsics& k, int width_px) {
  const int d = DivisorOf(k.width_px, width_px);
  return static_cast<size_t>(k.width_px / d) * (k.height_px / d) *
         (sizeof(float) + 3 * sizeof(uint16_t));
}

Result<std::vector<ExposureView>> LoadExposureViews(const LightField& light_field,
                                                    const LfImageStore& store,
                                                    const LoadViewsOptions& options,
                                                    ThreadPool& pool) {
  std::vector<ExposureView> views(light_field.size());
  MachineFailure failure;
  for (size_t begin = 0; begin < views.size(); begin += kMostAtOnce) {
    if (options.interrupted && *options.interrupted)
      return Error{
          ErrorKind::kInterrupted,
          fmt::format("interrupted after loading {} of {} images to compare their exposure", begin,
                      views.size())};
    const size_t count = std::min(kMostAtOnce, views.size() - begin);
    pool.ForEach(count, [&](size_t i) {
      const LfImageId id{static_cast<uint32_t>(begin + i)};
      const Intrinsics& k = light_field.intrinsics[light_field.cameras[id.value].intrinsics_index];
      const Result<LfPixels> pixels =
          LoadWithoutThrowing(store, id, {0, 0, k.width_px, k.height_px},
                              light_field.ImagePath(id).string(), LfPixels());
      if (!pixels) {
        failure.Note(pixels.error());
        return;
      }
      const int divisor = DivisorOf(k.width_px, options.width_px);
      views[id.value].light =
          LightOf(*pixels, divisor, light_field.encoding.pedestal,
                  ClippedFrom(light_field.encoding, light_field.image_names[id.value]));
      views[id.value].grey = std::make_shared<const ReducedImage>(Reduced(*pixels, divisor));
    });
    LF_RETURN_IF_ERROR(failure.Check());
    if (options.progress) options.progress(begin + count, views.size());
  }
  return views;
}

}  // namespace lf
