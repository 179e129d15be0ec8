// SPDX-License-Identifier: Apache-2.0
// Keeps what is found out about recorded LF images in a folder: depth planes, and the results of
// tests. They depend on the light field alone, so that other paths and other numbers of virtual LF
// images need no new search.
//
// Each entry is a file, which is written under a temporary name: processes may use a folder at the
// same time, and any file may be removed at any time. An entry whose LF images, poses or settings
// have changed is not found.
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/result.h"
#include "lf/densify/depth_plane.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

class DepthCache {
 public:
  // An empty folder: nothing is found or kept. The folder is made when it is needed.
  explicit DepthCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  struct Entry {
    std::string name;  // of the file: what the entry is, such as the plane of an LF image
    std::string key;   // a hash of all that the content depends on
  };

  // Returns true if there is a file for the entry, whose content may be of other LF images.
  bool MayHave(const Entry& entry) const;
  // Returns the content of an entry; nullopt if there is none. Warns of one that is damaged.
  std::optional<std::string> Find(const Entry& entry) const;
  // Returns the plane of this size that is the content of an entry; nullopt as Find().
  std::optional<DepthPlane> FindPlane(const Entry& entry, int width, int height) const;
  // Keeps the content. If it cannot be written, warns, keeps nothing from then on, and returns
  // false. These functions may be called by many threads at the same time.
  bool Keep(const Entry& entry, std::string_view content);
  bool KeepPlane(const Entry& entry, const DepthPlane& plane);
  // As Find() and Keep(), for numbers.
  std::optional<std::vector<double>> FindNumbers(const Entry& entry) const;
  bool KeepNumbers(const Entry& entry, std::span<const double> numbers);

 private:
  std::filesystem::path FileOf(const Entry& entry) const;

  std::filesystem::path folder_;
  std::atomic<bool> is_off_ = false;
};

// Returns the folder of the entries of a light field, beside it: FOLDER.depths, or
// STORE.lfs.depths. Empty if no file may be made there, because the folder around the light field
// cannot be written or belongs to another user, or if the light field was made in memory.
std::filesystem::path DepthCacheBeside(const LightField& light_field);
// Returns the folder that a user chose by its name, by "none", or by "" for the one beside the
// light field. kUsage: the name is that of a file.
Result<std::filesystem::path> DepthCacheFolder(const std::string& chosen,
                                               const LightField& light_field);

// Identifies LF images by all that their light and their rays depend on: names, sizes and times of
// files, poses, intrinsics, gains, and how stored numbers become light.
class LfImageKeys {
 public:
  //   version  of the program's arithmetic
  LfImageKeys(const LightField& light_field, int version);

  // Returns the entry of a depth plane. `compared` are the LF images that it is found with.
  DepthCache::Entry PlaneOf(uint32_t id, std::span<const uint32_t> compared,
                            const InverseDepths& range, int planes, int divisor) const;
  // Returns the entry of something that depends on all LF images.
  //   name      of it, such as "range"
  //   settings  all else that it depends on, in words
  DepthCache::Entry OfAll(const std::string& name, const std::string& settings) const;

 private:
  std::vector<std::string> names_, keys_;  // [LF image]
};

}  // namespace lf
