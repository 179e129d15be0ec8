// SPDX-License-Identifier: Apache-2.0
// A package contains all that one machine needs to render a section of a film (thesis 4.2): frames,
// those LF cameras of the light field that the frames need, and the order in which LF images are
// taken. A package is itself a small light field with a camera path. It is rendered like a whole
// light field (render/pipeline/render.h), and its frames have the same bits. If no LF image
// contributes to its frames, the package has no LF images, and the frames are black.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/light_field/model/light_field.h"
#include "lf/light_field/model/light_field_identity.h"
#include "lf/render/settings/rebin_settings.h"
#include "lf/render/settings/render_mode.h"
#include "lf/selection/image_index.h"
#include "lf/selection/image_order.h"

namespace lf {

struct PackageFrame {
  FrameId id;
  uint64_t image_count = 0;  // number of LF images that are read for the frame
  uint64_t ray_count = 0;    // number of LF pixels that are tested as rays or rebinned
};

// Density of LF cameras around the lens of a frame (render/hybrid/frame_sampling.h). It is measured
// in the whole light field, because the package may lack some LF cameras.
struct FrameSurroundings {
  double camera_distance_w = 0;  // spacing of the LF cameras around the lens; 0 if there are none
  double pixel_rad = 0;          // angle that one LF pixel covers
  Vec3 middle_world = Vec3::Zero();  // mean position of the LF cameras near the lens
  double hole_w = 0;                 // FrameSampling::hole_w
  // FrameSampling::recorded_distance_w; unset unless the light field is densified
  std::optional<double> recorded_distance_w = std::nullopt;
};

// Options of the selection, which a render of the package cannot change.
struct PackageChoices {
  ImageOrder order = ImageOrder::kSpread;
  uint64_t seed = 0;
  // Largest number of LF images for each frame, above 0: the first ones in the order are kept.
  // Unset: no limit.
  std::optional<size_t> max_image_count;
  // Largest angle between the axes of LF camera and frame. Unset: no limit.
  std::optional<double> max_angle_rad;
  // True if the package also has the LF cameras beside the lenses of its frames (neighbours). They
  // bound the part of the lens that each LF camera gets as its lens weight, and rebinned rays are
  // made from their LF images.
  bool has_neighbours = true;
  // Mode for which `rect`, `frame_count` and `ray_count` of each PackageImage are computed. A
  // package with neighbours can be rendered in any mode, unless a packed store lacks the pixels
  // that another mode needs.
  RenderMode mode = RenderMode::kCollect;
  // Interpolation for which they are computed: kPixels or kCells, or kAuto if the mode is kCollect.
  RayInterpolation interpolation = RayInterpolation::kAuto;
};

// The part of an LF image that the frames of a package need.
struct PackageImage {
  // Number of the LF image in the whole light field, from 0.
  uint32_t id = 0;
  // Size of the image file when the package was made. 0: the file did not exist, or the LF image is
  // a neighbour.
  uint64_t file_bytes = 0;
  PixelRect rect;            // bounds of the pixels that are read
  uint32_t frame_count = 0;  // number of frames that need the LF image; 0: a neighbour
  // Number of pixels of the LF image that are tested as rays or rebinned, sum of all frames.
  uint64_t ray_count = 0;
};

// How the light field of a package was opened when the package was made.
struct PackageSource {
  // The argument LIGHTFIELD: a calibration, folder or store, or the URL of a store.
  std::filesystem::path light_field;
  // Options of LIGHTFIELD and their values, as words of a command line; empty: none was given.
  std::vector<std::string> options;
};

struct Package {
  std::string name;   // name of the package file without extension; empty if it has no file
  size_t number = 1;  // number of this package, from 1 to `count`
  size_t count = 1;   // number of packages of the film
  LightField light_field;
  PackageSource source;
  // Ranks of the LF images of `light_field` in the order of the whole light field.
  ImageRanks ranks;
  CameraPath path;                   // camera path of the whole film
  std::vector<PackageFrame> frames;  // the frames to render, by ascending ids
  LightFieldIdentity whole;          // identity of the light field from which the package is made
  size_t whole_virtual_count = 0;    // number of its virtual LF images
  PackageChoices choices;
  // In the order of light_field.cameras. Empty if PackageOfAll() made the package.
  std::vector<PackageImage> images;
  // One for each frame of the film, [index of the frame]. Empty: not measured, because
  // choices.has_neighbours is false, or because PackageOfAll() made the package.
  std::vector<FrameSurroundings> surroundings;
  // FrameLens's camera distance of each instant of each frame of the film, measured in the whole
  // light field, [index of the frame][instant]; -1: not measured, because no package has the frame.
  // Empty: none is measured, or the path has no shutter.
  std::vector<double> instant_distances_w;

  std::vector<FrameId> FrameIds() const;
  // Returns FrameSurroundings::camera_distance_w of a frame of the film; nullopt if it was not
  // measured.
  std::optional<double> CameraDistance(FrameId frame) const;
  // Returns the same among recorded LF cameras.
  std::optional<double> RecordedCameraDistance(FrameId frame) const;
  // Returns the camera distances of the instants of a frame with a shutter; empty if they were not
  // measured.
  std::span<const double> InstantDistances(FrameId frame) const;
};

// Returns a whole light field and path as one package, with the LF images in an order for which
// DependsOnFrames(order) is false.
Package PackageOfAll(LightField light_field, CameraPath path, uint64_t seed,
                     ImageOrder order = ImageOrder::kSpread);

}  // namespace lf
