// SPDX-License-Identifier: Apache-2.0
// The inputs that decide the rays of a film (render/state/run_inputs.h), from its setup.
#pragma once

#include <string>

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/pipeline/film_setup.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

// Returns the inputs of the slabs of rebinned rays: a hash of all cameras of the film, which all
// slabs depend on. No inputs if the mode is kCollect.
RunInputs InputsOfSlabs(const FilmSettings& film, const CameraPath& path);

// Returns the inputs of the rays of all frames, those of rebinned rays included; max_rays is the
// number of cells that the memory of the setup allows. kInput: the packed store of the light field
// cannot be read.
Result<RunInputs> InputsOfRays(const FilmSetup& setup);

// Returns RunChoices::pixels of a light field: the settings of the lossy codec that changed the
// pixels of its LF images, or that they are as recorded. kInput: the packed store cannot be read.
Result<std::string> PixelsOf(const LightField& light_field);

}  // namespace lf
