// A package: what one machine needs to render a section of a film (thesis 4.2): frames, the LF
// cameras that they need out of a million, and the order in which LF images are taken. It is itself
// a small light field with a camera path, rendered as a whole one is (pipeline/render.h), to the
// same bits. Where no LF image contributes to its frames it has none, and they are black.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/capture/light_field_identity.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/path/camera_path.h"
#include "lf/selection/image_index.h"
#include "lf/selection/image_order.h"

namespace lf {

struct PackageFrame {
  FrameId id;
  // About how far apart LF cameras around the lens are (lens_weights/frame_weights.h), measured in
  // the whole light field, of which the package may lack some. None: to be measured.
  std::optional<double> camera_distance_w;
  uint64_t image_count = 0;  // LF images with a ray, about
  uint64_t ray_count = 0;    // pixels of their rectangles
};

// What selection decided with, and a render of the package cannot decide anew.
struct PackageChoices {
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  std::optional<size_t> max_image_count;  // of the LF images of a frame, the first
  std::optional<double> max_angle_rad;    // between the optical axes of LF camera and frame
  // Whether LF cameras beside the lens are there, against which lens weights measure.
  bool has_neighbours = true;
};

// Of an LF image, for those who read pixels ahead, and for people.
struct PackageImage {
  uint32_t id = 0;          // in the whole light field, from 0
  uint64_t file_bytes = 0;  // size of the image file when the package was made; 0: not there
  PixelRect rect;           // bounds of its rectangles
  uint32_t frame_count = 0;
  uint64_t ray_count = 0;
};

struct Package {
  std::string name;   // of its file, without extension; empty in memory
  size_t number = 1;  // of `count` packages of the film
  size_t count = 1;
  LightField light_field;
  ImagePlaces places;                // in the whole light field
  CameraPath path;                   // of the whole film
  std::vector<PackageFrame> frames;  // ascending
  LightFieldIdentity whole;          // the light field that this is a part of
  PackageChoices choices;
  std::vector<PackageImage> images;  // as light_field.cameras; empty in memory

  std::vector<FrameId> FrameIds() const;
  // camera_distance_w of the frame, which must be one of the package's.
  std::optional<double> CameraDistance(FrameId frame) const;
};

// All of a light field and a path as one package, in a shuffled order.
Package PackageOfAll(LightField light_field, CameraPath path, uint64_t seed);

}  // namespace lf
