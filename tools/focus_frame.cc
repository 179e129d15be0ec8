// SPDX-License-Identifier: Apache-2.0
#include "tools/focus_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "lf/import/paths/recording_times.h"

namespace lf {

void FrameArgument::AddTo(OptionGroup& input) {
  input.Add("PATH", path, kPathHelp)->required();
  AddNumberTo(input);
}

void FrameArgument::AddNumberTo(OptionGroup& input) {
  input.Add("--frame N", frame, "Frame of PATH whose camera is used (the first)")
      ->check(CLI::Range(uint32_t{0}, kLargestFrameNumber));
}

Result<CameraPath> FrameArgument::Open(const LightField& light_field,
                                       PathOptions::Surface surface) const {
  PathOptions options = PathOptionsFor(light_field);
  options.surface = surface;
  LF_ASSIGN_OR_RETURN(CameraPath opened, OpenPath(path, options));
  LF_RETURN_IF_ERROR(FitToOpenTimes(light_field, &opened));
  if (frame && !opened.frames().Has({*frame}))
    return UsageError(fmt::format("--frame {}: {} has {} frame{}: give a number from {} to {}",
                                  *frame, path, opened.frame_count(),
                                  opened.frame_count() == 1 ? "" : "s", opened.frames().first,
                                  opened.frames().last()));
  return opened;
}

Result<void> CheckFolderName(const std::string& output, const std::string& files) {
  constexpr const char* kFiles[] = {
      ".avi", ".bmp", ".dng", ".exr",  ".gif", ".h5",  ".hdf5", ".hdr",  ".jpeg", ".jpg",
      ".jxl", ".lfp", ".lfs", ".json", ".mkv", ".mov", ".mp4",  ".npy",  ".npz",  ".pfm",
      ".ply", ".png", ".ppm", ".tif",  ".txt", ".yml", ".tiff", ".webm", ".webp", ".yaml"};
  std::string extension = std::filesystem::path(output).extension().string();
  for (char& letter : extension)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  std::error_code error;
  if (std::find(std::begin(kFiles), std::end(kFiles), extension) == std::end(kFiles) ||
      std::filesystem::is_directory(output, error))
    return {};
  return UsageError(
      fmt::format("-o {}: no {} file is written: expected the name of a folder, or of a file such "
                  "as {}",
                  output, extension, files));
}

}  // namespace lf
