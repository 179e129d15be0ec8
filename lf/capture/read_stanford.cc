#include "lf/capture/read_stanford.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include "lf/capture/distinct_intrinsics.h"
#include "lf/core/log.h"
#include "lf/imageio/image_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kForm = "NAME_ROW_COL_Y_X_FOCALMM_SENSORMM.ext";
constexpr double kLargest_mm = 1e12;

bool IsImageName(std::string_view file_name) {
  constexpr std::string_view kExtensions[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".exr"};
  std::string extension = fs::path(file_name).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(std::begin(kExtensions), std::end(kExtensions), extension) !=
         std::end(kExtensions);
}

std::optional<int> ParseIndex(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text[0] == '-')
    return std::nullopt;
  return value;
}

std::optional<double> ParseDecimal(std::string_view text) {
  if (text.find_first_not_of("-.0123456789") != std::string_view::npos) return std::nullopt;
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= kLargest_mm))
    return std::nullopt;
  return value;
}

// ROW, COL, Y, X from four fields.
std::optional<StanfordName> ParsePosition(const std::string_view* fields) {
  const std::optional<int> row = ParseIndex(fields[0]);
  const std::optional<int> column = ParseIndex(fields[1]);
  const std::optional<double> y_mm = ParseDecimal(fields[2]);
  const std::optional<double> x_mm = ParseDecimal(fields[3]);
  if (!row || !column || !y_mm || !x_mm) return std::nullopt;
  return StanfordName{*row, *column, *y_mm, *x_mm, std::nullopt};
}

struct StanfordImage {
  std::string file_name;
  StanfordName name;
};

// Image files of this form, by row and column, and the names of all other files.
struct Listing {
  std::vector<StanfordImage> images;
  std::vector<std::string> others;
};

Result<Listing> ListFolder(const fs::path& folder) {
  Listing listing;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::string file_name = it->path().filename().string();
    if (file_name.starts_with('.') || it->is_directory(error)) continue;
    const std::optional<StanfordName> name = ParseStanfordName(file_name);
    if (name)
      listing.images.push_back({std::move(file_name), *name});
    else
      listing.others.push_back(std::move(file_name));
  }
  if (error)
    return InputError(fmt::format("{}: cannot be listed: {}", folder.string(), error.message()));
  std::sort(listing.others.begin(), listing.others.end());
  std::sort(listing.images.begin(), listing.images.end(),
            [](const StanfordImage& a, const StanfordImage& b) {
              return std::tie(a.name.row, a.name.column, a.file_name) <
                     std::tie(b.name.row, b.name.column, b.file_name);
            });
  return listing;
}

void WarnOfOthers(const fs::path& folder, const Listing& listing) {
  constexpr size_t kShown = 3;
  const auto& others = listing.others;
  if (others.empty()) return;
  LogWarning("{}: {} of {} files left out, being named otherwise than {}: {}{}", folder.string(),
             others.size(), others.size() + listing.images.size(), kForm,
             fmt::join(others.begin(), others.begin() + std::min(kShown, others.size()), ", "),
             others.size() > kShown ? ", ..." : "");
}

Result<void> CheckListing(const fs::path& folder, const Listing& listing, bool needs_lens) {
  const std::vector<StanfordImage>& images = listing.images;
  if (images.empty())
    return InputError(fmt::format("{}: holds no image named {}", folder.string(), kForm));
  for (size_t i = 0; i + 1 < images.size(); ++i)
    if (images[i].name.row == images[i + 1].name.row &&
        images[i].name.column == images[i + 1].name.column)
      return InputError(fmt::format(
          "{}: row {}, column {} is there twice, as {} and {}: keep one image per camera",
          folder.string(), images[i].name.row, images[i].name.column, images[i].file_name,
          images[i + 1].file_name));
  if (!needs_lens) return {};
  const auto lacks_lens = [](const StanfordImage& image) { return !image.name.lens; };
  const auto without = std::find_if(images.begin(), images.end(), lacks_lens);
  const auto with = std::find_if_not(images.begin(), images.end(), lacks_lens);
  if (without == images.end()) return {};
  if (with != images.end())
    return InputError(fmt::format(
        "{}: {} states focal length and sensor width, {} does not: rename them alike as {}",
        folder.string(), with->file_name, without->file_name, kForm));
  return InputError(fmt::format(
      "{}: the names lack the focal length: {} has no _FOCALMM_SENSORMM behind the position; add "
      "it, or give the focal length in pixels (--focal-px)",
      folder.string(), without->file_name));
}

}  // namespace

std::optional<StanfordName> ParseStanfordName(std::string_view file_name) {
  if (!IsImageName(file_name)) return std::nullopt;
  std::string_view stem = file_name.substr(0, file_name.rfind('.'));
  if (stem.ends_with('_')) stem.remove_suffix(1);
  // The last fields, each with a '_' before it: so there is a NAME, if an empty one.
  std::array<std::string_view, 6> fields;
  size_t count = 0;
  for (; count < fields.size(); ++count) {
    const size_t underscore = stem.rfind('_');
    if (underscore == std::string_view::npos) break;
    fields[fields.size() - 1 - count] = stem.substr(underscore + 1);
    stem.remove_suffix(stem.size() - underscore);
  }
  if (count == 6) {
    std::optional<StanfordName> name = ParsePosition(&fields[0]);
    const std::optional<double> focal_mm = ParseDecimal(fields[4]);
    const std::optional<double> sensor_width_mm = ParseDecimal(fields[5]);
    if (name && focal_mm.value_or(0) > 0 && sensor_width_mm.value_or(0) > 0) {
      name->lens = StanfordName::Lens{*focal_mm, *sensor_width_mm};
      return name;
    }
  }
  return count >= 4 ? ParsePosition(&fields[2]) : std::nullopt;
}

bool HoldsStanfordNames(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    if (ParseStanfordName(it->path().filename().string())) return true;
  return false;
}

Result<LightField> ReadStanfordFolder(const fs::path& folder, std::optional<double> focal_px) {
  LF_ASSIGN_OR_RETURN(const Listing listing, ListFolder(folder));
  LF_RETURN_IF_ERROR(CheckListing(folder, listing, !focal_px));
  WarnOfOthers(folder, listing);
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info,
                      ReadImageInfo(folder / listing.images[0].file_name));

  LightField light_field;
  light_field.folder = folder;
  DistinctIntrinsics distinct;
  for (const auto& [file_name, name] : listing.images) {
    Intrinsics k;
    k.fx_px = focal_px ? *focal_px : name.lens->focal_mm / name.lens->sensor_width_mm * info.width;
    if (!(k.fx_px >= 0.001 && k.fx_px <= 1e7))
      return InputError(fmt::format("{}: the focal length comes to {} px: expected 0.001 to 1e7",
                                    (folder / file_name).string(), k.fx_px));
    k.fy_px = k.fx_px;
    k.cx_px = info.width / 2.0;
    k.cy_px = info.height / 2.0;
    k.width_px = info.width;
    k.height_px = info.height;
    LfCamera camera;
    camera.intrinsics_index = distinct.IndexOf(k);
    camera.cam_from_world.translation = Vec3::Zero() - Vec3(name.x_mm, name.y_mm, 0) / 1000;
    light_field.cameras.push_back(camera);
    light_field.image_names.push_back(file_name);
  }
  light_field.intrinsics = distinct.Take();
  light_field.encoding.max_radiance = DefaultMaxRadiance(light_field.image_names);
  return light_field;
}

}  // namespace lf
