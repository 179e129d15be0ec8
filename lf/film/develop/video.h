// SPDX-License-Identifier: Apache-2.0
// Encodes frames as a video with ffmpeg. This is a separate step that can be repeated.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Checks that ffmpeg can be run and encodes H.264. It is called before the render, so that a
// night's work does not fail at its end. kOutput: the message says what to install.
Result<void> CheckVideoTool();
// Returns true if the name ends in .mp4, in small letters or capitals. Videos have no other names,
// because players and editors choose the format by the name.
bool IsVideoName(const std::filesystem::path& path);
// Checks the file of --video, or of the option that messages name, before the render. kUsage unless
// it has the name of a video. kOutput unless its folder exists, and the file is absent, empty or an
// mp4 video.
Result<void> CheckVideoTarget(const std::filesystem::path& path,
                              std::string_view option = "{video}");

// Writes an mp4 (H.264, yuv420p, sRGB tagged as BT.709) of 8-bit sRGB pictures, frame by frame. An
// odd width or height is cropped by one pixel, with a warning, because yuv420p needs even ones. The
// file appears under its name when it is complete and has been read back. One thread at a time may
// use a VideoWriter.
class VideoWriter {
 public:
  //   fps         frames per second, from 0.001 to 1,000,000. A rounded rate of television, such as
  //               119.88, becomes exact: 120000/1001
  //   patience_s  seconds after which ffmpeg is killed if it reads nothing, or does not end in
  //   Close()
  // kOutput: ffmpeg cannot be started, there are fewer than 2 x 2 pixels, or fps is out of range.
  static Result<std::unique_ptr<VideoWriter>> Open(const std::filesystem::path& path, int width,
                                                   int height, double fps, double patience_s = 300);
  ~VideoWriter();  // without Close(): ends ffmpeg and removes the unfinished file

  // Adds a picture [height][width][3]. kOutput with ffmpeg's last message if it has ended or is
  // stuck; after that, no picture can be added.
  Result<void> Add(const Image<uint8_t>& picture);

  // Waits for ffmpeg, has the file read by another ffmpeg, and gives it its name. kOutput with
  // ffmpeg's last message if the file is not whole or has another number of pictures than were
  // added, and if no picture was added; a file of this name then stays. Must be called only once.
  //   inputs  text of the inputs that the file states (file_inputs.h); none if it is empty
  Result<void> Close(std::string_view inputs = {});

 private:
  struct State;
  explicit VideoWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lf
