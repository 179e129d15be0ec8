// SPDX-License-Identifier: Apache-2.0
#include "lf/densify/depth_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <utility>
#include <variant>

#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/value_hasher.h"
#include "lf/pixels/codec/lf_image_codec.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExtension = ".lfdepth";
constexpr const char* kFolderExtension = ".depths";

// A file begins with a line of the words lfdepth and 1, the key, and a hash of key and content.
std::string HeadOf(const std::string& key, std::string_view content) {
  return fmt::format("lfdepth 1 {} {:016x}\n", key, HashBytes(content, HashBytes(key)));
}

void AddFile(const fs::path& path, ValueHasher* hasher) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return hasher->Add(std::string("missing"));
  hasher->Add(static_cast<double>(status.st_size));
  hasher->Add(static_cast<double>(status.st_mtim.tv_sec));
  hasher->Add(static_cast<double>(status.st_mtim.tv_nsec));
}

void AddEncoding(const RadianceEncoding& encoding, ValueHasher* hasher) {
  hasher->Add(std::string(NameOf(encoding.bayer)));
  hasher->Add(static_cast<double>(encoding.transfer));
  hasher->Add(static_cast<double>(encoding.response.size()));
  for (const double value : encoding.response) hasher->Add(value);
  for (const double value : {encoding.black_level, encoding.white_level.value_or(-1),
                             encoding.max_radiance, encoding.overshoot_room, encoding.pedestal})
    hasher->Add(value);
  hasher->Add(static_cast<double>(encoding.alpha.value_or(AlphaMeaning::kMask)));
  for (const double value : encoding.Background()) hasher->Add(value);
  hasher->Add(static_cast<double>(encoding.keeps_opacity));
  hasher->Add(static_cast<double>(encoding.masks_clipped));
  for (const double value : encoding.white_balance) hasher->Add(value);
  hasher->AddMatrix(encoding.linear_srgb_from_camera);
}

}  // namespace

fs::path DepthCache::FileOf(const Entry& entry) const {
  return folder_ / (entry.name + kExtension);
}

bool DepthCache::MayHave(const Entry& entry) const {
  std::error_code ignored;
  return !folder_.empty() && fs::exists(FileOf(entry), ignored);
}

std::optional<std::string> DepthCache::Find(const Entry& entry) const {
  if (!MayHave(entry)) return std::nullopt;
  const fs::path path = FileOf(entry);
  Result<std::string> bytes = ReadFile(path);
  if (!bytes) {
    LogWarning("{}; what it held is made again", bytes.error().message);
    return std::nullopt;
  }
  const size_t head_size = HeadOf(entry.key, "").size();
  const std::string head = bytes->substr(0, head_size);
  std::string content = bytes->substr(head.size());
  if (head == HeadOf(entry.key, content)) return content;
  // The head of an entry of other LF images is right for its own key.
  const size_t key_begin = std::string_view("lfdepth 1 ").size();
  const std::string key = head.size() < head_size ? "" : head.substr(key_begin, entry.key.size());
  if (key.empty() || head != HeadOf(key, content))
    LogWarning("{}: is damaged; what it held is made again", path.string());
  return std::nullopt;
}

std::optional<DepthPlane> DepthCache::FindPlane(const Entry& entry, int width, int height) const {
  const std::optional<std::string> code = Find(entry);
  if (!code) return std::nullopt;
  const Result<CodeInfo> info = ReadCodeInfo(*code);
  DecodedPart part;
  if (info && info->width == width && info->height == height && DecodeImage(*code, &part))
    if (auto* plane = std::get_if<DepthPlane>(&part.pixels)) return std::move(*plane);
  LogWarning("{}: is damaged; what it held is made again", FileOf(entry).string());
  return std::nullopt;
}

bool DepthCache::Keep(const Entry& entry, std::string_view content) {
  if (folder_.empty() || is_off_) return false;
  Result<void> result = CreateFolder(folder_);
  if (result) {
    std::string bytes = HeadOf(entry.key, content);
    bytes += content;
    result = WriteFileAtomically(FileOf(entry), bytes);
  }
  if (!result && !is_off_.exchange(true))
    LogWarning("{}; depths are not kept for other calls", result.error().message);
  return result.has_value();
}

bool DepthCache::KeepPlane(const Entry& entry, const DepthPlane& plane) {
  if (folder_.empty() || is_off_) return false;
  return Keep(entry, EncodeImage(plane, PixelLayout::kGrey, {.profile = CodecProfile::kLossless}));
}

std::optional<std::vector<double>> DepthCache::FindNumbers(const Entry& entry) const {
  const std::optional<std::string> bytes = Find(entry);
  if (!bytes) return std::nullopt;
  std::vector<double> numbers(bytes->size() / sizeof(double));
  std::memcpy(numbers.data(), bytes->data(), numbers.size() * sizeof(double));
  return numbers;
}

bool DepthCache::KeepNumbers(const Entry& entry, std::span<const double> numbers) {
  return Keep(entry, {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()});
}

fs::path DepthCacheBeside(const LightField& light_field) {
  std::error_code error;
  const fs::path place = fs::canonical(light_field.folder, error);
  if (error || !place.has_parent_path() || !place.has_filename()) return {};
  struct stat status {};
  const fs::path around = place.parent_path();
  if (::stat(around.c_str(), &status) != 0 || status.st_uid != ::geteuid() ||
      ::access(around.c_str(), W_OK | X_OK) != 0)
    return {};
  return fs::path(place) += kFolderExtension;
}

Result<fs::path> DepthCacheFolder(const std::string& chosen, const LightField& light_field) {
  if (chosen == "none") return fs::path();
  if (chosen.empty()) return DepthCacheBeside(light_field);
  std::error_code error;
  if (fs::exists(chosen, error) && !fs::is_directory(chosen, error))
    return UsageError(fmt::format("{{cache {}}}: is a file, expected a folder or none", chosen));
  return fs::path(chosen);
}

LfImageKeys::LfImageKeys(const LightField& light_field, int version) {
  const bool is_packed = HoldsPackedStore(light_field);
  ValueHasher common;
  common.Add(version);
  AddEncoding(light_field.encoding, &common);
  if (is_packed) AddFile(light_field.folder, &common);
  const std::string of_all = common.Text();
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const LfImageId id{i};
    const LfCamera& camera = light_field.cameras[i];
    ValueHasher hasher;
    hasher.Add(of_all);
    hasher.Add(light_field.image_names[i]);
    if (!is_packed) {
      AddFile(ImageFileOf(light_field, id), &hasher);
      const std::string mask = light_field.mask_names.empty() ? "" : light_field.mask_names[i];
      hasher.Add(mask);
      if (!mask.empty()) AddFile(light_field.folder / mask, &hasher);
    }
    hasher.Add(camera.cam_from_world);
    hasher.Add(light_field.intrinsics[camera.intrinsics_index]);
    for (const float gain : camera.gain.of_channels) hasher.Add(gain);
    names_.push_back(light_field.image_names[i]);
    keys_.push_back(hasher.Text());
  }
}

// The name holds the settings, which a user may change and change back, and the key the content of
// the files. An entry of changed files is therefore replaced, and does not stay for ever.
DepthCache::Entry LfImageKeys::PlaneOf(uint32_t id, std::span<const uint32_t> compared,
                                       const InverseDepths& range, int planes, int divisor) const {
  ValueHasher name, key;
  for (const double setting : {range.least, range.greatest, 1.0 * planes, 1.0 * divisor})
    name.Add(setting);
  name.Add(names_[id]);
  key.Add(keys_[id]);
  for (const uint32_t other : compared) {
    name.Add(names_[other]);
    key.Add(keys_[other]);
  }
  return {"plane-" + name.Text(), key.Text()};
}

DepthCache::Entry LfImageKeys::OfAll(const std::string& name, const std::string& settings) const {
  ValueHasher hasher, key;
  hasher.Add(settings);
  for (size_t i = 0; i < keys_.size(); ++i) {
    hasher.Add(names_[i]);
    key.Add(keys_[i]);
  }
  return {name + "-" + hasher.Text(), key.Text()};
}

}  // namespace lf
