// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/interpolation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>
#include <vector>

#include "lf/render/settings/setting_table.h"

namespace lf {
namespace {

constexpr std::string_view kOfCells[] = {
    "average_others", "colour_sigma", "sigma_st",       "sigma_uv",       "lens_points",
    "lens_sets",      "nearest",      "reparameterise", "r_st",           "r_uv",
    "slab_position",  "slab_forward", "slab_distance",  "coverage_cells", "preview"};

bool IsGiven(std::string_view key, const FilmSettings& film) {
  static const FilmSettings usual;
  const Setting& setting = *FindSetting(key);
  // Pixels have no previews, so that "off" is theirs, as "auto" is.
  if (key == "preview") return film.rebin.previews == Previews::kOn;
  return setting.get(film) != setting.get(usual);
}

bool GivesAnyOfCells(const FilmSettings& film) {
  return std::any_of(std::begin(kOfCells), std::end(kOfCells),
                     [&film](std::string_view key) { return IsGiven(key, film); });
}

// Returns advice, followed by the settings that must be left out.
std::string Without(const char* advice, const std::vector<std::string>& settings) {
  if (settings.empty()) return advice;
  return fmt::format("{} without {}", advice, fmt::join(settings, ", "));
}

// Returns the settings that differ from their defaults although the mode does not rebin.
std::vector<const Setting*> GivenOfRebinning(const FilmSettings& film) {
  static const FilmSettings usual;
  std::vector<const Setting*> given;
  for (const Setting& setting : SettingTable())
    if (IsOfRebinning(setting.key) && setting.get(film) != setting.get(usual))
      given.push_back(&setting);
  return given;
}

// Returns what advice about a transmission adds, because only lens weights state it: the settings
// that give LF images equal weights.
std::string WithoutUnweighted(const FilmSettings& film) {
  std::vector<std::string> unweighted;
  if (film.lens_weights == LensWeights::kNone) unweighted.push_back("{lens_weights none}");
  if (film.stop_when.samples) unweighted.push_back("{stop_when}");
  if (film.require.samples) unweighted.push_back("{require}");
  if (film.smooth_below > 1) unweighted.push_back("{smooth_below}");
  return Without(unweighted.empty() ? "" : ", both", unweighted);
}

}  // namespace

bool IsOfCells(std::string_view key) {
  return std::find(std::begin(kOfCells), std::end(kOfCells), key) != std::end(kOfCells);
}

bool IsOfRebinning(std::string_view key) {
  return FindSetting(key)->group == SettingGroup::kRebinning || IsOfCells(key);
}

Result<void> CheckMode(const FilmSettings& film) {
  if (film.Rebins()) return {};
  std::vector<std::string> given;
  for (const Setting* setting : GivenOfRebinning(film))
    given.push_back(fmt::format("{{{} {}}}", setting->key, setting->get(film)));
  if (given.empty()) return {};
  const bool is_one = given.size() == 1;
  return UsageError(fmt::format(
      "{} {} nothing in {{mode collect}}: add {{mode rebin}} or {{mode hybrid}}, or leave {} out",
      fmt::join(given, ", "), is_one ? "changes" : "change", is_one ? "it" : "them"));
}

RayInterpolation InterpolationOf(const FilmSettings& film) {
  if (!film.Rebins()) return RayInterpolation::kPixels;
  if (film.rebin.interpolation != RayInterpolation::kAuto) return film.rebin.interpolation;
  const bool is_of_thesis =
      film.mode == RenderMode::kRebin && film.lens_weights == LensWeights::kNone;
  return is_of_thesis || GivesAnyOfCells(film) ? RayInterpolation::kCells
                                               : RayInterpolation::kPixels;
}

bool KeepsCells(const FilmSettings& film) {
  return film.Rebins() && InterpolationOf(film) == RayInterpolation::kCells;
}

bool KeepsPixels(const FilmSettings& film) {
  return film.Rebins() && InterpolationOf(film) == RayInterpolation::kPixels;
}

bool HasLensWeights(const FilmSettings& film) { return film.Collects() || KeepsPixels(film); }

Result<void> CheckInterpolation(const FilmSettings& film) {
  if (!KeepsPixels(film)) return {};
  for (const std::string_view key : kOfCells)
    if (IsGiven(key, film))
      return UsageError(fmt::format(
          "{{interpolation pixels}} cannot be used with {{{} {}}}, which changes cells alone: "
          "leave {{{}}} out, or use {{interpolation cells}}",
          key, FindSetting(key)->get(film), key));
  return {};
}

std::string PixelsInstead(const FilmSettings& film, std::vector<std::string> also) {
  std::vector<std::string> without;
  for (const std::string_view key : kOfCells)
    if (IsGiven(key, film)) without.push_back(fmt::format("{{{}}}", key));
  std::move(also.begin(), also.end(), std::back_inserter(without));
  return Without("{interpolation pixels}", without);
}

std::string CollectInstead(const FilmSettings& film) {
  std::vector<std::string> without;
  for (const Setting* setting : GivenOfRebinning(film))
    without.push_back(fmt::format("{{{}}}", setting->key));
  return Without("{mode collect}", without);
}

std::string CellsInWords(const FilmSettings& film) {
  const std::string cells =
      fmt::format("{{mode {}}} with {{interpolation cells}}", NameOf(film.mode));
  if (film.rebin.interpolation == RayInterpolation::kCells) return cells;
  for (const std::string_view key : kOfCells)
    if (IsGiven(key, film))
      return fmt::format("{} (chosen by {{{} {}}})", cells, key, FindSetting(key)->get(film));
  return fmt::format("{} (chosen by {{lens_weights none}})", cells);
}

Result<void> CheckOpacity(const RadianceEncoding& encoding, const FilmSettings& film) {
  if (!KeepsCells(film) || !encoding.HasOpacity()) return {};
  return UsageError(
      fmt::format("{} cannot make frames with an alpha channel ({{background none}}, or "
                  "lf_background in the calibration): use {}, {}, or {{background black}}, which "
                  "gives the same colours (for packages, give it to lfpreprocessor)",
                  CellsInWords(film), PixelsInstead(film), CollectInstead(film)));
}

Result<void> CheckLenses(std::span<const RenderCamera> cameras, const FilmSettings& film) {
  if (!KeepsCells(film)) return {};
  const std::string cells = CellsInWords(film), pixels = PixelsInstead(film),
                    collect = CollectInstead(film);
  for (const RenderCamera& camera : cameras) {
    if (camera.hood.exists())
      return UsageError(
          fmt::format("{} cannot render a lens with a hood (lens.hood_diameter in the path): use "
                      "{} or {}, or leave the hood out",
                      cells, pixels, collect));
    if (camera.transmission)
      return UsageError(
          fmt::format("{} cannot render a lens with a transmission (lens.transmission in the "
                      "path): use {} or {}{}, or leave the transmission out",
                      cells, pixels, collect, WithoutUnweighted(film)));
    if (camera.surface)
      return UsageError(
          fmt::format("{} cannot render a focal surface (focus.surface in the path): use {} or {}, "
                      "or remove 'focus' from the path",
                      cells, pixels, collect));
  }
  return {};
}

Result<void> CheckShutter(bool has_shutter, const FilmSettings& film, bool is_guarded) {
  if (!has_shutter) return {};
  if (KeepsCells(film))
    return UsageError(
        fmt::format("{} cannot render a path with a shutter, because cells are queried for one "
                    "lens of each frame: use {} or {}, or remove 'shutter' from the path",
                    CellsInWords(film), PixelsInstead(film), CollectInstead(film)));
  if (is_guarded)
    return UsageError(
        "the light field is densified, and frames of a path with a shutter cannot be guarded: add "
        "{guard off}, or remove 'shutter' from the path");
  return {};
}

Result<void> CheckMaxImages(const FilmSettings& film) {
  if (!KeepsCells(film) || !film.max_image_count) return {};
  return UsageError(
      fmt::format("{} cannot be used with {{max_images}}, because all frames share the cells of "
                  "all LF images: leave {{max_images}} out, or use {} or {}",
                  CellsInWords(film), PixelsInstead(film), CollectInstead(film)));
}

}  // namespace lf
