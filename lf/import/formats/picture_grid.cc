// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/picture_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>

#include "lf/core/parse_number.h"
#include "lf/light_field/model/image_files.h"
#include "lf/pixels/files/image_file.h"
#include "lf/pixels/files/picture_view.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr const char* kLayoutNames[] = {"mosaic", "quilt", "lenslets", "array"};
constexpr int kMostViewsAcross = 1000;

// Removes a number from the start of the text. Returns none unless it is from 1 to
// kMostViewsAcross.
std::optional<int> TakeCount(std::string_view* text) {
  int count = 0;
  const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), count);
  if (error != std::errc() || count < 1 || count > kMostViewsAcross) return std::nullopt;
  text->remove_prefix(static_cast<size_t>(end - text->data()));
  return count;
}

// Parses "COLUMNSxROWS[aASPECT]" at the end of a name.
std::optional<PictureGrid> ParseQuilt(std::string_view text) {
  PictureGrid grid = {.layout = PictureLayout::kQuilt};
  const std::optional<int> columns = TakeCount(&text);
  if (!columns || !text.starts_with('x')) return std::nullopt;
  text.remove_prefix(1);
  const std::optional<int> rows = TakeCount(&text);
  if (!rows) return std::nullopt;
  grid.grid = {*columns, *rows};
  if (text.empty()) return grid;
  if (!text.starts_with('a')) return std::nullopt;
  grid.aspect = ParseNumber(text.substr(1));
  if (!grid.aspect || !(*grid.aspect >= 0.01 && *grid.aspect <= 100)) return std::nullopt;
  return grid;
}

}  // namespace

const char* NameOf(PictureLayout layout) { return kLayoutNames[static_cast<int>(layout)]; }

std::optional<PictureLayout> PictureLayoutOf(std::string_view name) {
  const auto* const found = std::find(std::begin(kLayoutNames), std::end(kLayoutNames), name);
  if (found == std::end(kLayoutNames)) return std::nullopt;
  return static_cast<PictureLayout>(found - std::begin(kLayoutNames));
}

std::optional<PictureGrid> PictureGridOfName(std::string_view file_name) {
  if (!IsImageName(file_name)) return std::nullopt;
  std::string stem(file_name.substr(0, file_name.rfind('.')));
  for (char& c : stem) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::string_view kQuilt = "_qs", kLenslets = "_eslf";
  constexpr int kArchiveViews = 14;
  if (stem.ends_with(kLenslets))
    return PictureGrid{.layout = PictureLayout::kLenslets, .grid = {kArchiveViews, kArchiveViews}};
  const size_t quilt = stem.rfind(kQuilt);
  if (quilt == std::string::npos) return std::nullopt;
  return ParseQuilt(std::string_view(stem).substr(quilt + kQuilt.size()));
}

std::optional<fs::path> PictureOfViewsIn(const fs::path& folder, bool is_any) {
  const Result<std::vector<std::string>> names = SortedImageNames(folder);
  if (!names || names->size() != 1 || (!is_any && !PictureGridOfName((*names)[0])))
    return std::nullopt;
  return folder / (*names)[0];
}

Result<bool> CanBeDivided(const fs::path& picture, const PictureGrid& grid) {
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info, ReadImageInfo(picture));
  return info.width % grid.grid[0] == 0 && info.height % grid.grid[1] == 0;
}

Result<std::vector<ViewOfPicture>> ViewsOfPicture(const fs::path& picture,
                                                  const PictureGrid& grid) {
  const auto [columns, rows] = grid.grid;
  std::vector<ViewOfPicture> views;
  if (grid.layout == PictureLayout::kArray) {
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        PictureView view;
        view.file = picture.filename();
        view.is_of_array = true;
        view.x = column;
        view.y = row;
        views.push_back({PathOfView(view).string(), row, column});
      }
    return views;
  }
  LF_ASSIGN_OR_RETURN(const ImageFileInfo info, ReadImageInfo(picture));
  if (info.width % columns != 0 || info.height % rows != 0)
    return InputError(fmt::format(
        "{}: has {} x {} pixels, which cannot be divided into {} x {} views ({}): correct the "
        "columns and rows ({{lfimport grid}})",
        picture.string(), info.width, info.height, columns, rows, NameOf(grid.layout)));
  const int width = info.width / columns, height = info.height / rows;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      PictureView view;
      view.file = picture.filename();
      ViewOfPicture place;
      place.row = row;
      place.column = column;
      if (grid.layout == PictureLayout::kLenslets) {
        view.x = column;
        view.y = row;
        view.step_x = columns;
        view.step_y = rows;
      } else {
        view.x = column * width;
        view.y = row * height;
        view.width = width;
        view.height = height;
      }
      if (grid.layout == PictureLayout::kQuilt) {
        place.row = 0;
        place.column = (rows - 1 - row) * columns + column;
      }
      place.name = PathOfView(view).string();
      views.push_back(std::move(place));
    }
  return views;
}

double PixelAspect(const PictureGrid& grid, int width_px, int height_px) {
  // Names state few digits.
  constexpr double kRounding = 0.01;
  if (!grid.aspect) return 1;
  const double aspect = *grid.aspect * height_px / width_px;
  return std::abs(aspect - 1) <= kRounding ? 1 : aspect;
}

}  // namespace lf
