// Writes the picture of a frame, and contact sheet and video from pictures. Internal to this
// folder.
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
#include "lf/render/pipeline/render.h"
#include "lf/render/state/plate_notes.h"

namespace lf {

// Returns true if a file of the format has DevelopedFrame::effective_count.
bool HasEffectiveCounts(FrameFormat format);

// Writes a developed picture to the file `to`.
//   is_interrupted  called often, by any thread; may be empty. The picture may be unusable if it
//                   returns true.
// kOutput: the file cannot be written. kInterrupted: nothing is written.
Result<void> WritePicture(const PlateNotes& notes, const DevelopedFrame& picture,
                          const std::filesystem::path& to, FrameFormat format,
                          const std::function<bool()>& is_interrupted);

inline constexpr const char* kContactSheet = "contact_sheet.png";

// A film whose frames are files. It does not matter when, or by which process, they were rendered.
struct FilmFiles {
  std::filesystem::path folder;
  FrameFormat format = FrameFormat::kExrHalf;
  int width_px = 0;
  int height_px = 0;
  double fps = 0;
  const std::atomic<bool>* stop = nullptr;  // interrupts the functions when true; may be null

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

// Returns the film of the frames that a render of the path writes. All frames have the same size.
FilmFiles FilesOfFilm(const CameraPath& path, const RenderOptions& options);

}  // namespace lf
