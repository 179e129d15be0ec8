// SPDX-License-Identifier: Apache-2.0
// A light field without files, for tests of optics with known answers: dense parallel cameras in
// the plane z = 0 whose pixels are given by a formula of the ray.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "lf/camera/pinhole.h"
#include "lf/camera/render_camera.h"
#include "lf/render/collect/collect.h"

namespace lf::testing {

// The radiance of a ray, in [0, 1].
using Radiance = std::function<double(const Ray&)>;

struct GridRig {
  int side = 21;  // side x side cameras
  double pitch_w = 0.003;
  Intrinsics intrinsics = {200, 200, 80, 60, 0, 160, 120};
};

inline LightField GridField(const GridRig& rig) {
  LightField field;
  field.intrinsics = {rig.intrinsics};
  const double middle = (rig.side - 1) / 2.0;
  for (int row = 0; row < rig.side; ++row)
    for (int column = 0; column < rig.side; ++column) {
      LfCamera camera;
      camera.cam_from_world.translation = {(middle - column) * rig.pitch_w,
                                           (middle - row) * rig.pitch_w, 0};
      field.cameras.push_back(camera);
      field.image_names.push_back("formula");
    }
  return field;
}

// Gives every pixel the value of the formula at its centre.
class FormulaStore : public LfImageStore {
 public:
  FormulaStore(const LightField& field, Radiance radiance)
      : field_(field), radiance_(std::move(radiance)) {}

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    const PinholeCamera camera = field_.Camera(id);
    *pixels = LfPixels(rect, BayerPattern::kNone);
    for (int y = rect.y_begin; y < rect.y_end; ++y)
      for (int x = rect.x_begin; x < rect.x_end; ++x) {
        const double value = radiance_(RayOfPixel(camera, x + 0.5, y + 0.5));
        for (int channel = 0; channel < 3; ++channel)
          pixels->radiance.at(x - rect.x_begin, y - rect.y_begin, channel) =
              static_cast<uint16_t>(std::lround(65535 * std::clamp(value, 0.0, 1.0)));
      }
    return {};
  }

 private:
  const LightField& field_;
  Radiance radiance_;
};

// Images that are black except for the pixel that shows a point of the scene. Only that pixel is
// loaded: the black pixels would add rays but no light.
class PointStore : public LfImageStore {
 public:
  PointStore(const LightField& field, const Vec3& point) : field_(field), point_(point) {}

  Result<void> Load(LfImageId id, const PixelRect&, LfPixels* pixels) const override {
    const Vec2 p = *Project(field_.Camera(id), point_);
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    *pixels = LfPixels({x, y, x + 1, y + 1}, BayerPattern::kNone);
    for (int channel = 0; channel < 3; ++channel) pixels->radiance.at(0, 0, channel) = 65535;
    return {};
  }

 private:
  const LightField& field_;
  Vec3 point_;
};

inline SensorPlate CollectFrame(const LightField& field, const LfImageStore& store,
                                const RenderCamera& frame) {
  ThreadPool pool(2);
  const std::vector<RenderCamera> frames = {frame};
  std::vector<SensorPlate> plates;
  plates.emplace_back(frame.pinhole.intrinsics.width_px, frame.pinhole.intrinsics.height_px);
  const auto images = SelectImages(ImageIndex(field), frames, {}, pool);
  const auto statistics =
      Collect(field, store, FramesOf(frames, plates), images, {}, pool, nullptr);
  LF_CHECK(statistics.has_value());
  return std::move(plates[0]);
}

inline RenderCamera Frame(const Intrinsics& intrinsics, double aperture_diameter_w,
                          double focus_distance_w, const FocusTilt& tilt = {}) {
  RenderCamera frame;
  frame.pinhole.intrinsics = intrinsics;
  frame.aperture.radius_w = aperture_diameter_w / 2;
  frame.focus_distance_w = focus_distance_w;
  frame.focus_tilt = tilt;
  frame.focus_plane = FocusPlane(frame.pinhole, focus_distance_w, tilt);
  return frame;
}

}  // namespace lf::testing
