#include "lf/pipeline/focus_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lf/collector/collect.h"
#include "lf/core/log.h"

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

// The mean of an element, compressed so that lights do not count for everything, but less than to
// the square root: there the energy of n copies of a light would equal that of the light. NaN where
// no ray arrived.
double Brightness(const SensorPlate& plate, int x, int y) {
  const ElementSum element = plate.At(x, y, 1);
  constexpr double kCompression = 0.6;
  return std::pow(static_cast<double>(element.sum) / element.count, kCompression);
}

// Mean energy of the Laplacian over the middle half of the plate; 0 where few elements there have
// rays. Energy, because where cameras stand far apart what is out of focus is not blurred but
// copied: n copies with 1/n of the contrast have all of the magnitude, but 1/n of the energy.
double Detail(const SensorPlate& plate) {
  double sum = 0;
  int known_count = 0, count = 0;
  for (int y = plate.height() / 4; y < plate.height() * 3 / 4; ++y)
    for (int x = plate.width() / 4; x < plate.width() * 3 / 4; ++x) {
      const double laplacian = 4 * Brightness(plate, x, y) - Brightness(plate, x - 1, y) -
                               Brightness(plate, x + 1, y) - Brightness(plate, x, y - 1) -
                               Brightness(plate, x, y + 1);
      ++count;
      if (std::isnan(laplacian)) continue;
      ++known_count;
      sum += laplacian * laplacian;
    }
  return 2 * known_count > count ? sum / known_count : 0;
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
  CollectOptions options;
  // Interpolated rays leave no holes, which would count as detail.
  options.reading = {Estimator::kBilinear, PixelFilter::kBilinear};
  SelectOptions select;
  select.reach = ReachOf(options.reading.estimator);
  std::vector<SelectedImage> images = SelectImages(ImageIndex(light_field), frames, select, pool);
  if (images.size() > kMostImages) images.resize(kMostImages);
  if (images.empty())
    return InputError(
        fmt::format("no LF image lies behind a lens of diameter {:.4g} at the starting camera",
                    aperture_diameter_w));
  LogDebug("focus sweep: {} planes from {:.4g} to {:.4g} by {} LF images", distances_w.size(),
           distances_w.front(), distances_w.back(), images.size());
  LF_ASSIGN_OR_RETURN(const CollectStatistics statistics,
                      Collect(light_field, store, frames, images, options, pool, &plates, nullptr));
  if (std::all_of(statistics.frames.begin(), statistics.frames.end(),
                  [](const FrameRays& rays) { return rays.accepted_count == 0; }))
    return InputError(
        statistics.skipped.empty()
            ? "the LF images around the starting camera have no rays (are they masked?): no focus "
              "can be found"
            : fmt::format("no focus can be found: {} of {} LF images around the starting camera "
                          "are missing or broken, the first: {}",
                          statistics.skipped.size(), images.size(),
                          statistics.skipped.front().reason));
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
