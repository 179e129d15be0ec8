// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/native_folder.h"

#include <fmt/format.h>

#include <system_error>

#include "lf/core/file.h"
#include "lf/light_field/transforms_json/json_text.h"
#include "lf/light_field/transforms_json/transforms_json.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kCalibrationName = "transforms.json";

Result<fs::path> Canonical(const fs::path& folder) {
  std::error_code error;
  fs::path canonical = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
  if (error) return InputError(fmt::format("{}: {}", folder.string(), error.message()));
  return canonical;
}

// Returns true if two absolute paths begin with the same folder below the root.
bool AreNear(const fs::path& a, const fs::path& b) {
  auto part_a = a.begin(), part_b = b.begin();
  if (part_a == a.end() || part_b == b.end() || ++part_a == a.end() || ++part_b == b.end())
    return false;
  return *part_a == *part_b;
}

// Returns the path of the folder `from` relative to the folder `to`; empty if both are the same.
fs::path PrefixOf(const fs::path& from, const fs::path& to) {
  return from == to ? fs::path() : from.lexically_relative(to);
}

// Returns the name that a transforms.json in the folder `to` has for a file.
//   prefix  PrefixOf(from, to)
//   name    absolute, or relative to `from`
std::string NameIn(const fs::path& to, const fs::path& prefix, const std::string& name) {
  if (name.empty()) return name;
  const fs::path path(name);
  if (path.is_absolute()) return AreNear(path, to) ? path.lexically_relative(to).string() : name;
  return prefix.empty() ? name : (prefix / path).string();
}

}  // namespace

Result<void> MoveToFolder(const fs::path& folder, LightField* light_field) {
  LF_ASSIGN_OR_RETURN(const fs::path from, Canonical(light_field->folder));
  LF_ASSIGN_OR_RETURN(const fs::path to, Canonical(folder));
  const fs::path prefix = PrefixOf(from, to);
  for (std::string& name : light_field->image_names) name = NameIn(to, prefix, name);
  for (std::string& name : light_field->mask_names) name = NameIn(to, prefix, name);
  light_field->folder = folder;
  return {};
}

Result<void> CheckNames(const fs::path& folder, const LightField& light_field) {
  LF_ASSIGN_OR_RETURN(const fs::path from, Canonical(light_field.folder));
  std::error_code error;
  const fs::path to = fs::weakly_canonical(folder, error);
  const fs::path prefix = PrefixOf(from, to);
  for (const auto* const names : {&light_field.image_names, &light_field.mask_names})
    for (const std::string& name : *names)
      if (JsonText text; !error && !text.AddString(NameIn(to, prefix, name)))
        return UsageError(fmt::format(
            "{}: is not UTF-8, so that a transforms.json cannot name it: rename the file or its "
            "folder",
            NameIn(to, prefix, name)));
  return {};
}

Result<void> CheckMayWrite(const fs::path& source, const fs::path& folder, bool force) {
  std::error_code error;
  const fs::path path = folder / kCalibrationName;
  if (force || !fs::exists(path, error)) return {};
  const fs::path read = fs::is_directory(source, error) ? source / kCalibrationName : source;
  if (fs::exists(read, error) && fs::equivalent(read, path, error))
    return UsageError(
        fmt::format("{}: this file is the calibration that is read, and the output would replace "
                    "it: write to another folder, or allow this with {{force}}",
                    path.string()));
  LF_ASSIGN_OR_RETURN(const bool is_ours, IsAsWritten(path, kImportProgram));
  if (is_ours) return {};
  return UsageError(
      fmt::format("{}: this file was not written by lfimport, or was changed since, and the output "
                  "would replace it: write to another folder, or allow this with {{force}}",
                  path.string()));
}

Result<std::string> WriteNativeFolder(const fs::path& folder, LightField* light_field) {
  if (HoldsPackedStore(*light_field))
    return UsageError(
        fmt::format("{}: a packed store cannot be converted, because it contains its LF images and "
                    "a transforms.json can only refer to image files: give the store itself to the "
                    "other programs (as LIGHTFIELD), or import the original image files with "
                    "lfimport and compress them again with lfcompressor",
                    light_field->folder.string()));
  LF_RETURN_IF_ERROR(CreateFolder(folder));
  LF_RETURN_IF_ERROR(MoveToFolder(folder, light_field));
  const fs::path path = folder / kCalibrationName;
  LF_RETURN_IF_ERROR(WriteTransformsJson(*light_field, path, kImportProgram));
  return path.string();
}

}  // namespace lf
