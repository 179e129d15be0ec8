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
  uint64_t image_count = 0;  // LF images with a ray, about
  uint64_t ray_count = 0;    // pixels of their rectangles
};

// Density of LF cameras around the lens of a frame (hybrid/frame_sampling.h). It is measured in the
// whole light field, because the package may lack some LF cameras.
struct FrameSurroundings {
  double camera_distance_w = 0;  // about how far apart LF cameras are; 0: there is none
  double pixel_rad = 0;          // what one LF pixel sees
  Vec3 middle_world = Vec3::Zero();
  double hole_w = 0;  // from a point of the lens to the nearest LF camera, at most
};

// What selection decided with, and a render of the package cannot decide anew.
struct PackageChoices {
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  std::optional<size_t> max_image_count;  // of the LF images of a frame, the first
  std::optional<double> max_angle_rad;    // between the optical axes of LF camera and frame
  // True if LF cameras beside the lens are there: lens weights measure against them, and rebinned
  // rays are made of their LF images.
  bool has_neighbours = true;
  // The mode of the render that `rect` and `frame_count` of images are for, "collect", "rebin" or
  // "hybrid" (hybrid/render_mode.h). With neighbours a package can be rendered in any mode, if the
  // LF images are whole.
  std::string mode = "collect";
};

// The part of an LF image that the frames of a package need.
struct PackageImage {
  uint32_t id = 0;           // in the whole light field, from 0
  uint64_t file_bytes = 0;   // size of the image file when the package was made; 0: not there
  PixelRect rect;            // bounds of the pixels that are read
  uint32_t frame_count = 0;  // frames that need it; 0: a neighbour
  uint64_t ray_count = 0;    // pixels that are tried as rays, in all of these frames
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
  // One for each frame of the film, [frame - 1]; empty: to be measured, in a light field that is
  // whole.
  std::vector<FrameSurroundings> surroundings;

  std::vector<FrameId> FrameIds() const;
  // camera_distance_w around a frame of the film; none: to be measured.
  std::optional<double> CameraDistance(FrameId frame) const;
};

// All of a light field and a path as one package, in a shuffled order.
Package PackageOfAll(LightField light_field, CameraPath path, uint64_t seed);

}  // namespace lf
