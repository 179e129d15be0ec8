// SPDX-License-Identifier: Apache-2.0
// Internal to lf/distribute/preprocess. The settings of the render for which packages are made.
#pragma once

#include <atomic>
#include <span>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/needs/frame_needs.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// Returns the settings, with the filter, the interpolation and the lens weights that the render
// will use for "auto".
FilmSettings LaterRender(FilmSettings film, const LightField& light_field);

// Returns the options that decide what frames need, such that the packages can be rendered with any
// filter.
//   film         the result of LaterRender()
//   interrupted  once true, selections end soon; may be null
NeedsOptions NeedsOfLaterRender(const FilmSettings& film, const LightField& light_field,
                                const std::atomic<bool>* interrupted);

// Returns kUsage if the settings are not compatible with each other, with the light field or with
// the lenses of the frames (Preprocess() lists the errors).
Result<void> CheckLaterRender(const LightField& light_field, const CameraPath& path,
                              std::span<const FrameId> frames, const FilmSettings& film,
                              const NeedsOptions& needs);

}  // namespace lf
