// SPDX-License-Identifier: Apache-2.0
// Warns if a packed store was encoded for other films than the one that is rendered.
// Internal to this folder.
#pragma once

#include "lf/core/result.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Warns if the light field of the package is a packed store whose LF images have thresholds for
// certain films (StoreFilms), and the film of the package is none of them, or takes other rays of
// them: in another mode, or with lens weights where they had none or the reverse. All parts of a
// film, and all resolutions of it, are the same film. A process warns once for each store and film.
// kInput: the packed store cannot be read.
//   film  completed (Resolved())
Result<void> WarnOfOtherFilm(const Package& package, const FilmSettings& film);

}  // namespace lf
