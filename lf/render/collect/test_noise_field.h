// SPDX-License-Identifier: Apache-2.0
// Small light fields of noise, for tests of collection as a whole.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <new>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/random.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf::testing {

inline constexpr int kWidth = 64, kHeight = 48;

// Returns a grid of `side` x `side` LF cameras with jittered positions, whose LF images are noise
// (NoiseStore). NoiseFrames() returns frames with wide lenses for this light field.
inline LightField NoiseField(uint32_t side = 7) {
  LightField field;
  field.intrinsics = {{70, 70, 32, 24, 0, kWidth, kHeight}};
  for (uint32_t i = 0; i < side * side; ++i) {
    LfCamera camera;
    const double pitch = 0.07 / side;
    const double x = pitch * (i % side) - 0.03 + 0.002 * RandomUnit(1, 0, i);
    const double y = pitch * (i / side) - 0.03 + 0.002 * RandomUnit(1, 1, i);
    const double z = 0.004 * RandomUnit(1, 2, i) - 0.002;
    camera.cam_from_world = *LookAlong({x, y, z}, {0.1 * x, 0.02, 1}, {0, -1, 0});
    field.cameras.push_back(camera);
    field.image_names.push_back("image" + std::to_string(i));
  }
  return field;
}

inline std::vector<RenderCamera> NoiseFrames() {
  std::vector<RenderCamera> frames;
  for (int i = 0; i < 3; ++i) {
    RenderCamera frame;
    frame.pinhole.intrinsics = {80, 80, 40, 30, 0, 80, 60};
    frame.pinhole.cam_from_world = *LookAlong({0.01 * i, 0, -0.01 * i}, {0, 0, 1}, {0, -1, 0});
    frame.aperture = {0.03, i == 1 ? 5 : 0, 0.1 * i};
    frame.focus_plane = FocusPlane(frame.pinhole, 1 + i, {0.2 * i, 0});
    frames.push_back(frame);
  }
  return frames;
}

class NoiseStore : public LfImageStore {
 public:
  void Announce(LfImageId id) const override { announced.push_back(id.value); }
  bool IsThere(LfImageId /*id*/) const override { return !is_gone; }

  bool is_gone = false;
  std::vector<uint32_t> broken;
  ErrorKind broken_kind = ErrorKind::kInput;
  std::vector<uint32_t> without_memory;
  std::function<void(LfImageId, const PixelRect&)> on_load;
  mutable std::vector<uint32_t> announced;  // unguarded: only one thread announces at a time

  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    EXPECT_FALSE(rect.empty());
    if (on_load) on_load(id, rect);
    if (std::count(broken.begin(), broken.end(), id.value) > 0)
      return Error{broken_kind, "image" + std::to_string(id.value) + ": broken"};
    if (std::count(without_memory.begin(), without_memory.end(), id.value) > 0)
      throw std::bad_alloc();
    *pixels = LfPixels(rect, BayerPattern::kNone);  // exactly the requested rectangle
    for (int y = rect.y_begin; y < rect.y_end; ++y)
      for (int x = rect.x_begin; x < rect.x_end; ++x)
        for (int c = 0; c < 3; ++c)
          pixels->radiance.at(x - rect.x_begin, y - rect.y_begin, c) = static_cast<uint16_t>(
              RandomBits(11, id.value, static_cast<uint64_t>((y * kWidth + x) * 3 + c)));
    return {};
  }

  // Completes rows in groups of five.
  Result<void> LoadByRows(LfImageId id, const PixelRect& rect, LfPixels* pixels,
                          const RowsLoaded& rows_loaded) const override {
    LF_RETURN_IF_ERROR(Load(id, rect, pixels));
    const int height = pixels->radiance.height();
    for (int rows = 5; rows < height; rows += 5) rows_loaded(pixels, rows);
    rows_loaded(pixels, height);
    return {};
  }
};

}  // namespace lf::testing
