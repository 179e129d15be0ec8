// The frames as a film: a pipe into ffmpeg, a separate and repeatable step.
#pragma once

#include <filesystem>
#include <memory>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Whether ffmpeg can be run; asked at the start, so that a night's work does not end in vain.
// kOutput says what to install.
Result<void> CheckVideoTool();

// Writes an mp4 (H.264, yuv420p, sRGB as BT.709) of 8-bit sRGB pictures, frame by frame; sizes
// that are odd are cropped by one pixel, which H.264 asks for.
class VideoWriter {
 public:
  static Result<std::unique_ptr<VideoWriter>> Open(const std::filesystem::path& path, int width,
                                                   int height, double fps);
  ~VideoWriter();  // without Close(): ends ffmpeg and removes the unfinished file

  Result<void> Add(const Image<uint8_t>& picture);  // [height][width][3]
  // Waits for ffmpeg and gives the file its name. kOutput with ffmpeg's last words.
  Result<void> Close();

 private:
  struct State;
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
