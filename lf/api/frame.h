// SPDX-License-Identifier: Apache-2.0
// Renders frames of a film in memory: one frame by one call, or some frames in steps between which
// they can be looked at. Writes a frame to a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "lf/api/film.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/picture.h"
#include "lf/render/collect/frame_rays.h"
#include "lf/render/state/report.h"

namespace lf {

struct PlateNotes;  // render/state/plate_notes.h

// A frame, finished or not.
struct Frame {
  DevelopedFrame picture;             // picture.rgb is [height][width][3], linear light
  FrameReport report;                 // such as the numbers of LF images and of rays
  std::vector<SkippedImage> skipped;  // missing and broken LF images, whose rays the frame lacks
  // Facts for the metadata of the frame's file, such as the camera; SaveFrame() writes them. Null
  // in a frame that this library did not render.
  std::shared_ptr<const PlateNotes> notes;
};

// Renders a frame of the film, with WorkSettings::threads threads. The bits are those of lfrenderer
// with the same settings. With a mode that rebins, which rays are kept depends on all frames that
// are rendered together; RenderFilm() and FrameRenderer render those.
//   number  of the frame, one of film.path.frames()
// kUsage: the path has no such frame. kInput: no LF image contributes to the frame, or all that do
// are broken. Other errors are those of FrameRenderer.
Result<Frame> RenderFrame(const Film& film, uint32_t number);

// Renders some frames of a film together, in steps, for programs that look at unfinished frames:
//
//   LF_ASSIGN_OR_RETURN(FrameRenderer renderer, FrameRenderer::Open(film, {FrameId{1}}));
//   for (bool is_going_on = true; is_going_on;) {
//     LF_ASSIGN_OR_RETURN(is_going_on, renderer.Step());
//     LF_ASSIGN_OR_RETURN(const Frame frame, renderer.Develop(0));
//     Show(frame.picture.rgb);  // the rays so far; after the last step, the frame of RenderFrame()
//   }
//
// One thread at a time may use it; it uses as many as WorkSettings::threads says.
class FrameRenderer {
 public:
  // Copies the film, and selects the LF images that the frames take.
  //   frames  ascending; empty: all frames of the path
  // kUsage: the path has no such frame, or settings contradict each other. kInput: the LF images
  // cannot be opened, or none of them contributes to any of the frames. kOutput: the memory
  // (WorkSettings::memory_bytes) does not suffice for all of the frames at the same time; the
  // message names the number that fits. kInterrupted: WorkSettings::stop is set.
  static Result<FrameRenderer> Open(const Film& film, std::vector<FrameId> frames);
  FrameRenderer(FrameRenderer&&) noexcept;
  FrameRenderer& operator=(FrameRenderer&&) noexcept;
  ~FrameRenderer();

  // Adds the rays of some LF images, at most a few seconds of work, to all frames. Returns false if
  // no LF image was left.
  // kInput: all LF images were broken, or one is and WorkSettings::strict is set. kOutput: memory
  // or another resource of the machine does not suffice. kInterrupted: WorkSettings::interrupted is
  // set; the frames have all rays of each LF image or none, and Step() may be called again.
  Result<bool> Step();

  // Share of the LF images whose rays the frames have, from 0 to 1.
  double progress() const;
  // Number of frames.
  size_t size() const;

  // Returns a frame with the rays that it has so far.
  //   index  from 0 to size() - 1, in the order of the frames that Open() was given
  // kInterrupted: WorkSettings::stop is set.
  Result<Frame> Develop(size_t index);

 private:
  struct State;
  explicit FrameRenderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// Writes a frame with its metadata, under a temporary name until it is whole, into a folder that
// must exist. The bytes are those of lfrenderer's file.
//   format   unset: "exr" or "png", by the suffix of `file`
//   picture  how the file shows the picture (film/develop/picture.h)
// kUsage: the suffix is neither .exr nor .png, or is that of another format; the frame has no
// notes, or no opacities for FrameChannels::kRgba. kOutput: the folder or the disk cannot be
// written.
Result<void> SaveFrame(const Frame& frame, const std::filesystem::path& file,
                       std::optional<FrameFormat> format = {}, const PictureOptions& picture = {});

}  // namespace lf
