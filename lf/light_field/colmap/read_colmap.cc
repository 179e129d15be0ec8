// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/colmap/read_colmap.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/core/files_nearby.h"
#include "lf/core/log.h"
#include "lf/core/parse_number.h"
#include "lf/light_field/colmap/colmap_binary.h"
#include "lf/light_field/colmap/colmap_scene.h"
#include "lf/light_field/colmap/colmap_text.h"
#include "lf/light_field/model/find_images.h"
#include "lf/light_field/model/masks_beside.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Extensions of the files of a model, in order of preference.
constexpr const char* kExtensions[] = {".bin", ".txt"};
// Number of parent folders in which images are searched: enough to reach `root` from the model
// folder root/colmap/sparse/0.
constexpr int kFoldersAbove = 3;

bool IsFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

bool IsFolder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

// Returns the extension of the model's files in a folder; nullopt if there is no model. kInput if
// only one of the two files cameras and images exists.
Result<std::optional<std::string>> ModelExtension(const fs::path& folder) {
  std::optional<Error> incomplete;
  for (const char* extension : kExtensions) {
    const fs::path cameras = folder / (std::string("cameras") + extension);
    const fs::path images = folder / (std::string("images") + extension);
    const bool has_cameras = IsFile(cameras), has_images = IsFile(images);
    if (has_cameras && has_images) return std::optional<std::string>(extension);
    if (has_cameras != has_images && !incomplete)
      incomplete = InputError(fmt::format(
          "{}: exists, but the {} of the same COLMAP model is missing: put it into the same folder",
          (has_cameras ? cameras : images).string(),
          (has_cameras ? images : cameras).filename().string()));
  }
  if (incomplete) return *incomplete;
  return std::optional<std::string>();
}

bool HoldsBinaryFiles(const fs::path& folder) {
  return IsFile(folder / "cameras.bin") || IsFile(folder / "images.bin");
}

Result<uint64_t> CountImages(const fs::path& folder, const std::string& extension) {
  LF_ASSIGN_OR_RETURN(ByteStream stream, ByteStream::Open(folder / ("images" + extension)));
  return extension == ".bin" ? CountColmapImagesBinary(&stream) : CountColmapImagesText(&stream);
}

// Returns the folders whose names are numbers, in ascending order.
std::vector<fs::path> NumberedFolders(const fs::path& folder) {
  std::vector<std::pair<uint32_t, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (const auto number = ParseWhole<uint32_t>(name)) found.emplace_back(*number, it->path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> folders;
  for (auto& [number, path] : found) folders.push_back(std::move(path));
  return folders;
}

// Looks for complete models, and remembers the first incomplete one, which is an error only if no
// complete one is found.
class ModelSearch {
 public:
  // Returns the extension of the model's files in a folder; nullopt if it holds no complete model.
  std::optional<std::string> Extension(const fs::path& folder) {
    const Result<std::optional<std::string>> extension = ModelExtension(folder);
    if (extension) return *extension;
    if (!incomplete_) incomplete_ = extension.error();
    return std::nullopt;
  }
  const std::optional<Error>& incomplete() const { return incomplete_; }

 private:
  std::optional<Error> incomplete_;
};

// Among the models in the subfolders 0, 1, ... and in folders `sparse` and `text` in these, returns
// the one with most images; nullopt if there is none.
Result<std::optional<fs::path>> LargestModel(const fs::path& folder, bool warns,
                                             ModelSearch* search) {
  std::optional<fs::path> largest;
  uint64_t largest_count = 0, all_count = 0;
  size_t model_count = 0;
  for (const fs::path& numbered : NumberedFolders(folder))
    for (const fs::path& candidate : {numbered, numbered / "sparse", numbered / "text"}) {
      const std::optional<std::string> extension = search->Extension(candidate);
      if (!extension) continue;
      LF_ASSIGN_OR_RETURN(const uint64_t count, CountImages(candidate, *extension));
      ++model_count;
      all_count += count;
      if (!largest || count > largest_count) {
        largest = candidate;
        largest_count = count;
      }
      break;  // the others are forms of the same model
    }
  if (warns && model_count > 1)
    LogWarning(
        "{}: holds {} COLMAP models: using {}, with {} of {} images; to use another model, give "
        "its folder",
        folder.string(), model_count, largest->lexically_relative(folder).string(), largest_count,
        all_count);
  return largest;
}

// Returns the parent folder. Works also for relative paths and for the root.
fs::path Above(const fs::path& folder) {
  const fs::path clean = folder.lexically_normal();
  const fs::path named = clean.has_filename() ? clean : clean.parent_path();
  const fs::path name = named.filename();
  std::error_code error;
  if (name.empty() || name == "." || name == ".." || !named.has_parent_path())
    return fs::absolute(named, error).lexically_normal().parent_path();
  return named.parent_path();
}

// Returns the folders that may hold the images, in the order of the search.
std::vector<fs::path> ImageFolders(const fs::path& model_folder) {
  std::vector<fs::path> folders;
  fs::path above = model_folder;
  for (int i = 0; i <= kFoldersAbove; ++i, above = Above(above))
    folders.push_back(above / "images");
  above = model_folder;
  for (int i = 0; i <= kFoldersAbove; ++i, above = Above(above)) folders.push_back(above);
  return folders;
}

// Returns the part of a message that names files near a missing image: files in the first of the
// ImageFolders() that has a file with a similar name, otherwise in the first existing folder that
// is named `images`.
std::string NearbyIn(const fs::path& model_folder, const std::string& name) {
  std::string nearby;
  for (const fs::path& folder : ImageFolders(model_folder)) {
    const fs::path missing = folder / name;
    if (!IsFolder(folder)) continue;
    const std::string here = FilesNearby(missing);
    if (here.starts_with("; similar there: "))
      return fmt::format("; similar in {}: {}", missing.parent_path().string(),
                         here.substr(here.find(": ") + 2));
    if (nearby.empty() && folder.filename() == "images")
      nearby = fmt::format("; {}: {}", missing.parent_path().string(), here.substr(2));
  }
  return nearby;
}

// Returns the first of the ImageFolders() that contains one of the first kMostAsked images. It is
// not enough to look for one image, because some images may be missing.
Result<fs::path> FindImages(const fs::path& model_folder, std::span<const std::string> names) {
  constexpr size_t kMostAsked = 64;
  const auto asked = names.first(std::min(names.size(), kMostAsked));
  std::string tried;
  for (const fs::path& folder : ImageFolders(model_folder)) {
    if (std::any_of(asked.begin(), asked.end(),
                    [&](const std::string& name) { return IsFile(folder / name); }))
      return folder;
    tried += fmt::format("{}{}", tried.empty() ? "" : ", ", folder.string());
  }
  return InputError(fmt::format(
      "{}: its image {} is not found: looked for it in {}{}; put the images there, or give their "
      "folder ({{images}})",
      model_folder.string(), names.front(), tried, NearbyIn(model_folder, names.front())));
}

// Returns the folder of the project: `model_folder` after numbered folders, `sparse`, `text`,
// `dense` and `colmap` are removed from the end of its path, at most five of them.
fs::path ProjectFolder(const fs::path& model_folder) {
  const auto name_of = [](const fs::path& folder) {
    const fs::path clean = folder.lexically_normal();
    return (clean.has_filename() ? clean : clean.parent_path()).filename().string();
  };
  constexpr int kMostRemoved = 5;
  fs::path folder = model_folder;
  for (int i = 0; i < kMostRemoved; ++i) {
    const std::string name = name_of(folder);
    const bool is_number =
        !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
    if (!is_number && name != "sparse" && name != "text" && name != "dense" && name != "colmap")
      break;
    folder = Above(folder);
  }
  return folder;
}

// Returns the folder `masks` beside the folder of images: relative to the latter if possible,
// otherwise as an absolute path. nullopt if it does not exist.
std::optional<fs::path> FindMasks(const fs::path& images_folder) {
  const fs::path masks = Above(images_folder) / "masks";
  if (!IsFolder(masks)) return std::nullopt;
  std::error_code error;
  const fs::path relative = fs::path("..") / "masks";
  // If the folder of images is a symbolic link, `..` leads to another folder.
  if (fs::equivalent(images_folder / relative, masks, error)) return relative;
  return fs::absolute(masks, error);
}

}  // namespace

Result<std::optional<fs::path>> FindColmapModel(const fs::path& path, bool warns) {
  ModelSearch search;
  for (const fs::path& folder : {path, path / "sparse", path / "colmap" / "sparse", path / "dense",
                                 path / "dense" / "sparse"})
    for (const fs::path& candidate : {folder, folder / "text"}) {
      // A cameras.txt or images.txt alone may belong to another program, unless it is in sparse.
      ModelSearch ignored;
      const bool may_be_another = folder == path && !HoldsBinaryFiles(candidate);
      if ((may_be_another ? ignored : search).Extension(candidate))
        return std::optional<fs::path>(candidate);
      // The numbered subfolders are not listed without need: `path` may be a folder of a million
      // images.
      if (candidate != folder || (folder == path && !IsFolder(path / "0"))) continue;
      LF_ASSIGN_OR_RETURN(std::optional<fs::path> largest, LargestModel(folder, warns, &search));
      if (largest) return largest;
    }
  if (search.incomplete()) return *search.incomplete();
  return std::optional<fs::path>();
}

Result<ColmapScene> ReadColmapScene(ColmapStreams* streams) {
  ColmapScene scene;
  const bool is_binary = streams->is_binary;
  LF_RETURN_IF_ERROR(is_binary ? ReadColmapCamerasBinary(&streams->cameras, &scene)
                               : ReadColmapCamerasText(&streams->cameras, &scene));
  LF_RETURN_IF_ERROR(is_binary ? ReadColmapImagesBinary(&streams->images, &scene)
                               : ReadColmapImagesText(&streams->images, &scene));
  return scene;
}

Result<LightField> ParseColmapModel(ColmapStreams streams) {
  LF_ASSIGN_OR_RETURN(ColmapScene scene, ReadColmapScene(&streams));
  if (streams.points)
    LF_RETURN_IF_ERROR(streams.is_binary ? ReadColmapPointsBinary(&*streams.points, &scene)
                                         : ReadColmapPointsText(&*streams.points, &scene));
  return scene.Take();
}

Result<ColmapStreams> OpenColmapStreams(const fs::path& model_folder) {
  LF_ASSIGN_OR_RETURN(const std::optional<std::string> extension, ModelExtension(model_folder));
  if (!extension)
    return InputError(fmt::format(
        "{}: holds no COLMAP model: expected cameras.bin and images.bin, or cameras.txt and "
        "images.txt",
        model_folder.string()));
  LF_ASSIGN_OR_RETURN(ByteStream cameras,
                      ByteStream::Open(model_folder / ("cameras" + *extension)));
  LF_ASSIGN_OR_RETURN(ByteStream images, ByteStream::Open(model_folder / ("images" + *extension)));
  ColmapStreams streams{std::move(cameras), std::move(images), std::nullopt, *extension == ".bin"};
  const fs::path points = model_folder / ("points3D" + *extension);
  std::error_code error;
  if (fs::exists(points, error)) {
    LF_ASSIGN_OR_RETURN(ByteStream stream, ByteStream::Open(points));
    streams.points.emplace(std::move(stream));
  }
  return streams;
}

Result<LightField> ReadColmapModel(const fs::path& model_folder,
                                   const std::optional<fs::path>& images_folder) {
  LF_ASSIGN_OR_RETURN(ColmapStreams streams, OpenColmapStreams(model_folder));
  LF_ASSIGN_OR_RETURN(LightField light_field, ParseColmapModel(std::move(streams)));
  if (images_folder) {
    light_field.folder = *images_folder;
  } else if (const auto folder = FindImages(model_folder, light_field.image_names)) {
    light_field.folder = *folder;
  } else {
    light_field.folder = ProjectFolder(model_folder);
    LF_ASSIGN_OR_RETURN(const size_t found_count, FindImageFiles({}, &light_field));
    if (found_count == 0) return folder.error();
  }
  if (const std::optional<fs::path> masks = FindMasks(light_field.folder))
    light_field.mask_names = MasksIn(*masks, light_field);
  return light_field;
}

}  // namespace lf
