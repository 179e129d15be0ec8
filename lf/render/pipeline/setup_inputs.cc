// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/setup_inputs.h"

#include <string>
#include <utility>

#include "lf/storage/packed/packed_store_file.h"

namespace lf {

RunInputs InputsOfSlabs(const FilmSettings& film, const CameraPath& path) {
  if (!film.Rebins()) return {};
  return {{"slabs.cameras", HashOfCameras(path)}};
}

Result<RunInputs> InputsOfRays(const FilmSetup& setup) {
  const Package& package = setup.package();
  const FilmSettings& film = setup.film();
  RunChoices choices;
  LF_ASSIGN_OR_RETURN(choices.pixels, PixelsOf(setup.light_field()));
  choices.film = film;
  choices.film.rebin.max_cells = setup.max_cells();
  RunInputs rays = InputsOfRays(package.whole, setup.light_field().encoding, choices);
  for (auto& input : InputsOfSlabs(film, package.path)) rays.push_back(std::move(input));
  return rays;
}

Result<std::string> PixelsOf(const LightField& light_field) {
  const std::string as_recorded = RunChoices().pixels;
  if (!HoldsPackedStore(light_field)) return as_recorded;
  LF_ASSIGN_OR_RETURN(std::string codec, ReadCodecSettings(light_field.folder));
  return codec.starts_with(kLosslessCodec) ? as_recorded : codec;
}

}  // namespace lf
