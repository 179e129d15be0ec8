// SPDX-License-Identifier: Apache-2.0
// The camera path after evaluation: one thin-lens camera per frame (thesis 4.5.1), and with a
// shutter the cameras of the instants at which each frame is exposed.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lf/camera/path/focal_surface_source.h"
#include "lf/camera/render_camera.h"
#include "lf/core/check.h"
#include "lf/core/ids.h"

namespace lf {

// Limits of a path, which its readers check before memory is allocated.
inline constexpr int kMostFrames = 1'000'000;
inline constexpr int kLargestPlateSide_px = 65536;
inline constexpr long long kMostPlateElements = 1LL << 30;
inline constexpr int kMostShutterSamples = 64;
inline constexpr long long kMostInstants = 1'000'000;  // of all frames together
inline constexpr int kMostViews = 1'000'000;           // of each moment

// The time for which each frame is exposed. It is centred at the time of the frame, and divided
// into `samples` equal parts; the instants of the frame are the middles of these parts.
struct Shutter {
  double angle_deg = 0;  // open time divided by the duration of a frame, times 360
  int samples = 1;       // number of instants of each frame; 1: there is no shutter
  bool exists() const { return samples > 1; }
};

// Returns the time from a frame to one of its instants, in durations of a frame: from -1/2 to 1/2.
inline double InstantOffset(const Shutter& shutter, int instant) {
  return shutter.angle_deg / 360 * ((instant + 0.5) / shutter.samples - 0.5);
}

// A camera path. lf::OpenFilm() reads it from a file. A program may also set `cameras` alone, all
// with one frame size.
struct CameraPath {
  double fps = 30;
  double unit_m = 1;                  // metres per world unit
  std::vector<RenderCamera> cameras;  // one for each frame; the first is at time 0
  Shutter shutter = {};
  // Number of views of each moment (view_cameras.h), which divides the number of frames: the first
  // frames are the views of the first moment, the next ones those of the second moment, and so on.
  // fps is then the rate of the moments. With more than 1, there is no shutter.
  int views = 1;
  // The cameras of the instants, [index of the frame][instant]; empty if there is no shutter.
  std::vector<RenderCamera> instants = {};
  // The picture that the focal surfaces of the cameras are made of, if the file of the path names
  // it. The cameras have surfaces only if the path was opened to be rendered
  // (PathOptions::surface).
  std::optional<FocalSurfaceSource> focal_surface = {};
  // Number of the first frame, for file names, options and messages; frames are counted on from
  // there. The moments of a path with several views are counted from the same number.
  uint32_t first_frame = 1;

  FrameNumbers frames() const { return {first_frame, cameras.size()}; }
  size_t frame_count() const { return cameras.size(); }
  size_t moment_count() const { return cameras.size() / static_cast<size_t>(views); }
  // Returns the camera at the time of the frame, for metadata, previews and depths.
  const RenderCamera& Camera(FrameId frame) const { return cameras[frames().IndexOf(frame)]; }
  // Returns the cameras whose rays make the picture of the frame: those of its instants or, without
  // a shutter, Camera(frame) alone.
  std::span<const RenderCamera> Instants(FrameId frame) const {
    if (!shutter.exists()) return {&Camera(frame), 1};
    const auto count = static_cast<size_t>(shutter.samples);
    LF_CHECK(instants.size() == cameras.size() * count);
    return std::span(instants).subspan(frames().IndexOf(frame) * count, count);
  }
  // Calls change(&camera) for the camera of each frame and of each instant. A shutter makes
  // pictures of the instants alone, and describes frames by the cameras.
  template <class Change>
  void ChangeCameras(const Change& change) {
    for (RenderCamera& camera : cameras) change(&camera);
    for (RenderCamera& camera : instants) change(&camera);
  }
  // Returns the cameras of Instants() of all frames, one frame after the other.
  std::span<const RenderCamera> AllInstants() const {
    return shutter.exists() ? instants : cameras;
  }
};

}  // namespace lf
