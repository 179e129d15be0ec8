// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/view_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "lf/core/parse_number.h"
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
  const auto number = ParseFrameNumber(std::string_view(stem).substr(kBegin.size()));
  if (!number) return std::nullopt;
  for (const FrameFormat format : {FrameFormat::kExrHalf, FrameFormat::kPng8})
    if (FramePath("", FrameId{*number}, format) == file.filename()) return number;
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

// Returns the number of the first frame of the film, which a frame states if it is not 1.
Result<uint32_t> FirstOfFilm(const fs::path& frame) {
  LF_ASSIGN_OR_RETURN(const PictureHeader header, ReadPictureHeader(frame));
  return header.colours.first_frame.value_or(1);
}

Result<std::vector<ViewMoment>> MomentsOfFolder(const fs::path& folder, int view_count) {
  LF_ASSIGN_OR_RETURN(const auto frames, FramesOf(folder));
  LF_ASSIGN_OR_RETURN(const uint32_t of_film, FirstOfFilm(frames.begin()->second));
  if (frames.begin()->first < of_film)
    return InputError(fmt::format(
        "{}: comes before frame {}, the first of its film: it belongs to another film; remove it, "
        "or give another folder",
        frames.begin()->second.string(), of_film));
  const auto views = static_cast<uint32_t>(view_count);
  // The first frame of the first moment, and the last one of the last.
  const uint32_t first = of_film + (frames.begin()->first - of_film) / views * views;
  const uint32_t last = of_film + (frames.rbegin()->first - of_film) / views * views + views - 1;
  std::vector<ViewMoment> moments;
  for (uint32_t number = first; number <= last; ++number) {
    const uint32_t view = (number - of_film) % views;
    if (view == 0) moments.push_back({static_cast<int>(of_film + (number - of_film) / views), {}});
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
  LF_ASSIGN_OR_RETURN(const uint32_t first, FirstOfFilm(files.front()));
  std::vector<ViewMoment> moments;
  for (size_t begin = 0; begin < files.size(); begin += views)
    moments.push_back({static_cast<int>(first + begin / views),
                       {files.begin() + static_cast<std::ptrdiff_t>(begin),
                        files.begin() + static_cast<std::ptrdiff_t>(begin + views)}});
  return moments;
}

// The distance of two cameras, and its part on the right axis of the first.
struct Step {
  double length_w = 0, right_w = 0;
};

Step StepBetween(const StatedCamera& from, const StatedCamera& to) {
  const auto& f = from.forward;
  const auto& u = from.up;
  const std::array<double, 3> right = {f[1] * u[2] - f[2] * u[1], f[2] * u[0] - f[0] * u[2],
                                       f[0] * u[1] - f[1] * u[0]};
  Step step;
  for (size_t i = 0; i < 3; ++i) {
    const double moved_w = to.position[i] - from.position[i];
    step.length_w += moved_w * moved_w;
    step.right_w += moved_w * right[i];
  }
  step.length_w = std::sqrt(step.length_w);
  return step;
}

bool AreParallel(const StatedCamera& a, const StatedCamera& b) {
  constexpr double kTolerance = 1e-6;
  for (size_t i = 0; i < 3; ++i)
    if (std::abs(a.forward[i] - b.forward[i]) > kTolerance ||
        std::abs(a.up[i] - b.up[i]) > kTolerance)
      return false;
  return true;
}

// Checks that the cameras of a moment are those of views, as CommonHeader() says. Positions are
// stated with nine digits, hence the tolerance.
//   cameras  of the views of the moment
//   next     camera of the first view of the next moment; null if there is none
Result<void> CheckViews(const ViewMoment& moment, std::span<const StatedCamera> cameras,
                        const StatedCamera* next) {
  if (cameras.size() < 2) return {};
  const Step first = StepBetween(cameras[0], cameras[1]);
  double size_w = 0;
  for (const double x : cameras[0].position) size_w = std::max(size_w, std::abs(x));
  const double tolerance_w = 1e-3 * first.length_w + 1e-7 * size_w;
  if (tolerance_w > first.length_w / 4) return {};
  // The files of the two eyes may be given the other way round, for crossed eyes.
  const double sign = cameras.size() == 2 && first.right_w < 0 ? -1 : 1;
  const auto is_beside = [&](const StatedCamera& a, const StatedCamera& b) {
    const Step step = StepBetween(a, b);
    return AreParallel(a, b) && std::abs(step.length_w - sign * step.right_w) <= tolerance_w &&
           std::abs(step.length_w - first.length_w) <= tolerance_w;
  };
  for (size_t i = 1; i < cameras.size(); ++i)
    if (!is_beside(cameras[i - 1], cameras[i]))
      return InputError(fmt::format(
          "{}: its camera is not the right neighbour of the camera of {}, but they would be views "
          "{} and {} of the {} of moment {}: give the frames of a path that {{lfpath quilt}} or "
          "{{stereo}} made, and the number of views that it was given",
          moment.files[i].string(), moment.files[i - 1].string(), i, i + 1, cameras.size(),
          moment.number));
  if (next != nullptr && is_beside(cameras.back(), *next))
    return InputError(fmt::format(
        "{}: would be the last of the {} views of moment {}, but the camera of the next frame "
        "stands "
        "one step to the right, like one more view of this moment: give the number of views that "
        "lfpath was given",
        moment.files.back().string(), cameras.size(), moment.number));
  return {};
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
  std::vector<std::vector<StatedCamera>> cameras(moments.size());
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
      if (other->colours.camera) cameras[i].push_back(*other->colours.camera);
    }
  });
  for (const std::optional<Error>& error : errors)
    if (error) return *error;
  for (size_t i = 0; i < moments.size(); ++i) {
    if (cameras[i].size() != moments[i].files.size()) continue;  // frames of another program
    const bool is_followed = i + 1 < moments.size() && !cameras[i + 1].empty();
    LF_RETURN_IF_ERROR(
        CheckViews(moments[i], cameras[i], is_followed ? &cameras[i + 1].front() : nullptr));
  }
  return header;
}

}  // namespace lf
