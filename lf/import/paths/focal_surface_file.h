// SPDX-License-Identifier: Apache-2.0
// Reads depth pictures and height maps, and makes the focal surfaces of a path of them.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/path/focal_surface_source.h"
#include "lf/camera/render_camera.h"
#include "lf/core/ids.h"
#include "lf/core/image.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

// Reads a picture of one number for each place: the channel Z of an EXR file, or the only channel
// of any other file of ReadImage(), such as PFM. Integers stay as stored: 0 to 255 or 65535.
// Returns [height][width], from the uppermost row on.
//   source  its kind and scale are read: without a scale, depths of 8 bits are refused, because
//           they are a picture for people
// kInput: the file cannot be read, has no such channel, or more than 2^28 places; depths of 8 bits
// without a scale.
Result<Image<float>> ReadSurfaceFile(const std::filesystem::path& file,
                                     const FocalSurfaceSource& source);

// Returns the inverse depths of width x height elements, from a depth picture of the same view,
// whose places may be larger or smaller than elements. The centre of an element lies between four
// places. Its inverse depth is interpolated between theirs if they are those of one surface: all
// are known, and the largest is at most 5 % above the least. Otherwise it is that of the nearest
// place, because depths on both sides of an edge have no mean. 0: unknown.
//   depths  [row][column]; not finite or not above 0: unknown
//   scale   world units of one unit of `depths`
Image<float> InverseDepthsOfPicture(const Image<float>& depths, double scale, int width,
                                    int height);

// Returns the inverse depth, along the optical axis of the camera, at which the line through the
// centre of each element first meets the surface of a height map from above. 0: it meets the
// surface nowhere.
//   heights  [row][column], values of the file; NaN and infinities are unknown
Image<float> InverseDepthsOfHeights(const PinholeCamera& camera, const Image<float>& heights,
                                    const FocalSurfaceSource& source);

// Returns the median distance from an LF camera to the nearest other one, in world units; 0 if
// there are less than two. Takes some LF cameras as a sample.
double NearestCameraDistance(const LightField& light_field);

// How MakeFocalSurfaces() works.
struct SurfaceWork {
  std::vector<FrameId> frames = {};  // frames that get surfaces, ascending; empty: all
  ThreadPool* pool = nullptr;        // makes several frames at the same time; null: one thread
  const std::atomic<bool>* stop = nullptr;  // once true, the function ends; may be null
};

// Gives the cameras of the path, and each instant of its shutter, the surfaces that
// path->focal_surface describes. The surfaces do not depend on the number of threads. Each thread
// holds one depth picture; a file for all frames is read once.
//   folder             of the path, to which names of files are relative
//   camera_distance_w  between neighbouring LF cameras: the blur is that of a lens that is at least
//                      two of them wide, because narrower lenses take light from so many
// kInput: ReadSurfaceFile(); a depth picture that has not the shape of the frame, or holds no
// depth; a height map that no element sees; a shutter and a depth picture. If several frames have
// errors, that of the first is returned. kInterrupted: *work.stop is true.
Result<void> MakeFocalSurfaces(const std::filesystem::path& folder, double camera_distance_w,
                               const SurfaceWork& work, CameraPath* path);

}  // namespace lf
