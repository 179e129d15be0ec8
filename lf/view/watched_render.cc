// SPDX-License-Identifier: Apache-2.0
#include "lf/view/watched_render.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>
#include <variant>

#include "lf/core/parse_number.h"
#include "lf/film/develop/picture.h"
#include "lf/light_field/model/radiance.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

// Levels of folders below the output folder that are searched. The deepest folders with pictures
// are those of packages, such as partial/package-0000/.
constexpr int kMostNested = 2;
constexpr size_t kMostDigits = 7;

// Returns the frame number in a file name such as frame_0001.exr or frame_0001.png; nullopt for
// other names.
std::optional<FrameId> FrameOfName(const fs::path& path) {
  const std::string stem = path.stem().string(), extension = path.extension().string();
  constexpr std::string_view kPrefix = "frame_";
  if (!stem.starts_with(kPrefix) || (extension != ".exr" && extension != ".png")) return {};
  const std::string_view digits = std::string_view(stem).substr(kPrefix.size());
  const auto number = digits.size() > kMostDigits ? std::nullopt : ParseWhole<uint32_t>(digits);
  return number ? std::optional(FrameId{*number}) : std::nullopt;
}

int64_t ChangedNanoseconds(const fs::path& path) {
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0) return 0;
  return int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec;
}

// Adds the frames in a folder, and those of checkpoints in its subfolders. `nested` is the level of
// the folder below the output folder (0); only `partial` and its subfolders are searched below it.
void AddFramesIn(const fs::path& folder, int nested, std::map<uint32_t, WatchedFrame>* frames) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored)) {
      const bool is_state = nested > 0 || entry->path().filename() == "partial";
      if (is_state && nested < kMostNested) AddFramesIn(entry->path(), nested + 1, frames);
      continue;
    }
    const std::optional<FrameId> frame = FrameOfName(entry->path());
    if (!frame) continue;
    const WatchedFrame found = {*frame, entry->path(), nested == 0,
                                ChangedNanoseconds(entry->path())};
    const auto [known, is_new] = frames->try_emplace(frame->value, found);
    if (!is_new && std::pair(found.is_finished, found.changed_ns) >
                       std::pair(known->second.is_finished, known->second.changed_ns))
      known->second = found;
  }
}

// Returns the linear light of a stored value: floats are linear, integers sRGB.
template <class T>
float Linear(T value) {
  if constexpr (std::is_same_v<T, float>)
    return value;
  else
    return static_cast<float>(
        LinearFromSrgb(static_cast<double>(value) / std::numeric_limits<T>::max()));
}

// Returns the factor by which the linear colours of an element are multiplied to show it over
// black: alpha for integer files, whose colours are not multiplied by alpha; 1 for float files and
// files without alpha.
template <class T>
float Covers(const Image<T>& image, int x, int y, int alpha_channel) {
  if (alpha_channel < 0 || std::is_same_v<T, float>) return 1;
  return static_cast<float>(image.at(x, y, alpha_channel)) /
         static_cast<float>(std::numeric_limits<T>::max());
}

template <class T>
Image<float> Shrunken(const Image<T>& image, const std::array<int, 3>& count_channels,
                      int alpha_channel, int max_side_px) {
  const bool has_rays = count_channels[0] >= 0;
  const int factor = std::max(
      1, (std::max(image.width(), image.height()) + max_side_px - 1) / std::max(1, max_side_px));
  Image<float> small((image.width() + factor - 1) / factor, (image.height() + factor - 1) / factor,
                     4);
  for (int y = 0; y < small.height(); ++y)
    for (int x = 0; x < small.width(); ++x) {
      std::array<float, 4> sum = {};
      int count = 0;
      for (int v = y * factor; v < std::min(image.height(), (y + 1) * factor); ++v)
        for (int u = x * factor; u < std::min(image.width(), (x + 1) * factor); ++u, ++count) {
          const float covers = Covers(image, u, v, alpha_channel);
          for (int c = 0; c < 3; ++c) sum[c] += covers * Linear(image.at(u, v, c));
          if (has_rays)
            for (const int c : count_channels) sum[3] += static_cast<float>(image.at(u, v, c)) / 3;
        }
      for (int c = 0; c < 4; ++c) small.at(x, y, c) = sum[c] / static_cast<float>(count);
      if (!has_rays) small.at(x, y, 3) = -1;
    }
  return small;
}

}  // namespace

std::vector<WatchedFrame> LookAtRender(const fs::path& folder) {
  std::map<uint32_t, WatchedFrame> frames;
  AddFramesIn(folder, 0, &frames);
  std::vector<WatchedFrame> list;
  for (auto& [number, frame] : frames) list.push_back(std::move(frame));
  return list;
}

GrowingPicture PictureOf(const DevelopedFrame& frame, int max_side_px) {
  GrowingPicture picture;
  picture.full_width_px = frame.rgb.width();
  picture.full_height_px = frame.rgb.height();
  picture.has_rays = true;
  Image<float> all(frame.rgb.width(), frame.rgb.height(), 6);
  for (int y = 0; y < all.height(); ++y)
    for (int x = 0; x < all.width(); ++x)
      for (int c = 0; c < 3; ++c) {
        all.at(x, y, c) = frame.rgb.at(x, y, c);
        all.at(x, y, 3 + c) = static_cast<float>(frame.ray_count.at(x, y, c));
      }
  picture.elements = Shrunken(all, {3, 4, 5}, -1, max_side_px);
  return picture;
}

Result<GrowingPicture> ReadGrowingPicture(const fs::path& path, int max_side_px) {
  LF_ASSIGN_OR_RETURN(const ImageWithInfo read, ReadImageWithInfo(path));
  if (read.info.channels < 3)
    return InputError(fmt::format("{}: has {} channels, expected at least R, G and B",
                                  path.string(), read.info.channels));
  const auto channel_named = [&](const std::string& name) {
    const auto& names = read.info.channel_names;
    const auto found = std::find(names.begin(), names.end(), name);
    return found != names.end() ? static_cast<int>(found - names.begin()) : -1;
  };
  std::array<int, 3> count_channels = {-1, -1, -1};
  for (const auto& names : {kCountChannels, kLayeredCountChannels}) {
    std::array<int, 3> found = {};
    std::transform(names.begin(), names.end(), found.begin(), channel_named);
    if (std::find(found.begin(), found.end(), -1) == found.end()) count_channels = found;
  }
  GrowingPicture picture;
  picture.full_width_px = read.info.width;
  picture.full_height_px = read.info.height;
  picture.has_rays = count_channels[0] >= 0;
  picture.elements = std::visit(
      [&](const auto& image) {
        return Shrunken(image, count_channels, channel_named("A"), max_side_px);
      },
      read.image);
  return picture;
}

}  // namespace lf
