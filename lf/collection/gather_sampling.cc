#include "lf/collection/gather_sampling.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lf/camera/distortion.h"
#include "lf/camera/ideal_pixels.h"
#include "lf/camera/ray_through.h"

namespace lf {
const char* NameOf(PixelFilter filter) {
  constexpr const char* kNames[] = {"auto", "nearest", "bilinear", "bicubic", "mosaic"};
  return kNames[static_cast<int>(filter)];
}

double Magnification(const PinholeCamera& lf_camera, const RenderCamera& render_camera) {
  const Intrinsics& k = lf_camera.intrinsics;
  const Intrinsics& plate = render_camera.pinhole.intrinsics;
  const RayThrough ray(lf_camera, render_camera.pinhole.ForwardWorld());
  double densest_held = 0, densest = 0;  // most LF pixels per element; _held: within the LF image
  for (const double v : {0.1, 0.5, 0.9})
    for (const double u : {0.1, 0.5, 0.9}) {
      const double x = u * plate.width_px, y = v * plate.height_px;
      // Returns the position in the LF image of the focus point of plate position (x + dx, y + dy).
      const auto at = [&](double dx, double dy) -> std::optional<Vec2> {
        const std::optional<Vec3> point = FocusPointOfElement(render_camera, x + dx, y + dy);
        if (!point) return std::nullopt;
        return ray.RecordedAt(ray.DirectionWorld(*point));
      };
      const auto middle = at(0, 0), left = at(-0.5, 0), right = at(0.5, 0), above = at(0, -0.5),
                 below = at(0, 0.5);
      if (!middle || !left || !right || !above || !below) continue;
      const Vec2 along = *right - *left, down = *below - *above;
      const double pixels = std::abs(along.x() * down.y() - along.y() * down.x());
      densest = std::max(densest, pixels);
      const bool is_held = middle->x() >= 0 && middle->x() < k.width_px && middle->y() >= 0 &&
                           middle->y() < k.height_px;
      if (is_held) densest_held = std::max(densest_held, pixels);
    }
  const double pixels = densest_held > 0 ? densest_held : densest;
  return pixels > 0 && std::isfinite(pixels) ? 1 / std::sqrt(pixels) : 1;
}

GatherSampling SamplingOf(const PinholeCamera& lf_camera, const RenderCamera& render_camera,
                          PixelFilter filter) {
  const double magnification = Magnification(lf_camera, render_camera);
  GatherSampling sampling;
  sampling.filter = filter;
  // A value just above a whole number counts as that number.
  constexpr double kRounding = 1e-3;
  if (magnification * kFinerAtMost < 1)
    sampling.samples =
        std::min(kMostSamples, static_cast<int>(std::ceil(1 / magnification - kRounding)));
  const bool prefers_cubic = sampling.samples < kBilinearFrom;
  if (filter == PixelFilter::kAuto)
    sampling.filter = prefers_cubic ? PixelFilter::kBicubic : PixelFilter::kBilinear;
  sampling.is_cubic = sampling.filter == PixelFilter::kBicubic ||
                      (sampling.filter == PixelFilter::kMosaic && prefers_cubic);
  if (sampling.is_cubic && MayLackRays(lf_camera.intrinsics)) {
    sampling.is_cubic = false;
    if (sampling.filter == PixelFilter::kBicubic) sampling.filter = PixelFilter::kBilinear;
  }
  return sampling;
}

bool MayLackRays(const Intrinsics& k) {
  if (!k.has_distortion()) return false;
  const DistortionMap map(k.distortion);
  // The corner pixels, which are farthest from the optical axis, lose their rays first.
  for (const double x : {0.5, k.width_px - 0.5})
    for (const double y : {0.5, k.height_px - 0.5})
      if (!IdealPosition(k, map, x, y)) return true;
  return false;
}

RenderCamera WithFinerPlate(const RenderCamera& render_camera, int samples) {
  RenderCamera finer = render_camera;
  Intrinsics& k = finer.pinhole.intrinsics;
  k.width_px *= samples;
  k.height_px *= samples;
  k.fx_px *= samples;
  k.fy_px *= samples;
  k.cx_px *= samples;
  k.cy_px *= samples;
  k.skew_px *= samples;
  return finer;
}

}  // namespace lf
