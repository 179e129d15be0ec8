// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/working_image.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "lf/camera/distortion.h"
#include "lf/densify/bicubic.h"

namespace lf {
namespace {

// Returns the means of divisor x divisor pixels. A mean is masked if one of its pixels is.
Image<uint16_t> Reduced(const Image<uint16_t>& light, int divisor) {
  if (divisor == 1) return light;
  Image<uint16_t> reduced(light.width() / divisor, light.height() / divisor, LfPixels::kRgbLanes);
  const uint32_t count = static_cast<uint32_t>(divisor) * divisor;
  for (int y = 0; y < reduced.height(); ++y)
    for (int x = 0; x < reduced.width(); ++x) {
      uint32_t sums[LfPixels::kRgbLanes] = {};
      for (int j = 0; j < divisor; ++j)
        for (int i = 0; i < divisor * LfPixels::kRgbLanes; ++i)
          sums[i % LfPixels::kRgbLanes] +=
              light.row(y * divisor + j)[x * divisor * LfPixels::kRgbLanes + i];
      const bool is_whole = sums[LfPixels::kRayLane] == count;
      for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
        reduced.at(x, y, lane) =
            is_whole ? static_cast<uint16_t>((sums[lane] + count / 2) / count) : uint16_t{0};
    }
  return reduced;
}

// Returns the image that a camera without distortion would record.
//   k  intrinsics of `light`, with distortion
Image<uint16_t> Undistorted(const Image<uint16_t>& light, const Intrinsics& k) {
  const DistortionMap map(k.distortion);
  const Mat3 direction_of_pixel = k.InverseMatrix();
  Image<uint16_t> ideal(light.width(), light.height(), LfPixels::kRgbLanes);
  for (int y = 0; y < ideal.height(); ++y)
    for (int x = 0; x < ideal.width(); ++x) {
      const std::optional<Vec2> at = map.Distort(direction_of_pixel * Vec3(x + 0.5, y + 0.5, 1));
      if (!at) continue;
      const double u = k.fx_px * at->x() + k.skew_px * at->y() + k.cx_px;
      const double v = k.fy_px * at->y() + k.cy_px;
      float colour[LfPixels::kRgbLanes];
      if (!SampleBicubic(light, static_cast<float>(u), static_cast<float>(v), colour)) continue;
      for (int lane = 0; lane < LfPixels::kRayLane; ++lane)
        ideal.at(x, y, lane) = RoundToLight(colour[lane]);
      ideal.at(x, y, LfPixels::kRayLane) = 1;
    }
  return ideal;
}

}  // namespace

int TextureAt(const Image<uint16_t>& tones, int x, int y) {
  return std::abs(tones.at(x + 1, y, 1) - tones.at(x - 1, y, 1)) +
         std::abs(tones.at(x, y + 1, 1) - tones.at(x, y - 1, 1));
}

PinholeCamera WorkingCamera(const PinholeCamera& lf_camera, int divisor) {
  PinholeCamera camera = lf_camera;
  Intrinsics& k = camera.intrinsics;
  k.distortion = {};
  k.vignetting = {};
  for (double* value : {&k.fx_px, &k.fy_px, &k.cx_px, &k.cy_px, &k.skew_px}) *value /= divisor;
  k.width_px /= divisor;
  k.height_px /= divisor;
  return camera;
}

ToneCurve::ToneCurve(const RadianceEncoding& encoding) : tones_(65536) {
  const double most = encoding.max_radiance;
  for (int v = 0; v < 65536; ++v) {
    const double x = std::max(0.0, (v - encoding.pedestal) / encoding.Scale());
    const double shown = x * (1 + x / (most * most)) / (1 + x);
    tones_[static_cast<size_t>(v)] =
        static_cast<uint8_t>(std::floor(255 * SrgbFromLinear(std::min(1.0, shown)) + 0.5));
  }
}

WorkingImage WorkingImageOf(const PinholeCamera& lf_camera, const LfPixels& pixels, int divisor,
                            const ToneCurve& curve) {
  WorkingImage image;
  image.camera = WorkingCamera(lf_camera, divisor);
  image.light = Reduced(pixels.radiance, divisor);
  if (lf_camera.intrinsics.has_distortion()) {
    Intrinsics distorted = image.camera.intrinsics;
    distorted.distortion = lf_camera.intrinsics.distortion;
    image.light = Undistorted(image.light, distorted);
  }
  image.tones = Image<uint16_t>(image.width(), image.height(), LfPixels::kRgbLanes);
  const size_t count = image.light.pixels().size();
  for (size_t i = 0; i < count; i += LfPixels::kRgbLanes) {
    const uint16_t* light = image.light.pixels().data() + i;
    uint16_t* tones = image.tones.pixels().data() + i;
    if (light[LfPixels::kRayLane] == 0) continue;
    for (int lane = 0; lane < LfPixels::kRayLane; ++lane) tones[lane] = curve.Tone(light[lane]);
    tones[LfPixels::kRayLane] = 255;
  }
  return image;
}

Result<WorkingImage> LoadWorkingImage(const LightField& light_field, const LfImageStore& store,
                                      LfImageId id, int divisor, const ToneCurve& curve) {
  const PinholeCamera camera = light_field.Camera(id);
  const PixelRect all{0, 0, camera.intrinsics.width_px, camera.intrinsics.height_px};
  LF_ASSIGN_OR_RETURN(
      const LfPixels pixels,
      LoadWithoutThrowing(store, id, all, light_field.image_names[id.value], LfPixels{}));
  return WorkingImageOf(camera, pixels, divisor, curve);
}

}  // namespace lf
