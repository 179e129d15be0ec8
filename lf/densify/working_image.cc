// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/working_image.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "lf/camera/distortion.h"
#include "lf/densify/bicubic.h"
#include "lf/densify/compared_tones.h"
#include "lf/storage/load/recorded_image.h"

namespace lf {
namespace {

// Returns the light with the opacities in the last lane.
Image<uint16_t> LightOf(const LfPixels& pixels) {
  constexpr uint32_t kRange = LfPixels::kOpaque - LfPixels::kTransparent;
  Image<uint16_t> light = pixels.radiance;
  for (size_t i = LfPixels::kRayLane; i < light.pixels().size(); i += LfPixels::kRgbLanes) {
    uint16_t& lane = light.pixels()[i];
    if (lane == 0) continue;
    lane = kOpaqueOpacity;
    if (pixels.opacity.empty()) continue;
    const uint32_t v = pixels.opacity.pixels()[i - LfPixels::kRayLane] - LfPixels::kTransparent;
    lane = static_cast<uint16_t>(1 + (v * kMostOpacity + kRange / 2) / kRange);
  }
  return light;
}

// Returns the means of divisor x divisor pixels. A mean is masked if one of its pixels is.
Image<uint16_t> Reduced(const Image<uint16_t>& light, int divisor) {
  if (divisor == 1) return light;
  Image<uint16_t> reduced(light.width() / divisor, light.height() / divisor, LfPixels::kRgbLanes);
  const uint32_t count = static_cast<uint32_t>(divisor) * divisor;
  for (int y = 0; y < reduced.height(); ++y)
    for (int x = 0; x < reduced.width(); ++x) {
      uint32_t sums[LfPixels::kRgbLanes] = {};
      bool is_whole = true;
      for (int j = 0; j < divisor; ++j)
        for (int i = 0; i < divisor; ++i) {
          const uint16_t* pixel = &light.at(x * divisor + i, y * divisor + j);
          for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane) sums[lane] += pixel[lane];
          is_whole &= pixel[LfPixels::kRayLane] != 0;
        }
      for (int lane = 0; lane < LfPixels::kRgbLanes; ++lane)
        reduced.at(x, y, lane) =
            is_whole ? static_cast<uint16_t>((sums[lane] + count / 2) / count) : uint16_t{0};
    }
  return reduced;
}

// Returns the image that a camera without distortion would record.
//   k  intrinsics of `light`, with distortion
//   black  of a working image
Image<uint16_t> Undistorted(const Image<uint16_t>& light, const Intrinsics& k, uint16_t black) {
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
      RoundPixel(colour, black, &ideal.at(x, y));
    }
  return ideal;
}

// Returns the last tone of a pixel that is not masked.
uint16_t OpacityTone(uint16_t opacity) {
  constexpr uint32_t kRange = 255 - kTransparentTone;
  return static_cast<uint16_t>(kTransparentTone +
                               ((opacity - 1u) * kRange + kMostOpacity / 2) / kMostOpacity);
}

}  // namespace

bool IsTransparent(const uint16_t* tones) {
  constexpr int kFaintOpacity = 3, kFaintTone = 40;  // 1.7 %, and light of 0.02
  const uint16_t opacity = tones[LfPixels::kRayLane];
  return opacity != 0 && opacity <= kTransparentTone + kFaintOpacity && tones[0] <= kFaintTone &&
         tones[1] <= kFaintTone && tones[2] <= kFaintTone;
}

size_t ShownCount(const Image<uint16_t>& tones) {
  size_t count = 0;
  for (size_t i = 0; i < tones.pixels().size(); i += LfPixels::kRgbLanes)
    if (!IsTransparent(tones.pixels().data() + i)) ++count;
  return count;
}

Image<uint8_t> EmptyPixels(const Image<uint16_t>& tones) {
  Image<uint8_t> empty(tones.width(), tones.height());
  bool is_any = false;
  for (int y = 0; y < tones.height(); ++y)
    for (int x = 0; x < tones.width(); ++x) {
      bool is_empty = true;
      for (int j = std::max(y - 1, 0); is_empty && j <= std::min(y + 1, tones.height() - 1); ++j)
        for (int i = std::max(x - 1, 0); is_empty && i <= std::min(x + 1, tones.width() - 1); ++i)
          is_empty = IsTransparent(&tones.at(i, j));
      empty.at(x, y) = is_empty ? 1 : 0;
      is_any |= is_empty;
    }
  return is_any ? std::move(empty) : Image<uint8_t>();
}

Image<uint8_t> PixelsWithoutDepth(const Image<uint16_t>& tones) {
  Image<uint8_t> result(tones.width(), tones.height());
  bool is_any = false;
  for (size_t i = 0; i < result.pixels().size(); ++i) {
    const uint16_t* pixel = tones.pixels().data() + i * LfPixels::kRgbLanes;
    result.pixels()[i] = pixel[LfPixels::kRayLane] == 0 || IsTransparent(pixel) ? 1 : 0;
    is_any |= result.pixels()[i] != 0;
  }
  return is_any ? std::move(result) : Image<uint8_t>();
}

int TextureAt(const Image<uint16_t>& tones, int x, int y) {
  constexpr int kSameOpacity = 4;
  const int opacity = tones.at(x, y, LfPixels::kRayLane);
  for (const uint16_t beside :
       {tones.at(x - 1, y, LfPixels::kRayLane), tones.at(x + 1, y, LfPixels::kRayLane),
        tones.at(x, y - 1, LfPixels::kRayLane), tones.at(x, y + 1, LfPixels::kRayLane)})
    if (opacity != 0 && beside != 0 && std::abs(beside - opacity) > kSameOpacity) return 0;
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

ToneCurve::ToneCurve(const RadianceEncoding& encoding)
    : black_(QuantizeRadiance(encoding, 0, 1)), tones_(65536) {
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
  image.black = curve.black();
  image.light = Reduced(LightOf(pixels), divisor);
  if (lf_camera.intrinsics.has_distortion()) {
    Intrinsics distorted = image.camera.intrinsics;
    distorted.distortion = lf_camera.intrinsics.distortion;
    image.light = Undistorted(image.light, distorted, image.black);
  }
  image.tones = Image<uint16_t>(image.light.width(), image.light.height(), LfPixels::kRgbLanes);
  const size_t count = image.light.pixels().size();
  for (size_t i = 0; i < count; i += LfPixels::kRgbLanes) {
    const uint16_t* light = image.light.pixels().data() + i;
    uint16_t* tones = image.tones.pixels().data() + i;
    if (light[LfPixels::kRayLane] == 0) continue;
    for (int lane = 0; lane < LfPixels::kRayLane; ++lane) tones[lane] = curve.Tone(light[lane]);
    tones[LfPixels::kRayLane] = OpacityTone(light[LfPixels::kRayLane]);
  }
  image.compared = ComparedTones(image.tones);
  image.empty = EmptyPixels(image.tones);
  image.without_depth = PixelsWithoutDepth(image.tones);
  return image;
}

WorkingImage ReducedTones(const WorkingImage& image, int divisor) {
  WorkingImage reduced;
  reduced.camera = WorkingCamera(image.camera, divisor);
  reduced.tones = Reduced(image.tones, divisor);
  reduced.compared = ComparedTones(reduced.tones);
  reduced.empty = EmptyPixels(reduced.tones);
  return reduced;
}

LightField WithOpacities(LightField light_field) {
  RadianceEncoding& encoding = light_field.encoding;
  if (!encoding.AlphaIsLight()) return light_field;
  encoding.background.emplace();
  encoding.keeps_opacity = true;
  return light_field;
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
