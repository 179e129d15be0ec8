// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/interpolation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
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

}  // namespace

bool IsOfCells(std::string_view key) {
  return std::find(std::begin(kOfCells), std::end(kOfCells), key) != std::end(kOfCells);
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

std::string PixelsInstead(const FilmSettings& film) {
  std::vector<std::string> without;
  for (const std::string_view key : kOfCells)
    if (IsGiven(key, film)) without.push_back(fmt::format("{{{}}}", key));
  const char* const pixels = "{interpolation pixels}";
  if (without.empty()) return pixels;
  return fmt::format("{} without {}", pixels, fmt::join(without, ", "));
}

Result<void> CheckOpacity(const RadianceEncoding& encoding, const FilmSettings& film) {
  if (!KeepsCells(film) || !encoding.HasOpacity()) return {};
  return UsageError(fmt::format(
      "{{mode {}}} with {{interpolation cells}} cannot make frames with an alpha channel "
      "({{background none}}, or lf_background in the calibration): use {}, {{mode collect}}, or "
      "{{background black}}, which gives the same colours (for packages, give it to "
      "lfpreprocessor)",
      NameOf(film.mode), PixelsInstead(film)));
}

Result<void> CheckLenses(std::span<const RenderCamera> cameras, const FilmSettings& film) {
  if (!KeepsCells(film)) return {};
  const char* const mode = NameOf(film.mode);
  const std::string pixels = PixelsInstead(film);
  for (const RenderCamera& camera : cameras) {
    if (camera.hood.exists())
      return UsageError(fmt::format(
          "{{mode {}}} with {{interpolation cells}} cannot render a lens with a hood "
          "(lens.hood_diameter in the path): use {} or {{mode collect}}, or leave the hood out",
          mode, pixels));
    if (camera.transmission)
      return UsageError(fmt::format(
          "{{mode {}}} with {{interpolation cells}} cannot render a lens with a transmission "
          "(lens.transmission in the path): use {} or {{mode collect}}, or leave the transmission "
          "out",
          mode, pixels));
    if (camera.surface)
      return UsageError(
          fmt::format("{{mode {}}} with {{interpolation cells}} cannot render a focal surface "
                      "(focus.surface in "
                      "the path): use {} or {{mode collect}}, or remove 'focus' from the path",
                      mode, pixels));
  }
  return {};
}

Result<void> CheckShutter(bool has_shutter, const FilmSettings& film, bool is_guarded) {
  if (!has_shutter) return {};
  if (KeepsCells(film))
    return UsageError(fmt::format(
        "{{mode {}}} with {{interpolation cells}} cannot render a path with a shutter, because "
        "cells are queried for one lens of each frame: use {} or {{mode collect}}, or remove "
        "'shutter' from the path",
        NameOf(film.mode), PixelsInstead(film)));
  if (is_guarded)
    return UsageError(
        "the light field is densified, and frames of a path with a shutter cannot be guarded: add "
        "{guard off}, or remove 'shutter' from the path");
  return {};
}

Result<void> CheckMaxImages(const FilmSettings& film) {
  if (!KeepsCells(film) || !film.max_image_count) return {};
  return UsageError(fmt::format(
      "{{max_images}} cannot be used with {{mode {}}} and {{interpolation cells}}, in which all "
      "frames share the cells of all LF images: leave it out, or use {} or {{mode collect}}",
      NameOf(film.mode), PixelsInstead(film)));
}

}  // namespace lf
