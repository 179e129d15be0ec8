// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/read_aos.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/rotation.h"
#include "lf/light_field/transforms_json/json_syntax.h"
#include "lf/light_field/transforms_json/opengl_pose.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

using nlohmann::json;

constexpr size_t kMaxFileSize = size_t{64} << 20;  // bytes; enough for some hundred thousand images
constexpr int kMaxDepth = 8;  // deepest nesting that is kept; deeper JSON values take no memory
constexpr double kAosRotationTolerance = 1e-3;
constexpr const char* kMatrixKey = "M3x4";

std::optional<double> NumberOf(const json& value) {
  if (value.is_string()) return ParseNumber(value.get_ref<const std::string&>());
  if (!value.is_number() || !std::isfinite(value.get<double>())) return std::nullopt;
  return value.get<double>();
}

std::optional<Mat34> MatrixOf(const json& entry) {
  const auto rows = entry.find(kMatrixKey);
  if (rows == entry.end() || !rows->is_array() || rows->size() != 3) return std::nullopt;
  Mat34 matrix;
  for (int y = 0; y < 3; ++y) {
    const json& row = (*rows)[y];
    if (!row.is_array() || row.size() != 4) return std::nullopt;
    for (int x = 0; x < 4; ++x) {
      const std::optional<double> number = NumberOf(row[x]);
      if (!number) return std::nullopt;
      matrix(y, x) = *number;
    }
  }
  return matrix;
}

// Returns the image name of an entry. The message of kInput does not name the entry; the caller
// adds it.
Result<std::string> NameOf(const json& entry) {
  const auto name = entry.find("imagefile");
  if (name == entry.end() || !name->is_string() || name->get_ref<const std::string&>().empty())
    return InputError(
        "\"imagefile\" is missing, empty or not a text: expected the name of an image file");
  if (name->get_ref<const std::string&>().find('\0') != std::string::npos)
    return InputError("\"imagefile\" holds a NUL character: expected the name of an image file");
  return name->get<std::string>();
}

Result<RigidTransform> PoseOf(const json& entry) {
  const std::optional<Mat34> matrix = MatrixOf(entry);
  if (!matrix)
    return InputError(fmt::format(
        "\"{}\" is missing or not a 3x4 matrix: expected 3 lists of 4 numbers", kMatrixKey));
  if (!(matrix->col(3).cwiseAbs().maxCoeff() <= kLargest_w))
    return InputError(fmt::format(
        "\"{}\" holds the position ({:g}, {:g}, {:g}): expected coordinates within +-{:g}",
        kMatrixKey, (*matrix)(0, 3), (*matrix)(1, 3), (*matrix)(2, 3), kLargest_w));
  const Result<Mat3> rotation = NearestRotation(matrix->leftCols<3>(), kAosRotationTolerance);
  if (!rotation) return InputError(fmt::format("\"{}\" {}", kMatrixKey, rotation.error().message));
  return RigidTransform{*rotation, matrix->col(3)};
}

Result<LightField> PosesOf(const json& top, const fs::path& path) {
  const auto images = top.is_object() ? top.find("images") : top.end();
  if (!top.is_object() || images == top.end() || !images->is_array() || images->empty())
    return InputError(
        fmt::format("{}: is not a poses.json of AOS: expected an object {{...}} with a list "
                    "\"images\" that is not empty",
                    path.string()));
  LightField light_field;
  light_field.folder = path.parent_path();
  for (const json& entry : *images) {
    const std::string place = fmt::format("{}: images[{}]", path.string(), light_field.size());
    if (!entry.is_object())
      return InputError(fmt::format(
          "{}: is not an object: expected {{\"imagefile\": ..., \"{}\": ...}}", place, kMatrixKey));
    Result<std::string> name = NameOf(entry);
    if (!name) return InputError(fmt::format("{}: {}", place, name.error().message));
    const Result<RigidTransform> pose = PoseOf(entry);
    if (!pose) return InputError(fmt::format("{} ({}): {}", place, *name, pose.error().message));
    light_field.cameras.push_back({*pose, 0, 1});
    light_field.image_names.push_back(*std::move(name));
  }
  light_field.encoding.max_radiance = DefaultMaxRadiance(light_field.image_names);
  return light_field;
}

// Returns the name with the extension .png instead of .tif or .tiff, because AOS converts its
// thermal images to .png without changing their names in the JSON file.
std::string AsPng(const std::string& name) {
  const fs::path path(name);
  const bool is_tiff = path.extension() == ".tif" || path.extension() == ".tiff";
  return is_tiff ? fs::path(path).replace_extension(".png").string() : name;
}

// Finds the folder of the images, and changes their names to .png if the files have this extension.
Result<void> FindImages(const AosOptions& options, const fs::path& path, LightField* light_field) {
  const fs::path& beside = light_field->folder;
  std::vector<fs::path> folders;
  if (options.images_folder)
    folders = {*options.images_folder};
  else
    folders = {beside, beside / "images", beside / ".." / "images", beside / ".." / "images_ldr"};
  const std::string& first = light_field->image_names[0];
  std::error_code error;
  for (const fs::path& folder : folders) {
    const bool is_png = !fs::exists(folder / first, error);
    if (is_png && !fs::exists(folder / AsPng(first), error)) continue;
    light_field->folder = folder;
    if (is_png)
      for (std::string& name : light_field->image_names) name = AsPng(name);
    return {};
  }
  LF_ASSIGN_OR_RETURN(const size_t found_count, FindImageFiles(options.images_folder, light_field));
  if (found_count > 0) return {};
  std::vector<std::string> tried;
  for (const fs::path& folder : folders) tried.push_back(folder.string());
  return InputError(
      fmt::format("{}: the first image, {}, is in none of the folders {}: give the folder of the "
                  "images ({{images}})",
                  path.string(), first, fmt::join(tried, ", ")));
}

Result<Intrinsics> IntrinsicsOf(double fov_deg, const fs::path& path,
                                const LightField& light_field) {
  using Size = std::array<int, 2>;
  const fs::path image = light_field.ImagePath({0});
  LF_ASSIGN_OR_RETURN(const Size size, ImageSizeInHeader(image));
  if (size[0] != size[1])
    LogWarning(
        "{}: {} has {} x {} pixels, but AOS treats images as squares: the field of view of {} "
        "degrees is used for the width and for the height",
        path.string(), image.string(), size[0], size[1], fov_deg);
  const double focal_per_size = 0.5 / std::tan(0.5 * RadiansFromDegrees(fov_deg));
  return Intrinsics{size[0] * focal_per_size,
                    size[1] * focal_per_size,
                    size[0] / 2.0,
                    size[1] / 2.0,
                    0,
                    size[0],
                    size[1]};
}

}  // namespace

bool IsAosFile(const fs::path& path) {
  constexpr size_t kLookedAt = size_t{1} << 20;
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return false;
  std::ifstream file(path, std::ios::binary);
  std::string text(kLookedAt, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(file.gcount()));
  return text.find(fmt::format("\"{}\"", kMatrixKey)) != std::string::npos;
}

Result<LightField> ParseAosPoses(std::string_view text, const fs::path& path) {
  try {
    return PosesOf(
        json::parse(text.begin(), text.end(),
                    [](int depth, json::parse_event_t, json&) { return depth <= kMaxDepth; }),
        path);
  } catch (const json::exception& exception) {
    return IsNotJson(path, exception.what());
  }
}

Result<LightField> ReadAos(const fs::path& path, const AosOptions& options) {
  if (!options.fov_deg)
    return InputError(fmt::format(
        "{}: holds poses of Airborne Optical Sectioning, which do not state the field of view: "
        "give it in degrees ({{fov_deg}}; AOS's own programs take 43.10803984 or 50.81543622)",
        path.string()));
  if (!(*options.fov_deg >= 0.01 && *options.fov_deg <= 179))
    return UsageError(
        fmt::format("{{fov_deg {}}}: expected degrees from 0.01 to 179", *options.fov_deg));
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kMaxFileSize));
  LF_ASSIGN_OR_RETURN(LightField light_field, ParseAosPoses(text, path));
  LF_RETURN_IF_ERROR(FindImages(options, path, &light_field));
  LF_ASSIGN_OR_RETURN(const Intrinsics intrinsics,
                      IntrinsicsOf(*options.fov_deg, path, light_field));
  light_field.intrinsics = {intrinsics};
  return light_field;
}

}  // namespace lf
