// SPDX-License-Identifier: Apache-2.0
// The light field without its pixels: the cameras, the names of the image files, and how stored
// numbers become light.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/light_field/model/radiance.h"

namespace lf {

// Factors by which the radiances of R, G and B are multiplied. A ChannelGains made from one number
// has three equal factors.
struct ChannelGains {
  ChannelGains(float all = 1) : of_channels{all, all, all} {}  // NOLINT: implicit on purpose
  ChannelGains(float r, float g, float b) : of_channels{r, g, b} {}

  float& operator[](size_t channel) { return of_channels[channel]; }
  float operator[](size_t channel) const { return of_channels[channel]; }
  bool are_equal() const {
    return of_channels[0] == of_channels[1] && of_channels[0] == of_channels[2];
  }
  friend bool operator==(const ChannelGains&, const ChannelGains&) = default;

  std::array<float, 3> of_channels;
};

// One LF camera. An LfCamera takes only 120 bytes, because a light field may have a million of
// them.
struct LfCamera {
  RigidTransform cam_from_world;  // camera axes: x right, y down, z forward
  uint32_t intrinsics_index = 0;  // index into LightField::intrinsics
  ChannelGains gain;              // factors of the radiance (lf_gain)
  // ApplyBrackets() sets `brighter` and `masks_clipped` (light_field/model/brackets.h).
  static constexpr uint32_t kNone = UINT32_MAX;
  // LF image of the same pose with the next larger exposure; kNone if there is none.
  uint32_t brighter = kNone;
  bool masks_clipped = false;  // clipped pixels send no ray, because the pose has a darker LF image
  // True for a virtual LF image, which was synthesised from recorded ones. Reports, stop rules and
  // warnings count recorded LF images alone, because a virtual one brings no new measurement.
  bool is_virtual = false;
};
static_assert(sizeof(LfCamera) == 120);

// Facts about a light field video, and what of it is shown. Times are recording times: seconds from
// the first frames of the videos or, in a transforms.json, the numbers of its key "time".
struct VideoFacts {
  size_t camera_count = 0;  // 0: unknown, because the LF images do not tell which camera took them
  size_t slice_count = 0;   // number of recording times
  double begin = 0, end = 0;   // the first and the last of them
  std::optional<double> rate;  // slices for each unit of time; unset: they are not evenly spaced
  bool is_in_seconds = true;   // false: the unit of time is that of a transforms.json
  bool is_of_path = false;     // true: the slices that are open are those that a path shows
};

// How LF images are loaded smaller than they were recorded (light_field/model/reduction.h).
// LightField::intrinsics are then those of the reduced LF images, and LightField::encoding has no
// Bayer pattern.
struct Reduction {
  int divisor = 1;  // a pixel is the mean of divisor x divisor recorded pixels: 2, 4 or 8
  std::vector<Intrinsics> recorded_intrinsics;  // indexed like LightField::intrinsics
  BayerPattern recorded_bayer = BayerPattern::kNone;
};

// lf::Open() makes one of a calibration. A program may also make one of `cameras`, `intrinsics`,
// `image_names` and `folder`; the other members have defaults.
struct LightField {
  std::vector<LfCamera> cameras;       // indexed by LfImageId, like the two lists of names below
  std::vector<Intrinsics> intrinsics;  // each distinct set of intrinsics once
  // Names as written in the calibration; relative ones are relative to `folder`.
  std::vector<std::string> image_names;
  std::vector<std::string> mask_names;  // empty, or one for each camera ("": no mask)
  // The folder of the image files, or the file of a packed store that holds them
  // (storage/load/open_store.h).
  std::filesystem::path folder;
  // The file or folder that OpenLightField() was given; empty: the light field was made in memory.
  std::filesystem::path source;

  std::optional<Reduction> reduction;  // set if LF images are loaded reduced

  RadianceEncoding encoding;
  double unit_m = 1;                      // metres per world unit
  std::optional<DepthRange> depth_range;  // depths of the scene, if the calibration states them

  // The recording time of each LF image; empty if none is known.
  std::vector<double> times;
  // The slices of a light field video that are open: ascending recording times, each of which is
  // that of some LF images. A frame takes LF images of one slice alone
  // (light_field/model/time_slices.h). Empty: frames take LF images of any time.
  std::vector<double> slice_times;
  std::optional<VideoFacts> video;  // set for light field videos

  size_t size() const { return cameras.size(); }
  PinholeCamera Camera(LfImageId id) const {
    const LfCamera& camera = cameras[id.value];
    return {intrinsics[camera.intrinsics_index], camera.cam_from_world};
  }
  // Returns the path of an image file. In a packed store it is only for messages:
  // STORE.lfs/name.png
  std::filesystem::path ImagePath(LfImageId id) const { return folder / image_names[id.value]; }
};

// Returns the number of recorded LF images; all others are virtual.
inline size_t RecordedCount(const LightField& light_field) {
  return static_cast<size_t>(
      std::count_if(light_field.cameras.begin(), light_field.cameras.end(),
                    [](const LfCamera& camera) { return !camera.is_virtual; }));
}
// Returns true if any LF image is virtual.
inline bool HasVirtual(const LightField& light_field) {
  return RecordedCount(light_field) < light_field.size();
}

}  // namespace lf
