// SPDX-License-Identifier: Apache-2.0
#include "lf/film/compare/picture_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string_view>
#include <system_error>

namespace lf {
namespace fs = std::filesystem;
namespace {

using PicturesByName = std::map<std::string, fs::path>;

bool IsPicture(const fs::path& file) {
  constexpr std::array<std::string_view, 6> kExtensions = {".png", ".jpg",  ".jpeg",
                                                           ".tif", ".tiff", ".exr"};
  std::string extension = file.extension().string();
  for (char& letter : extension)
    letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end() &&
         file.stem() != "contact_sheet";
}

Result<PicturesByName> PicturesOf(const fs::path& folder) {
  PicturesByName pictures;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    if (!IsPicture(i->path())) continue;
    const auto [other, is_new] = pictures.emplace(i->path().stem().string(), i->path());
    if (!is_new)
      return InputError(fmt::format(
          "{}: has {} and {}: expected one picture of each name; name the two files "
          "that are to be compared",
          folder.string(), other->second.filename().string(), i->path().filename().string()));
  }
  if (error)
    return InputError(fmt::format("{}: cannot be read: {}", folder.string(), error.message()));
  return pictures;
}

// Returns an error if `pictures` has a name that `others` lack.
Result<void> CheckAllIn(const PicturesByName& pictures, const PicturesByName& others,
                        const fs::path& folder_of_others) {
  for (const auto& [name, file] : pictures)
    if (!others.contains(name))
      return InputError(fmt::format(
          "{}: has no picture {} to compare with {}: add it, or compare what both folders have "
          "with {{common}}",
          folder_of_others.string(), name, file.string()));
  return {};
}

}  // namespace

Result<std::vector<PicturePair>> FindPicturePairs(const fs::path& reference, const fs::path& test,
                                                  bool common) {
  std::error_code error;
  for (const fs::path& path : {reference, test})
    if (!fs::exists(path, error))
      return InputError(
          fmt::format("{}: {}: expected a picture or a folder of pictures", path.string(),
                      error ? "cannot be read: " + error.message() : "does not exist"));
  const bool is_folder = fs::is_directory(reference, error);
  const bool are_equal = !error && is_folder == fs::is_directory(test, error);
  if (error)
    return InputError(fmt::format("{} and {}: cannot be read: {}", reference.string(),
                                  test.string(), error.message()));
  if (!are_equal)
    return InputError(fmt::format("{} is a folder, but {} is a file: expected two of a kind",
                                  (is_folder ? reference : test).string(),
                                  (is_folder ? test : reference).string()));
  if (!is_folder) return std::vector<PicturePair>{{test.stem().string(), reference, test}};
  LF_ASSIGN_OR_RETURN(const PicturesByName of_reference, PicturesOf(reference));
  LF_ASSIGN_OR_RETURN(const PicturesByName of_test, PicturesOf(test));
  std::vector<PicturePair> pairs;
  for (const auto& [name, file] : of_reference)
    if (const auto found = of_test.find(name); found != of_test.end())
      pairs.push_back({name, file, found->second});
  if (pairs.empty())
    return InputError(fmt::format(
        "{} and {}: have no pictures with equal names, among {} and {} pictures: rename them, or "
        "name two files",
        reference.string(), test.string(), of_reference.size(), of_test.size()));
  if (!common) {
    LF_RETURN_IF_ERROR(CheckAllIn(of_reference, of_test, test));
    LF_RETURN_IF_ERROR(CheckAllIn(of_test, of_reference, reference));
  }
  return pairs;
}

}  // namespace lf
