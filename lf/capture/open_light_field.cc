#include "lf/capture/open_light_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include "lf/capture/transforms_json.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCalibrationName = "transforms.json";

// Calibrations under other names, such as Blender's transforms_train.json.
std::string OtherCalibrations(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with("transforms") && name.ends_with(".json")) names.push_back(name);
  }
  if (names.empty()) return "";
  std::sort(names.begin(), names.end());
  return fmt::format("; it holds {}: name the file itself to read it", fmt::join(names, ", "));
}

}  // namespace

Result<LightField> OpenLightField(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    return InputError(fmt::format("{}: no such file or folder", path.string()));
  if (!fs::is_directory(status)) {
    if (path.extension() == ".json") return ReadTransformsJson(path);
    return InputError(
        fmt::format("{}: is not a light field: expected a transforms.json or a folder that holds "
                    "one",
                    path.string()));
  }
  if (fs::exists(path / kCalibrationName, error))
    return ReadTransformsJson(path / kCalibrationName);
  return InputError(fmt::format("{}: holds no light field: looked for {}{}", path.string(),
                                kCalibrationName, OtherCalibrations(path)));
}

}  // namespace lf
