// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/find_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/light_field/model/folded_name.h"
#include "lf/light_field/model/image_files.h"
#include "lf/pixels/files/picture_view.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kAsked = 64;  // number of evenly spread LF images whose files are examined
constexpr int kMostDepth = 4;  // levels of folders that are searched, counting the topmost
constexpr size_t kMostFiles = 2000000;  // largest number of image files that are listed
constexpr int kMostDivisor = 16;  // largest factor by which files may be smaller than calibrated

// Returns the path with slashes where Windows writes backslashes.
std::string WithSlashes(std::string path) {
  std::replace(path.begin(), path.end(), '\\', '/');
  return path;
}

// Returns the base name without its suffix, then the folders of the path from the last to the
// first, each as FoldedName() returns it. Both slashes and backslashes separate folders.
std::vector<std::string> WordsOf(const std::string& path) {
  std::vector<std::string> words;
  for (const fs::path& part : fs::path(FoldedName(WithSlashes(path))).lexically_normal())
    words.push_back(part);
  if (!words.empty()) words.back() = fs::path(words.back()).stem().string();
  std::reverse(words.begin(), words.end());
  return words;
}

bool HoldsSomethingElse(const std::vector<std::string>& words) {
  return std::any_of(words.begin() + 1, words.end(), NamesSomethingElse);
}

// Returns the indices of up to kAsked LF images, evenly spread over `count` and including the first
// and the last.
std::vector<size_t> SpreadOver(size_t count) {
  const size_t asked = std::min(count, kAsked);
  std::vector<size_t> spread;
  for (size_t i = 0; i < asked; ++i)
    spread.push_back(asked == 1 ? 0 : i * (count - 1) / (asked - 1));
  return spread;
}

bool IsThere(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(FileOfImage(path), error);
}

// Returns the path without its first `count` parts, whose slashes are those of Linux.
fs::path WithoutFirst(size_t count, const std::string& path) {
  const fs::path whole(WithSlashes(path));
  fs::path rest;
  for (const fs::path& part : whole)
    if (count > 0)
      --count;
    else
      rest /= part;
  return rest;
}

// A way from the names of a calibration to the files: the folder, and the number of parts that each
// name loses at its beginning.
struct WayToFiles {
  fs::path folder;
  size_t lost_count = 0;
};

// Searches the end of a path in the folder of the calibration and the two above it: the longest end
// first. At least the base name and its folder must agree.
std::optional<WayToFiles> FindEnd(const std::string& name, const fs::path& folder) {
  const fs::path path(WithSlashes(name));
  const auto part_count = static_cast<size_t>(std::distance(path.begin(), path.end()));
  for (size_t lost = 0; lost == 0 || lost + 2 <= part_count; ++lost) {
    const fs::path end = WithoutFirst(lost, name);
    if (end.is_absolute()) continue;
    for (const char* const above : {"", "..", "../.."}) {
      const fs::path root = *above == '\0' ? folder : (folder / above).lexically_normal();
      if (IsThere(root / end)) return WayToFiles{root, lost};
    }
  }
  return std::nullopt;
}

// Finds files whose paths end like the names: paths of Windows, and those of another place on a
// disk. Returns the number of LF images with a file, 0 if nothing is changed.
size_t FindByEnds(const std::vector<size_t>& asked, LightField* light_field) {
  std::optional<WayToFiles> way;
  for (size_t i = 0; i < asked.size() && !way; ++i)
    way = FindEnd(light_field->image_names[asked[i]], light_field->folder);
  if (!way) return 0;
  const std::string before = light_field->image_names[0];
  size_t found_count = 0;
  for (std::string& name : light_field->image_names) {
    const fs::path end = WithoutFirst(way->lost_count, name);
    if (end.empty()) continue;
    name = end.string();
    found_count += IsThere(way->folder / end) ? 1 : 0;
  }
  for (std::string& mask : light_field->mask_names)
    if (const fs::path end = WithoutFirst(way->lost_count, mask); IsThere(way->folder / end))
      mask = end.string();
  light_field->folder = way->folder;
  if (light_field->size() > 1)
    LogInfo("{} of {} LF images were found where their paths end, such as {} for {}", found_count,
            light_field->size(), light_field->ImagePath({0}).string(), before);
  return found_count;
}

// Image files in a folder and its subfolders, indexed by their base names.
class FilesBelow {
 public:
  explicit FilesBelow(const fs::path& folder) : folder_(folder) {
    std::error_code error;
    fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied,
                                        error);
    for (const fs::recursive_directory_iterator end; !error && it != end; it.increment(error)) {
      const std::string name = it->path().filename().string();
      std::error_code ignored;
      if (it->is_directory(ignored)) {
        if (name.starts_with('.') || it.depth() + 1 >= kMostDepth) it.disable_recursion_pending();
        continue;
      }
      if (name.starts_with('.') || !IsImageName(name)) continue;
      if (files_.size() == kMostFiles) break;
      const std::string relative = it->path().lexically_relative(folder).string();
      files_.push_back({relative, WordsOf(relative)});
    }
    for (size_t i = 0; i < files_.size(); ++i) by_stem_[files_[i].words[0]].push_back(i);
  }

  struct Match {
    const std::string* name = nullptr;   // best file, relative to the folder; nullptr: none fits
    const std::string* rival = nullptr;  // another file that fits equally well
  };

  // Returns the file that fits `name` best.
  //   least_common  number of last parts of the path that must agree, counting the base name
  //   any_folder    true: also accepts files in folders for something other than photographs
  Match Find(const std::string& name, size_t least_common, bool any_folder) {
    const std::vector<std::string> words = WordsOf(name);
    if (words.empty()) return {};
    auto found = by_stem_.find(words[0]);
    if (found == by_stem_.end()) {
      if (by_undated_.empty())
        for (size_t i = 0; i < files_.size(); ++i)
          by_undated_[WithoutDate(files_[i].words[0])].push_back(i);
      found = by_undated_.find(WithoutDate(words[0]));
      if (found == by_undated_.end()) return {};
    }
    const bool is_other = any_folder || HoldsSomethingElse(words);
    Match match;
    Score best;
    for (const size_t i : found->second) {
      if (!is_other && HoldsSomethingElse(files_[i].words)) continue;
      const Score score = ScoreOf(files_[i], words, found->second.size() > 1);
      if (score.common < least_common || (match.name != nullptr && score < best)) continue;
      const bool is_same = match.name != nullptr && !(best < score);
      match.rival = is_same ? match.name : nullptr;
      match.name = &files_[i].name;
      best = score;
    }
    return match;
  }

 private:
  struct File {
    std::string name;
    std::vector<std::string> words;
  };
  struct Score {
    size_t common = 0;   // number of last parts of the path that agree, counting the base name
    int64_t pixels = 0;  // number of pixels of the first image of the file's folder
    int64_t above = 0;   // negated number of parts of the file's path: fewer folders are better
    bool operator<(const Score& other) const {
      return std::tie(common, pixels, above) < std::tie(other.common, other.pixels, other.above);
    }
  };

  Score ScoreOf(const File& file, const std::vector<std::string>& words, bool has_rivals) {
    // The base names agree, perhaps but for a date.
    const auto end =
        std::mismatch(file.words.begin() + 1, file.words.end(), words.begin() + 1, words.end());
    Score score;
    score.common = static_cast<size_t>(end.first - file.words.begin());
    if (has_rivals) score.pixels = PixelsIn(fs::path(file.name).parent_path());
    score.above = -static_cast<int64_t>(file.words.size());
    return score;
  }

  // Returns the number of pixels of the first image of a folder; 0 if its header cannot be read.
  int64_t PixelsIn(const fs::path& folder) {
    const auto [entry, is_new] = pixels_.try_emplace(folder.string(), 0);
    if (!is_new) return entry->second;
    const Result<std::vector<std::string>> names = SortedImageNames(folder_ / folder);
    if (!names || names->empty()) return 0;
    const auto size = ImageSizeInHeader(folder_ / folder / names->front());
    if (size) entry->second = int64_t{(*size)[0]} * (*size)[1];
    return entry->second;
  }

  fs::path folder_;
  std::vector<File> files_;
  // Indices into files_, by the folded base name without extension. by_undated_, by the name
  // without a date, is empty until a name is not found.
  std::unordered_map<std::string, std::vector<size_t>> by_stem_, by_undated_;
  std::unordered_map<std::string, int64_t> pixels_;  // results of PixelsIn(), by folder
};

// Returns true if `pixels` is `full` divided by `divisor`, rounded up, down or to the nearest.
bool IsDivided(int full, double divisor, int pixels) {
  return std::abs(full / divisor - pixels) < 1;
}

bool IsScaled(const Intrinsics& k, const std::array<int, 2>& size, double divisor) {
  return IsDivided(k.width_px, divisor, size[0]) && IsDivided(k.height_px, divisor, size[1]);
}

struct SizedImage {
  LfImageId id;
  std::array<int, 2> size;
};

// Returns the sizes of evenly spread LF images whose files exist.
std::vector<SizedImage> SizesOfSome(const LightField& light_field) {
  std::vector<SizedImage> sizes;
  for (const size_t i : SpreadOver(light_field.size())) {
    const LfImageId id{static_cast<uint32_t>(i)};
    const fs::path path = light_field.ImagePath(id);
    if (!IsThere(path)) continue;
    if (const auto size = ImageSizeInHeader(path)) sizes.push_back({id, *size});
  }
  return sizes;
}

const Intrinsics& IntrinsicsOf(const LightField& light_field, LfImageId id) {
  return light_field.intrinsics[light_field.cameras[id.value].intrinsics_index];
}

// Returns the smallest factor from 2 to kMostDivisor by which all images in `sizes` are smaller
// than calibrated; 1 if there is none.
int DivisorOf(const LightField& light_field, const std::vector<SizedImage>& sizes) {
  for (int divisor = 2; divisor <= kMostDivisor; ++divisor)
    if (std::all_of(sizes.begin(), sizes.end(), [&](const SizedImage& image) {
          return IsScaled(IntrinsicsOf(light_field, image.id), image.size, divisor);
        }))
      return divisor;
  return 1;
}

void Scale(const std::array<int, 2>& size, Intrinsics* k) {
  const double x = static_cast<double>(size[0]) / k->width_px;
  const double y = static_cast<double>(size[1]) / k->height_px;
  k->fx_px *= x;
  k->cx_px *= x;
  k->skew_px *= x;
  k->fy_px *= y;
  k->cy_px *= y;
  k->width_px = size[0];
  k->height_px = size[1];
}

}  // namespace

bool NamesSomethingElse(const std::string& folder_name) {
  constexpr const char* kOthers[] = {"mask", "depth", "normal", "semantic", "segment", "alpha"};
  return std::any_of(std::begin(kOthers), std::end(kOthers), [&](const char* other) {
    return folder_name.find(other) != std::string::npos;
  });
}

bool IsWholeFraction(const Intrinsics& k, const std::array<int, 2>& size) {
  for (int divisor = 1; divisor <= kMostDivisor; ++divisor)
    if (IsScaled(k, size, divisor)) return true;
  return false;
}

bool HasSomeImageFiles(const LightField& light_field) {
  const std::vector<size_t> asked = SpreadOver(light_field.size());
  return std::any_of(asked.begin(), asked.end(), [&](size_t i) {
    return IsThere(light_field.ImagePath(LfImageId{static_cast<uint32_t>(i)}));
  });
}

Result<size_t> FindImageFiles(const std::optional<fs::path>& images_folder,
                              LightField* light_field) {
  const std::vector<size_t> asked = SpreadOver(light_field->size());
  const bool is_there = HasSomeImageFiles(*light_field);
  const fs::path folder = images_folder ? *images_folder : light_field->folder;
  if (is_there && folder == light_field->folder) return 0;
  if (!images_folder)
    if (const size_t count = FindByEnds(asked, light_field); count > 0) return count;
  size_t found_count = 0, ambiguous_count = 0;
  std::string example, looked_for;
  FilesBelow files(folder);
  std::vector<std::string> names = light_field->image_names, masks = light_field->mask_names;
  const auto find = [&](std::string* name, size_t least_common, bool any_folder) {
    const FilesBelow::Match match = files.Find(*name, least_common, any_folder);
    if (match.name == nullptr) return false;
    if (match.rival != nullptr) {
      if (ambiguous_count++ == 0) example = fmt::format("{} and {}", *match.rival, *match.name);
      return false;
    }
    *name = *match.name + ViewSuffix(*name);
    return true;
  };
  for (std::string& name : names) {
    const std::string before = name;
    if (!find(&name, 1, false) || found_count++ > 0) continue;
    looked_for = before;
    if (ambiguous_count == 0) example = name;
  }
  if (ambiguous_count > 0)
    return InputError(
        fmt::format("{}: contains several files of the same name for {} of {} LF images, such as "
                    "{}: give the folder of the right files ({{images}})",
                    folder.string(), ambiguous_count, light_field->size(), example));
  if (found_count == 0) return 0;
  // A mask must not match a file with the same name in another folder, such as a photograph.
  for (std::string& mask : masks)
    if (!mask.empty() && !IsThere(light_field->folder / mask)) find(&mask, 2, true);
  // Readers call this function for one image to get its size, and later for all images; only the
  // call for all images is logged.
  if (names.size() > 1)
    LogInfo("{} of {} LF images were found by their names in {}, such as {} for {}", found_count,
            light_field->size(), folder.string(), example, looked_for);
  light_field->image_names = std::move(names);
  light_field->mask_names = std::move(masks);
  light_field->folder = folder;
  return found_count;
}

Result<ImageScale> ParseImageScale(const std::string& text) {
  if (text == "auto") return ImageScale{};
  if (text == "off") return ImageScale{ImageScale::Kind::kOff};
  const std::optional<double> factor = ParseNumber(text);
  if (!factor || !(*factor > 0 && *factor <= 100))
    return UsageError(fmt::format(
        "{{image_scale {}}}: expected auto, off, or a factor above 0 and up to 100, such "
        "as 0.25 (the size of the image files divided by the calibrated size)",
        text));
  return ImageScale{ImageScale::Kind::kFactor, *factor};
}

Result<double> FitToImageFiles(const ImageScale& scale, LightField* light_field) {
  if (scale.kind == ImageScale::Kind::kOff) return 1;
  const std::vector<SizedImage> sizes = SizesOfSome(*light_field);
  double divisor = 1 / scale.factor;
  if (scale.kind == ImageScale::Kind::kAuto) divisor = DivisorOf(*light_field, sizes);
  if (sizes.empty() || divisor == 1) return 1;
  std::map<std::array<int, 2>, std::array<int, 2>> size_of;  // size of files by calibrated size
  for (const SizedImage& image : sizes) {
    const Intrinsics& k = IntrinsicsOf(*light_field, image.id);
    if (!IsScaled(k, image.size, divisor))
      return InputError(fmt::format(
          "{{image_scale {}}}: {} has {} x {} pixels, which is not this factor times the "
          "calibrated {} x {}: give another factor, or auto",
          scale.factor, light_field->ImagePath(image.id).string(), image.size[0], image.size[1],
          k.width_px, k.height_px));
    size_of[{k.width_px, k.height_px}] = image.size;
  }
  const auto rounded = [divisor](int full) {
    return std::max(1, static_cast<int>(std::lround(full / divisor)));
  };
  for (Intrinsics& k : light_field->intrinsics) {
    const auto known = size_of.find({k.width_px, k.height_px});
    Scale(known != size_of.end() ? known->second
                                 : std::array{rounded(k.width_px), rounded(k.height_px)},
          &k);
  }
  return 1 / divisor;
}

}  // namespace lf
