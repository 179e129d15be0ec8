// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/view_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "lf/film/develop/frame_file.h"
#include "lf/film/develop/join_views.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the number in a name such as frame_0012.png; none for other names.
std::optional<uint32_t> NumberInName(const fs::path& file) {
  const std::string stem = file.stem().string();
  constexpr std::string_view kBegin = "frame_";
  if (!stem.starts_with(kBegin)) return std::nullopt;
  uint32_t number = 0;
  const char* const end = stem.data() + stem.size();
  const std::from_chars_result read = std::from_chars(stem.data() + kBegin.size(), end, number);
  const fs::path extension = file.extension();
  if (read.ec != std::errc() || read.ptr != end || number == 0) return std::nullopt;
  for (const FrameFormat format : {FrameFormat::kExrHalf, FrameFormat::kPng8})
    if (FramePath("", FrameId{number}, format) == file.filename()) return number;
  return std::nullopt;
}

// Returns the frames of a folder by their numbers.
Result<std::map<uint32_t, fs::path>> FramesOf(const fs::path& folder) {
  std::map<uint32_t, fs::path> frames;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const std::optional<uint32_t> number = NumberInName(i->path());
    if (!number) continue;
    const auto [other, is_new] = frames.emplace(*number, i->path());
    if (!is_new)
      return InputError(
          fmt::format("{}: has the frame {} as {} and as {}: name the files of one format instead "
                      "of the folder",
                      folder.string(), *number, other->second.filename().string(),
                      i->path().filename().string()));
  }
  if (error)
    return InputError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
  if (frames.empty())
    return InputError(fmt::format(
        "{}: has no frames: expected files such as frame_0001.png or frame_0001.exr, which "
        "lfrenderer writes",
        folder.string()));
  const fs::path extension = frames.begin()->second.extension();
  for (const auto& [number, file] : frames)
    if (file.extension() != extension)
      return InputError(fmt::format("{}: has the frames {} and {}: expected frames of one format",
                                    folder.string(), frames.begin()->second.filename().string(),
                                    file.filename().string()));
  return frames;
}

Result<std::vector<ViewMoment>> MomentsOfFolder(const fs::path& folder, int view_count) {
  LF_ASSIGN_OR_RETURN(const auto frames, FramesOf(folder));
  const auto views = static_cast<uint32_t>(view_count);
  // The first frame of the first moment, and the last one of the last.
  const uint32_t first = (frames.begin()->first - 1) / views * views + 1;
  const uint32_t last = (frames.rbegin()->first - 1) / views * views + views;
  std::vector<ViewMoment> moments;
  for (uint32_t number = first; number <= last; ++number) {
    const uint32_t view = (number - 1) % views;
    if (view == 0) moments.push_back({static_cast<int>((number - 1) / views + 1), {}});
    const auto found = frames.find(number);
    if (found == frames.end())
      return InputError(fmt::format(
          "{}: the frame {} is missing, which is view {} of {} at moment {}: render it, or state "
          "the number of views that the path has",
          folder.string(), number, view + 1, views, moments.back().number));
    moments.back().files.push_back(found->second);
  }
  return moments;
}

Result<std::vector<ViewMoment>> MomentsOfFiles(std::span<const fs::path> files, int view_count) {
  const auto views = static_cast<size_t>(view_count);
  for (const fs::path& file : files) {
    if (file.extension() != ".png" && file.extension() != ".exr")
      return UsageError(
          fmt::format("{}: expected a folder, or frames as .png or .exr files", file.string()));
    if (file.extension() != files[0].extension())
      return UsageError(fmt::format("{} and {}: expected frames of one format", files[0].string(),
                                    file.string()));
  }
  if (files.size() % views != 0)
    return UsageError(fmt::format(
        "the number of frames is {}, from {} to {}: expected a multiple of {}, the number of views",
        files.size(), files.front().string(), files.back().string(), views));
  std::vector<ViewMoment> moments;
  for (size_t begin = 0; begin < files.size(); begin += views)
    moments.push_back({static_cast<int>(begin / views + 1),
                       {files.begin() + static_cast<std::ptrdiff_t>(begin),
                        files.begin() + static_cast<std::ptrdiff_t>(begin + views)}});
  return moments;
}

}  // namespace

Result<std::vector<ViewMoment>> FindViewMoments(std::span<const fs::path> paths, int view_count) {
  LF_CHECK(!paths.empty() && view_count >= 1);
  std::error_code error;
  const auto folder = std::find_if(paths.begin(), paths.end(), [&](const fs::path& path) {
    return fs::is_directory(path, error);
  });
  if (folder == paths.end()) return MomentsOfFiles(paths, view_count);
  if (paths.size() > 1)
    return UsageError(
        fmt::format("{} is a folder beside other arguments: expected one folder, or "
                    "the files of the frames",
                    folder->string()));
  return MomentsOfFolder(*folder, view_count);
}

Result<PictureHeader> CommonHeader(std::span<const ViewMoment> moments, ThreadPool& pool) {
  const fs::path& first = moments.front().files.front();
  LF_ASSIGN_OR_RETURN(const PictureHeader header, ReadPictureHeader(first));
  const std::string kind = KindOf(header);
  std::vector<std::optional<Error>> errors(moments.size());
  pool.ForEach(moments.size(), [&](size_t i) {
    for (const fs::path& file : moments[i].files) {
      const Result<PictureHeader> other = ReadPictureHeader(file);
      if (!other)
        errors[i] = other.error();
      else if (KindOf(*other) != kind)
        errors[i] =
            InputError(fmt::format("{}: has {}, but {} has {}: all views must have the same",
                                   file.string(), KindOf(*other), first.string(), kind));
      if (errors[i]) return;
    }
  });
  for (const std::optional<Error>& error : errors)
    if (error) return *error;
  return header;
}

}  // namespace lf
