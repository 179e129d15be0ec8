#include "lf/pipeline/focus_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/pipeline/collect.h"

namespace lf {
namespace {

constexpr int kPlaneCount = 24;
constexpr int kRefinements = 2;
constexpr int kPictureWidth = 240;
constexpr size_t kMostImages = 64;

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

// Mean magnitude of the Laplacian over the middle half of the plate: small bright lights count
// little.
double Detail(const SensorPlate& plate) {
  double sum = 0;
  for (int y = plate.height() / 4; y < plate.height() * 3 / 4; ++y)
    for (int x = plate.width() / 4; x < plate.width() * 3 / 4; ++x) {
      const double laplacian = 4 * Green(plate, x, y) - Green(plate, x - 1, y) -
                               Green(plate, x + 1, y) - Green(plate, x, y - 1) -
                               Green(plate, x, y + 1);
      sum += std::abs(laplacian);
    }
  return sum;
}

// The middle of the stretch around the largest value that is as good but for a hundredth: where
// planes differ by less than a pixel of disparity, all are equally sharp.
double MiddleOfBest(const std::vector<double>& detail) {
  const auto best = std::max_element(detail.begin(), detail.end());
  const auto good = [&](double value) { return value >= 0.99 * *best; };
  auto first = best, last = best;
  while (first != detail.begin() && good(*(first - 1))) --first;
  while (last + 1 != detail.end() && good(*(last + 1))) ++last;
  return 0.5 * static_cast<double>((first - detail.begin()) + (last - detail.begin()));
}

// Detail at each of the focus distances.
Result<std::vector<double>> DetailAt(const std::vector<double>& distances_w,
                                     const LightField& light_field, const LfImageStore& store,
                                     const PinholeCamera& camera, double aperture_diameter_w,
                                     ThreadPool& pool) {
  std::vector<RenderCamera> frames;
  std::vector<SensorPlate> plates;
  for (const double distance_w : distances_w) {
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
  return detail;
}

}  // namespace

Result<double> SharpestFocusDistance(const LightField& light_field, const LfImageStore& store,
                                     const PinholeCamera& camera, double aperture_diameter_w,
                                     double near_w, double far_w, ThreadPool& pool) {
  double begin = 1 / far_w, end = 1 / near_w, best = begin;
  for (int refinement = 0; refinement < kRefinements; ++refinement) {
    const double step = (end - begin) / (kPlaneCount - 1);
    std::vector<double> distances_w;
    for (int i = 0; i < kPlaneCount; ++i) distances_w.push_back(1 / (begin + i * step));
    LF_ASSIGN_OR_RETURN(
        const std::vector<double> detail,
        DetailAt(distances_w, light_field, store, camera, aperture_diameter_w, pool));
    best = begin + step * MiddleOfBest(detail);
    begin = std::max(1 / far_w, best - step);
    end = std::min(1 / near_w, best + step);
  }
  return 1 / best;
}

}  // namespace lf
