// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/view_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "lf/core/value_named.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

// Returns the width of a view divided by its height, with the two decimals that display makers
// recommend.
std::string AspectText(int width, int height) {
  const double aspect = static_cast<double>(width) / height;
  return aspect < 0.1 ? fmt::format("{:.2g}", aspect) : fmt::format("{:.2f}", aspect);
}

// Returns the description of a quilt at the end of a name, such as "_qs8x6a0.75"; "" if there is
// none.
std::string DescriptionIn(const std::string& name) {
  const size_t begin = name.rfind("_qs");
  if (begin == std::string::npos) return "";
  const std::string description = name.substr(begin);
  const auto is_part = [](char c) {
    return (c >= '0' && c <= '9') || c == 'x' || c == 'a' || c == '.';
  };
  const bool is_description = description.size() > 3 && description[3] >= '0' &&
                              description[3] <= '9' &&
                              std::all_of(description.begin() + 3, description.end(), is_part);
  return is_description ? description : "";
}

}  // namespace

std::optional<ViewLayout> ParseViewLayout(std::string_view name) {
  return ValueNamed(name, {ViewLayout::kQuilt, ViewLayout::kSideBySide, ViewLayout::kOverUnder,
                           ViewLayout::kAnaglyph, ViewLayout::kLeftRight});
}

const char* NameOf(ViewLayout layout) {
  constexpr const char* kNames[] = {"quilt", "side-by-side", "over-under", "anaglyph",
                                    "left-right"};
  return kNames[static_cast<int>(layout)];
}

int ViewCountOf(ViewLayout layout, const TileCounts& grid) {
  return layout == ViewLayout::kQuilt ? grid.view_count() : 2;
}

TileCounts GridOf(ViewLayout layout, const TileCounts& grid) {
  switch (layout) {
    case ViewLayout::kQuilt:
      return grid;
    case ViewLayout::kSideBySide:
      return {2, 1};
    case ViewLayout::kOverUnder:
      return {1, 2};
    case ViewLayout::kAnaglyph:
    case ViewLayout::kLeftRight:
      break;
  }
  return {1, 1};
}

ViewTile TileOf(ViewLayout layout, const TileCounts& grid, int view) {
  switch (layout) {
    case ViewLayout::kQuilt:
      return {view % grid.columns, grid.rows - 1 - view / grid.columns};
    case ViewLayout::kSideBySide:
      return {view, 0};
    case ViewLayout::kOverUnder:
      return {0, view};
    case ViewLayout::kAnaglyph:
    case ViewLayout::kLeftRight:
      break;
  }
  return {0, 0};
}

Result<fs::path> PathOfViews(const fs::path& out, const ViewFileName& name) {
  std::string stem = out.stem().string(), description;
  if (name.layout == ViewLayout::kQuilt) {
    description = fmt::format("_qs{}x{}a{}", name.grid.columns, name.grid.rows,
                              AspectText(name.width, name.height));
    const std::string given = DescriptionIn(stem);
    if (!given.empty() && given != description)
      return UsageError(
          fmt::format("{{output {}}}: its name describes another quilt (\"{}\") than that of {} x "
                      "{} views of {} x {} "
                      "pixels (\"{}\"): leave the description out, it is added to the name",
                      out.string(), given, name.grid.columns, name.grid.rows, name.width,
                      name.height, description));
    stem.resize(stem.size() - given.size());
  }
  if (name.layout == ViewLayout::kLeftRight) stem += name.eye == 0 ? "_left" : "_right";
  if (name.moment) stem += fmt::format("_{:04}", *name.moment);
  return out.parent_path() / (stem + description + out.extension().string());
}

}  // namespace lf
