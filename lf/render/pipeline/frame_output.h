// SPDX-License-Identifier: Apache-2.0
// Writes the picture of a frame, and makes the contact sheet and the video from the files of
// frames.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/frame_file.h"
#include "lf/pixels/files/image_file.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/state/plate_notes.h"

namespace lf {

// Writes a developed picture with its notes to the file `to`. Adds what PictureOptions requests.
//   is_interrupted  called often, by any thread; empty: nothing interrupts. If it returns true at
//                   once, nothing is written, so that `picture` may be the unusable result of an
//                   interrupted DevelopFrame().
//   more            further metadata of the file
// kOutput: the file cannot be written. kInterrupted: nothing is written.
Result<void> WritePicture(const PlateNotes& notes, DevelopedFrame picture,
                          const std::filesystem::path& to, FrameFormat format,
                          const PictureOptions& options,
                          const std::function<bool()>& is_interrupted,
                          const ImageMetadata& more = {});

inline constexpr const char* kContactSheet = "contact_sheet.png";

// A film whose frames are files in a folder. They may have been rendered at any time, by any
// process.
struct FilmFiles {
  std::filesystem::path folder;
  FrameFormat format = FrameFormat::kExrHalf;
  ColourSpace colours = ColourSpace::kRec709;
  int width_px = 0;
  int height_px = 0;
  double fps = 0;
  const std::atomic<bool>* stop = nullptr;  // once true, the functions end; may be null

  // WriteContactSheet() writes the sheet `name` into the folder; WriteVideo() writes an mp4. Both
  // read the files of these frames.
  //   at_once  number of files that are read at the same time
  // kOutput: the file cannot be written, or ffmpeg failed. kInput: a frame cannot be read, or has
  // another size. kInterrupted: `stop` is true.
  Result<void> WriteContactSheet(const std::vector<FrameId>& frames, size_t at_once,
                                 ThreadPool& pool, const std::string& name = kContactSheet) const;
  Result<void> WriteVideo(const std::vector<FrameId>& frames,
                          const std::filesystem::path& video) const;

 private:
  std::filesystem::path PathOf(FrameId frame) const;
  Result<Image<uint8_t>> ReadPicture(FrameId frame) const;
};

// Returns the FilmFiles of a render of the path into a folder. All frames have the same size.
FilmFiles FilesOfFilm(const CameraPath& path, const RenderOptions& options);

}  // namespace lf
