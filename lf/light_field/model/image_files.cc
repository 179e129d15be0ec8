// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/image_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <system_error>

#include "lf/light_field/model/raw_encoding.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_view.h"

namespace lf {
namespace fs = std::filesystem;

fs::path ImageFileOf(const LightField& light_field, LfImageId id) {
  return FileOfImage(light_field.ImagePath(id));
}

std::vector<std::string> ImageFileNames(const LightField& light_field) {
  std::vector<std::string> names;
  for (const std::string& name : light_field.image_names) {
    std::string file = FileOfImage(name).string();
    if (names.empty() || names.back() != file) names.push_back(std::move(file));
  }
  return names;
}

size_t SharedPictureBytes(const LightField& light_field) {
  if (light_field.size() == 0) return 0;
  const auto view = PictureViewOf(light_field.ImagePath({0}));
  return view ? SharedPictureBytes(*view) : 0;
}

Result<std::array<int, 2>> ImageSizeInHeader(const fs::path& image) {
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info, ReadImageInfo(image));
  return std::array{info.width, info.height};
}

bool IsImageName(std::string_view file_name) {
  if (IsRawName(std::string(file_name))) return true;
  constexpr std::string_view kExtensions[] = {
      ".png",  ".jpg", ".jpeg", ".tif", ".tiff", ".exr", ".webp", ".jxl", ".heic", ".heif",
      ".avif", ".jp2", ".j2k",  ".bmp", ".ppm",  ".pgm", ".pbm",  ".pnm", ".pam",  ".hdr"};
  std::string extension = fs::path(file_name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) !=
         std::end(kExtensions);
}

Result<std::vector<std::string>> SortedImageNames(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string name = it->path().filename().string();
    if (!name.starts_with('.') && IsImageName(name) && !it->is_directory(error))
      names.push_back(std::move(name));
  }
  if (error)
    return InputError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace lf
