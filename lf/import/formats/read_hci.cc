// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_hci.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <string>
#include <system_error>

#include "lf/core/file.h"
#include "lf/core/parse_number.h"
#include "lf/light_field/model/distinct_intrinsics.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostCameras = 1 << 24;
constexpr double kMostSide_px = 65536;
constexpr uintmax_t kMostBytes = 1 << 20;

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  const size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

// Returns the keys of all sections together, with their values. The syntax is the one of Python's
// configparser: KEY = VALUE, [SECTION], and comments after # and ;.
std::map<std::string, std::string, std::less<>> KeysOf(std::string_view text) {
  std::map<std::string, std::string, std::less<>> keys;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = Trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    const size_t equals = line.find('=');
    if (line.empty() || line[0] == '#' || line[0] == ';' || equals == std::string_view::npos)
      continue;
    keys.insert_or_assign(std::string(Trimmed(line.substr(0, equals))),
                          std::string(Trimmed(line.substr(equals + 1))));
  }
  return keys;
}

// Reads numbers of a parameters.cfg by their keys. Errors name the file, the key and the value.
class Parameters {
 public:
  Parameters(std::string_view text, const fs::path& path) : keys_(KeysOf(text)), path_(path) {}

  Result<double> Number(const char* key, double low, double high) const {
    const auto found = keys_.find(key);
    if (found == keys_.end())
      return InputError(fmt::format(
          "{}: the key {} is missing: expected the parameters.cfg of the 4D Light Field Benchmark",
          path_.string(), key));
    const std::optional<double> number = ParseNumber(found->second);
    if (!number || !(*number >= low && *number <= high))
      return Wrong(found->second, key, "a number", low, high);
    return *number;
  }
  Result<int> Whole(const char* key, double high) const {
    LF_ASSIGN_OR_RETURN(const double number, Number(key, 1, high));
    if (number != std::floor(number))
      return Wrong(keys_.find(key)->second, key, "a whole number", 1, high);
    return static_cast<int>(number);
  }
  bool Has(const char* key) const { return keys_.find(key) != keys_.end(); }

 private:
  Error Wrong(const std::string& value, const char* key, const char* kind, double low,
              double high) const {
    constexpr size_t kLongest = 80;
    return InputError(fmt::format("{}: {} is \"{}\": expected {} from {:g} to {:g}", path_.string(),
                                  key, value.substr(0, kLongest), kind, low, high));
  }

  std::map<std::string, std::string, std::less<>> keys_;
  const fs::path& path_;
};

// Returns the depth range by Z = F b / (F b / Z0 + d): points with a larger disparity d are nearer.
// Returns nullopt if disp_min or disp_max is not stated, or corresponds to no finite depth.
//   focal_baseline  F b, for the focal length F and the distance b of neighbouring cameras
//   plane_per_w     1 / Z0, for the focus distance Z0
Result<std::optional<DepthRange>> DepthsOf(const Parameters& parameters, double focal_baseline,
                                           double plane_per_w) {
  constexpr double kMostDisparity_px = 1e6, kRounding_px = 0.05;
  if (!parameters.Has("disp_min") || !parameters.Has("disp_max"))
    return std::optional<DepthRange>();
  LF_ASSIGN_OR_RETURN(const double least,
                      parameters.Number("disp_min", -kMostDisparity_px, kMostDisparity_px));
  LF_ASSIGN_OR_RETURN(const double most,
                      parameters.Number("disp_max", -kMostDisparity_px, kMostDisparity_px));
  const double far_per_w = plane_per_w + (least - kRounding_px) / focal_baseline;
  const double near_per_w = plane_per_w + (most + kRounding_px) / focal_baseline;
  if (!(far_per_w > 1e-9 && near_per_w > far_per_w && near_per_w < 1e9))
    return std::optional<DepthRange>();
  return std::optional(DepthRange{1 / near_per_w, 1 / far_per_w});
}

}  // namespace

Result<LightField> ParseHci(std::string_view text, const fs::path& path) {
  const Parameters parameters(text, path);
  LF_ASSIGN_OR_RETURN(const double focal_mm, parameters.Number("focal_length_mm", 1e-3, 1e5));
  LF_ASSIGN_OR_RETURN(const double sensor_mm, parameters.Number("sensor_size_mm", 1e-3, 1e5));
  LF_ASSIGN_OR_RETURN(const int width_px, parameters.Whole("image_resolution_x_px", kMostSide_px));
  LF_ASSIGN_OR_RETURN(const int height_px, parameters.Whole("image_resolution_y_px", kMostSide_px));
  LF_ASSIGN_OR_RETURN(const int columns, parameters.Whole("num_cams_x", kMostCameras));
  LF_ASSIGN_OR_RETURN(const int rows, parameters.Whole("num_cams_y", kMostCameras / columns));
  LF_ASSIGN_OR_RETURN(const double baseline_mm, parameters.Number("baseline_mm", 1e-6, 1e9));
  LF_ASSIGN_OR_RETURN(const double plane_m, parameters.Number("focus_distance_m", 0, 1e9));
  const double focal_px = focal_mm / sensor_mm * std::max(width_px, height_px);
  const double pitch_m = baseline_mm / 1000;
  const double plane_per_m = plane_m > 0 ? 1 / plane_m : 0;
  const double farthest_px = focal_px * pitch_m * plane_per_m * std::max(columns, rows);
  if (!(focal_px >= 1e-3 && focal_px <= 1e7 && farthest_px <= 1e7))
    return InputError(fmt::format(
        "{}: the focal length comes to {:g} px, and principal points are up to {:g} px apart: "
        "expected a focal length from 0.001 to 1e7 px, and principal points at most 1e7 px apart: "
        "correct focal_length_mm, sensor_size_mm, baseline_mm or focus_distance_m",
        path.string(), focal_px, farthest_px));

  LightField light_field;
  light_field.folder = path.parent_path();
  LF_ASSIGN_OR_RETURN(light_field.depth_range,
                      DepthsOf(parameters, focal_px * pitch_m, plane_per_m));
  DistinctIntrinsics distinct;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double x = pitch_m * (column - 0.5 * (columns - 1));
      const double y = pitch_m * (row - 0.5 * (rows - 1));
      Intrinsics k;
      k.width_px = width_px;
      k.height_px = height_px;
      k.fx_px = k.fy_px = focal_px;
      k.cx_px = 0.5 * width_px + focal_px * x * plane_per_m;
      k.cy_px = 0.5 * height_px + focal_px * y * plane_per_m;
      LfCamera camera;
      camera.intrinsics_index = distinct.IndexOf(k);
      camera.cam_from_world.translation = {0 - x, 0 - y, 0};
      light_field.image_names.push_back(
          fmt::format("input_Cam{:03}.png", light_field.cameras.size()));
      light_field.cameras.push_back(camera);
    }
  light_field.intrinsics = distinct.Take();
  return light_field;
}

Result<LightField> ReadHci(const fs::path& path) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kMostBytes));
  return ParseHci(text, path);
}

bool IsHciFile(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error) || fs::file_size(path, error) > kMostBytes) return false;
  const Result<std::string> text = ReadFile(path, kMostBytes);
  return text && text->find("num_cams_x") != std::string::npos;
}

}  // namespace lf
