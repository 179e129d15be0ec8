// SPDX-License-Identifier: Apache-2.0
// Decides whether the rays of a film are interpolated between kept pixels or between cells, and
// refuses what cells cannot render (doc/rebinning.md).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/result.h"
#include "lf/light_field/model/radiance.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Returns true if the setting with this key (setting_table.h) changes only renders with cells.
bool IsOfCells(std::string_view key);

// Returns true if the setting with this key changes only renders that rebin.
bool IsOfRebinning(std::string_view key);

// Returns kUsage if the mode is kCollect, but a setting for which IsOfRebinning() is true differs
// from its default, because it would change nothing.
Result<void> CheckMode(const FilmSettings& film);

// Returns film.rebin.interpolation. Returns instead of kAuto
//   kCells   if a setting for which IsOfCells() is true differs from its default, or if the mode is
//            kRebin and the lens weights are kNone
//   kPixels  otherwise
// Does not depend on film.rebin if the mode is kCollect: returns kPixels.
RayInterpolation InterpolationOf(const FilmSettings& film);

// Return true if the mode rebins, and InterpolationOf() is kCells or kPixels.
bool KeepsCells(const FilmSettings& film);
bool KeepsPixels(const FilmSettings& film);

// Returns true if all rays of frames have lens weights: those that are collected, and those of kept
// pixels.
bool HasLensWeights(const FilmSettings& film);

// Returns kUsage if the interpolation is kPixels, but a setting for which IsOfCells() is true
// differs from its default.
Result<void> CheckInterpolation(const FilmSettings& film);

// Returns kUsage if cells are kept and the LF images have opacity (RadianceEncoding::HasOpacity()),
// because cells do not keep it.
Result<void> CheckOpacity(const RadianceEncoding& encoding, const FilmSettings& film);

// Returns kUsage if cells are kept and a camera has a hood or a transmission, because cells are
// queried at the same lens points for all elements, or a focal surface, because they are queried on
// one focus plane.
Result<void> CheckLenses(std::span<const RenderCamera> cameras, const FilmSettings& film);

// Returns kUsage if there is a shutter (CameraPath::shutter) but cells are kept, or the frames are
// guarded: cells are queried for one lens, and a guarded plate compares the rays of one lens.
Result<void> CheckShutter(bool has_shutter, const FilmSettings& film, bool is_guarded);

// Returns kUsage if cells are kept and the number of LF images is limited, because all frames share
// the cells of all LF images.
Result<void> CheckMaxImages(const FilmSettings& film);

// Returns what advice calls the use of pixels instead of cells: "{interpolation pixels}", followed
// by the settings that must be left out. Resolved() may have replaced settings of a film, so that
// advice is made for the film that was given.
//   also  further settings that must be left out
std::string PixelsInstead(const FilmSettings& film, std::vector<std::string> also = {});

// Returns what advice calls the collection of frames without rebinned rays: "{mode collect}",
// followed by the settings that must be left out.
std::string CollectInstead(const FilmSettings& film);

// Returns what messages call the use of cells: "{mode rebin} with {interpolation cells}", followed
// by the setting that has chosen cells unless {interpolation} has.
std::string CellsInWords(const FilmSettings& film);

}  // namespace lf
