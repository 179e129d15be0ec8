// SPDX-License-Identifier: Apache-2.0
#include "lf/import/paths/other_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>

namespace lf {
namespace {

using namespace std::string_view_literals;

// Ways that lead from a file to a camera path; each completes "..., which is not read as a camera
// path: ".
constexpr const char* kByBlender =
    "import it into Blender, and export its camera with the add-on of lfrendertools, or as a .chan";
constexpr const char* kOpenInBlender =
    "open it in Blender, and export its camera with the add-on of lfrendertools, or as a .chan";
constexpr const char* kByItsProgram =
    "open it in its program, and export the camera as a .chan, or as FBX or Alembic for Blender, "
    "whose add-on of lfrendertools exports paths";
constexpr const char* kByNuke =
    "let Nuke export the camera: 'export chan file' in the properties of its node";
constexpr const char* kByColmap =
    "find the poses of its pictures, for example with COLMAP, and give the folder of the model";
constexpr const char* kNoCameras = "give a file that holds cameras, such as lfexample writes";
constexpr const char* kByHand =
    "write its camera as a .chan, one line for each frame with frame tx ty tz rx ry rz and the "
    "vertical field of view in degrees, or export FBX for Blender, whose add-on of lfrendertools "
    "exports paths";

// A format of files. A file has it if its content has `start` at the byte `at`, or if its content
// is of no camera path and its name ends in one of `extensions`, which are separated by blanks.
struct OtherFormat {
  std::string_view start;
  size_t at = 0;
  std::string_view extensions;
  const char* name;
  const char* way;
};

constexpr OtherFormat kOtherFormats[] = {
    {"SQLite format 3"sv, 0, "", "a packed store or a package, which",
     "give a camera path, such as lfexample writes, or the transforms.json whose LF cameras shall "
     "become frames"},
    {"#usda"sv, 0, ".usd .usda .usdc .usdz", "a USD scene, which is written but",
     "give the path that it was made from, or let the other program export a .chan"},
    {"PXR-USDC"sv, 0, "", "a USD scene, which is written but",
     "give the path that it was made from, or let the other program export a .chan"},
    {"Kaydara FBX"sv, 0, ".fbx", "an FBX scene, which", kByBlender},
    {"; FBX"sv, 0, "", "an FBX scene, which", kByBlender},
    {"Ogawa"sv, 0, ".abc", "an Alembic scene, which", kByBlender},
    {"glTF"sv, 0, ".gltf .glb", "a glTF scene, which", kByBlender},
    {"BLENDER"sv, 0, ".blend .blend1", "a scene of Blender, which", kOpenInBlender},
    {"//Maya"sv, 0, ".ma .mb", "a scene of Maya, which", kByItsProgram},
    {""sv, 0, ".max .c4d .hip .hiplc .lxo .aep", "a scene of another program, which",
     kByItsProgram},
    {""sv, 0, ".nk .nknc", "a script of Nuke, which", kByNuke},
    {""sv, 0, ".py", "a script of Python, which",
     "run it in the program that it is for, and export the camera there as a .chan"},
    {"ftyp"sv, 4, ".mp4 .mov .m4v", "a video, which", kByColmap},
    {"\x1A\x45\xDF\xA3"sv, 0, ".mkv .webm .avi", "a video, which", kByColmap},
    {"\x89PNG"sv, 0, ".png", "a picture, which", kByColmap},
    {"\xFF\xD8\xFF"sv, 0, ".jpg .jpeg", "a picture, which", kByColmap},
    {"\x76\x2F\x31\x01"sv, 0, ".exr", "a picture, which", kByColmap},
    {"ply\n"sv, 0, ".ply", "a PLY file of points or splats, which holds no cameras and",
     kNoCameras},
    {"ply\r"sv, 0, "", "a PLY file of points or splats, which holds no cameras and", kNoCameras},
    {"HIERARCHY"sv, 0, ".bvh", "a movement of a skeleton (BVH), which holds no cameras and",
     kNoCameras},
    {""sv, 0, ".csv .tsv", "a table, such as Unreal and trackers export, which", kByHand},
    {"\x89HDF"sv, 0, ".h5 .hdf5", "an HDF5 file, which", kByHand},
    {"\x93NUMPY"sv, 0, ".npy .npz", "an array of NumPy, which", kByHand},
};

Error OtherFileError(const OtherFormat& format, const std::filesystem::path& file) {
  return InputError(fmt::format("{}: is {} is not read as a camera path: {}", file.string(),
                                format.name, format.way));
}

bool HasExtension(std::string_view extensions, std::string_view wanted) {
  while (!extensions.empty()) {
    const size_t size = std::min(extensions.find(' '), extensions.size());
    if (extensions.substr(0, size) == wanted) return true;
    extensions.remove_prefix(std::min(size + 1, extensions.size()));
  }
  return false;
}

}  // namespace

Result<void> CheckContentIsNoOther(std::string_view text, const std::filesystem::path& file) {
  for (const OtherFormat& format : kOtherFormats)
    if (!format.start.empty() && text.size() >= format.at &&
        text.substr(format.at).starts_with(format.start))
      return OtherFileError(format, file);
  return {};
}

Result<void> CheckNameIsNoOther(std::string_view text, const std::filesystem::path& file) {
  if (text.find("lfpath") != std::string_view::npos) return {};
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension.empty()) return {};
  for (const OtherFormat& format : kOtherFormats)
    if (HasExtension(format.extensions, extension)) return OtherFileError(format, file);
  return {};
}

}  // namespace lf
