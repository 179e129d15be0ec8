// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_splits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "lf/core/log.h"
#include "lf/light_field/model/distinct_intrinsics.h"
#include "lf/light_field/transforms_json/transforms_json.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// The numbers of a pose: those of the rotation, then those of the translation, and the recording
// time, because a camera that films has one pose at many times.
using PoseNumbers = std::array<double, 13>;

PoseNumbers NumbersOf(const RigidTransform& pose, double time) {
  PoseNumbers numbers;
  const auto end = std::copy(pose.rotation.data(), pose.rotation.data() + 9, numbers.begin());
  std::copy(pose.translation.data(), pose.translation.data() + 3, end);
  numbers.back() = time;
  return numbers;
}

// Joins light fields to one.
class Union {
 public:
  // Adds the LF images of a file, but for those whose pose an earlier file has. `path` is for
  // messages.
  Result<void> Add(LightField part, const fs::path& path) {
    if (whole_.size() == 0) {
      whole_.folder = part.folder;
      whole_.encoding = part.encoding;
      whole_.unit_m = part.unit_m;
      first_ = path;
    } else if (!(whole_.encoding == part.encoding && whole_.unit_m == part.unit_m)) {
      return InputError(
          fmt::format("{}: states another encoding of the pixels or another unit (keys lf_*) than "
                      "{}, with which it forms one light field: give the path of one of them",
                      path.string(), first_.string()));
    }
    if (part.depth_range) {
      DepthRange& range =
          whole_.depth_range ? *whole_.depth_range : whole_.depth_range.emplace(*part.depth_range);
      range = {std::min(range.near_w, part.depth_range->near_w),
               std::max(range.far_w, part.depth_range->far_w)};
    }
    std::vector<PoseNumbers> added;
    for (size_t i = 0; i < part.size(); ++i) {
      LfCamera& camera = part.cameras[i];
      const PoseNumbers pose =
          NumbersOf(camera.cam_from_world, part.times.empty() ? 0 : part.times[i]);
      if (poses_.contains(pose)) {
        ++repeated_count_;
        continue;
      }
      added.push_back(pose);
      camera.intrinsics_index = distinct_.IndexOf(part.intrinsics[camera.intrinsics_index]);
      whole_.cameras.push_back(camera);
      whole_.image_names.push_back(NameIn(part.folder, part.image_names[i]));
      if (!part.times.empty()) whole_.times.push_back(part.times[i]);
      if (part.mask_names.empty() || part.mask_names[i].empty()) continue;
      whole_.mask_names.resize(whole_.size());
      whole_.mask_names.back() = NameIn(part.folder, part.mask_names[i]);
    }
    poses_.insert(added.begin(), added.end());
    return {};
  }

  size_t repeated_count() const { return repeated_count_; }

  LightField Take() {
    whole_.intrinsics = distinct_.Take();
    if (!whole_.mask_names.empty()) whole_.mask_names.resize(whole_.size());
    if (whole_.times.size() != whole_.size()) whole_.times.clear();  // a part states none
    return std::move(whole_);
  }

 private:
  // Returns a name relative to whole_.folder, or an absolute one.
  std::string NameIn(const fs::path& folder, const std::string& name) const {
    return folder == whole_.folder ? name : fs::absolute(folder / name).string();
  }

  LightField whole_;
  fs::path first_;
  DistinctIntrinsics distinct_;
  std::set<PoseNumbers> poses_;
  size_t repeated_count_ = 0;
};

}  // namespace

std::string OtherCalibrations(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with("transforms") && name.ends_with(".json")) names.push_back(name);
  }
  if (names.empty()) return "";
  std::sort(names.begin(), names.end());
  return fmt::format("; it holds {}: give the path of such a file to read it",
                     fmt::join(names, ", "));
}

std::vector<fs::path> SplitsIn(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const char* const part : {"train", "val", "test"}) {
    fs::path file = folder / fmt::format("transforms_{}.json", part);
    std::error_code error;
    if (fs::is_regular_file(file, error)) files.push_back(std::move(file));
  }
  return files;
}

Result<LightField> ReadSplits(const std::vector<fs::path>& files,
                              const std::optional<fs::path>& images_folder) {
  Union parts;
  std::vector<std::string> names;
  for (const fs::path& file : files) {
    LF_ASSIGN_OR_RETURN(LightField part, ReadTransformsJson(file, images_folder));
    LF_RETURN_IF_ERROR(parts.Add(std::move(part), file));
    names.push_back(file.filename().string());
  }
  LightField whole = parts.Take();
  LogInfo(
      "{}: {} are read as one light field of {} LF images{}; give the path of one to read it "
      "alone",
      whole.folder.string(), fmt::join(names, ", "), whole.size(),
      parts.repeated_count() == 0
          ? ""
          : fmt::format(", without {} whose pose another file has", parts.repeated_count()));
  return whole;
}

}  // namespace lf
