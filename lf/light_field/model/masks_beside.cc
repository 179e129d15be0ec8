// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/masks_beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <system_error>
#include <unordered_map>
#include <utility>

#include "lf/light_field/model/folded_name.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

bool IsMaskFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// Returns the base name without its suffix.
std::string StemOf(const std::string& name) { return fs::path(name).stem().string(); }

// Returns the path of the mask of an LF image relative to a folder; empty if it has none there.
//   is_alone  true if no other LF image has this base name
fs::path MaskOf(const std::string& name, const fs::path& folder, bool is_alone) {
  const fs::path path(name);
  const auto part_count = std::distance(path.begin(), path.end());
  for (auto first = path.begin(); first != path.end(); ++first) {
    if (first->is_absolute() || *first == "..") continue;
    if (std::distance(first, path.end()) == 1 && part_count > 1 && !is_alone) break;
    fs::path end;
    for (auto part = first; part != path.end(); ++part) end /= *part;
    const fs::path stem = end.parent_path() / end.stem();
    for (const fs::path& mask :
         {fs::path(end.string() + ".png"), fs::path(stem.string() + ".png"), end})
      if (IsMaskFile(folder / mask)) return mask;
  }
  return {};
}

}  // namespace

std::vector<std::string> MasksIn(const fs::path& masks_folder, const LightField& light_field) {
  std::unordered_map<std::string, size_t> counts;
  for (const std::string& name : light_field.image_names) ++counts[StemOf(name)];
  std::vector<std::string> masks(light_field.size());
  bool has_any = false;
  for (size_t i = 0; i < light_field.size(); ++i) {
    const std::string& name = light_field.image_names[i];
    const fs::path mask =
        MaskOf(name, light_field.folder / masks_folder, counts[StemOf(name)] == 1);
    if (mask.empty()) continue;
    masks[i] = (masks_folder / mask).string();
    has_any = true;
  }
  return has_any ? masks : std::vector<std::string>();
}

std::vector<fs::path> FoldersOfMasks(const LightField& light_field) {
  std::error_code error;
  const fs::path beside = light_field.ImagePath({0}).parent_path();
  std::set<fs::path> found;
  for (const fs::path& around : {light_field.folder, beside, beside / ".."}) {
    const fs::path folder = fs::canonical(around.empty() ? fs::path(".") : around, error);
    if (error) continue;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
      std::error_code ignored;
      if (FoldedName(it->path().filename().string()).find("mask") == std::string::npos) continue;
      if (it->is_directory(ignored) && !MasksIn(it->path(), light_field).empty())
        found.insert(it->path());
    }
  }
  return {found.begin(), found.end()};
}

size_t CountDynamicMasks(const LightField& light_field) {
  size_t count = 0;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const fs::path image = light_field.ImagePath({i});
    if (IsMaskFile(image.parent_path() / fmt::format("dynamic_mask_{}.png", image.stem().string())))
      ++count;
  }
  return count;
}

}  // namespace lf
