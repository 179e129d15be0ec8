#include "lf/pipeline/focus_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "lf/pipeline/collect.h"

namespace lf {
namespace {

constexpr int kPlaneCount = 64;
constexpr int kPictureWidth = 240;
constexpr size_t kMostImages = 300;

RenderCamera SweepCamera(const PinholeCamera& camera, double diameter_w, double focus_distance_w) {
  RenderCamera frame;
  frame.pinhole = camera;
  Intrinsics& k = frame.pinhole.intrinsics;
  const double scale = std::min(1.0, static_cast<double>(kPictureWidth) / k.width_px);
  k = {k.fx_px * scale,
       k.fy_px * scale,
       k.cx_px * scale,
       k.cy_px * scale,
       k.skew_px * scale,
       std::max(8, static_cast<int>(k.width_px * scale)),
       std::max(8, static_cast<int>(k.height_px * scale))};
  frame.aperture.radius_w = diameter_w / 2;
  frame.focus_distance_w = focus_distance_w;
  frame.focus_plane = FocusPlane(frame.pinhole, focus_distance_w, {});
  return frame;
}

double Green(const SensorPlate& plate, int x, int y) {
  const ElementSum element = plate.At(x, y, 1);
  return element.count > 0 ? static_cast<double>(element.sum) / element.count : 0;
}

// Mean squared Laplacian over the middle half of the plate.
double Detail(const SensorPlate& plate) {
  double sum = 0;
  for (int y = plate.height() / 4; y < plate.height() * 3 / 4; ++y)
    for (int x = plate.width() / 4; x < plate.width() * 3 / 4; ++x) {
      const double laplacian = 4 * Green(plate, x, y) - Green(plate, x - 1, y) -
                               Green(plate, x + 1, y) - Green(plate, x, y - 1) -
                               Green(plate, x, y + 1);
      sum += laplacian * laplacian;
    }
  return sum;
}

}  // namespace

Result<double> SharpestFocusDistance(const LightField& light_field, const LfImageStore& store,
                                     const PinholeCamera& camera, double aperture_diameter_w,
                                     double near_w, double far_w, ThreadPool& pool) {
  std::vector<RenderCamera> frames;
  std::vector<SensorPlate> plates;
  for (int i = 0; i < kPlaneCount; ++i) {
    const double share = static_cast<double>(i) / (kPlaneCount - 1);
    const double distance_w = 1 / ((1 - share) / near_w + share / far_w);
    frames.push_back(SweepCamera(camera, aperture_diameter_w, distance_w));
    const Intrinsics& k = frames.back().pinhole.intrinsics;
    plates.emplace_back(k.width_px, k.height_px);
  }
  const std::vector<SelectedImage> images =
      SelectImages(light_field, frames, {0, kMostImages}, pool);
  if (images.empty())
    return InputError(
        fmt::format("no LF image lies behind a lens of diameter {:.4g} at the starting camera",
                    aperture_diameter_w));
  LF_RETURN_IF_ERROR(Collect(light_field, store, frames, images, {}, pool, &plates, nullptr));
  std::vector<double> detail(plates.size());
  pool.ForEach(plates.size(), [&](size_t i) { detail[i] = Detail(plates[i]); });
  const auto best = std::max_element(detail.begin(), detail.end());
  return frames[static_cast<size_t>(best - detail.begin())].focus_distance_w;
}

}  // namespace lf
