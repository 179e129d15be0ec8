// The frames as a film: a stream into ffmpeg, a separate and repeatable step.
#pragma once

#include <filesystem>
#include <memory>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Whether ffmpeg can be run and encodes H.264; asked at the start, so that a night's work does not
// end in vain. kOutput says what to install.
Result<void> CheckVideoTool();
// Of --video, before the work and not after it: kOutput where the file could not be written.
Result<void> CheckVideoTarget(const std::filesystem::path& path);

// Writes an mp4 (H.264, yuv420p, sRGB as BT.709) of 8-bit sRGB pictures, frame by frame; sizes
// that are odd are cropped by one pixel, which H.264 asks for. The file appears under its name once
// it is complete. For one thread at a time.
class VideoWriter {
 public:
  // patience_s  an ffmpeg that takes in nothing for so long, or does not end, is given up
  // kOutput: ffmpeg cannot be started; fewer than 2 x 2 pixels or no frame rate.
  static Result<std::unique_ptr<VideoWriter>> Open(const std::filesystem::path& path, int width,
                                                   int height, double fps, double patience_s = 300);
  ~VideoWriter();  // without Close(): ends ffmpeg and removes the unfinished file

  // [height][width][3]. kOutput with ffmpeg's last words if it has ended or is stuck; nothing
  // more can be added then.
  Result<void> Add(const Image<uint8_t>& picture);

  // Waits for ffmpeg and gives the file its name. kOutput with ffmpeg's last words, also if no
  // picture was added. To be called once.
  Result<void> Close();

 private:
  struct State;
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
