// The recorded light field: cameras, where their pixels lie, and how stored numbers become light.
// Everything but the pixels.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/capture/radiance.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"

namespace lf {

// One LF camera: 104 bytes, since a light field may have a million of them.
struct LfCamera {
  RigidTransform cam_from_world;
  uint32_t intrinsics_index = 0;  // into LightField::intrinsics
  float gain = 1;                 // its radiance is multiplied by this (lf_gain)
};

struct LightField {
  std::vector<LfCamera> cameras;       // LfImageId indexes these and the two lists of names
  std::vector<Intrinsics> intrinsics;  // the distinct ones
  // Names as written in the calibration; relative ones are relative to `folder`.
  std::vector<std::string> image_names;
  std::vector<std::string> mask_names;  // empty, or one per camera ("" where there is none)
  // The folder of the image files, or the file of a packed store that holds them
  // (store/open_store.h).
  std::filesystem::path folder;

  RadianceEncoding encoding;
  double unit_m = 1;                      // metres per world unit
  std::optional<DepthRange> depth_range;  // of the scene, if the calibration tells

  size_t size() const { return cameras.size(); }
  PinholeCamera Camera(LfImageId id) const {
    const LfCamera& camera = cameras[id.value];
    return {intrinsics[camera.intrinsics_index], camera.cam_from_world};
  }
  // Of a packed store, for messages alone: STORE.lfs/name.png
  std::filesystem::path ImagePath(LfImageId id) const { return folder / image_names[id.value]; }
};

}  // namespace lf
