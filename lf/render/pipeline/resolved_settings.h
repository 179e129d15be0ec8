// SPDX-License-Identifier: Apache-2.0
// Completes the settings of a film by what follows from its package.
#pragma once

#include "lf/render/needs/frame_needs.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Returns the settings, with these values replaced by what follows from the package and from other
// settings:
//   order, seed, max_angle_rad  those that the package was made with; rebin has the same seed
//   rebin.interpolation  if the mode rebins: the choice of InterpolationOf() (settings/
//                    interpolation.h), never kAuto
//   lens_weights     kNone if frames are interpolated between cells alone (the mode is kRebin), or
//                    if it was kAuto and rays are counted
//   reading.filter   if it was kAuto: the choice of FilterOf() (collection/gather_sampling.h)
//   guard            false unless the light field is densified
//   max_image_count  the limit that the package was made with, if it was unset
FilmSettings Resolved(FilmSettings settings, const Package& package);

// Returns the options that decide which LF images frames of the package need
// (render/needs/frame_needs.h).
//   film  the result of Resolved()
NeedsOptions NeedsOfFilm(const Package& package, const FilmSettings& film,
                         const WorkSettings& work);

}  // namespace lf
