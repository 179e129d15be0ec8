// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/setup_inputs.h"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>

#include "lf/storage/packed/packed_store_file.h"

namespace lf {

RunInputs InputsOfRebinning(const FilmSettings& options, size_t max_cells,
                            const std::string& film) {
  if (!options.Rebins()) return {};
  const RebinSettings& rebin = options.rebin;
  const ProbabilityOptions& edges = rebin.rebin.probability;
  const auto width = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : std::string("auto");
  };
  const auto place = [](const std::optional<Vec3>& v) {
    return v ? fmt::format("{} {} {}", v->x(), v->y(), v->z()) : std::string("auto");
  };
  return {
      {"mode", NameOf(options.mode)},
      {"rebin.film", film},
      {"rebin.max_rays", fmt::format("{}", max_cells)},
      {"rebin.kept", NameOf(rebin.kept)},
      {"rebin.edges", fmt::format("alpha {} beta {} xi {} sigma {} then {}", edges.alpha,
                                  edges.beta, edges.xi, edges.sigma_px, edges.second_sigma_px)},
      {"rebin.colours", fmt::format("sigma {}", rebin.rebin.colour_sigma_px)},
      {"rebin.others", rebin.rebin.averages_others ? "averaged" : "left out"},
      {"rebin.seed", fmt::format("{}", rebin.rebin.seed)},
      {"rebin.preview", NameOf(rebin.previews)},
      {"rebin.query", fmt::format("sigma_st {} sigma_uv {} lens points {} sets {} on {} nearest {}",
                                  rebin.query.sigma_st, rebin.query.sigma_uv,
                                  rebin.query.lens_point_count, rebin.query.lens_sets,
                                  rebin.reparameterise ? "focus planes" : "slabs", rebin.nearest)},
      {"rebin.slab", fmt::format("position {} forward {} distance {} r_st {} r_uv {}",
                                 place(rebin.slab.position_world), place(rebin.slab.forward_world),
                                 width(rebin.slab.uv_distance_w), width(rebin.slab.r_st_w),
                                 width(rebin.slab.r_uv_w))},
      {"rebin.coverage", fmt::format("{} cells across", rebin.coverage.cells_across)}};
}

Result<RunInputs> InputsOfRays(const FilmSetup& setup) {
  const Package& package = setup.package();
  const FilmSettings& film = setup.film();
  RunChoices choices;
  LF_ASSIGN_OR_RETURN(choices.pixels, PixelsOf(setup.light_field()));
  choices.film = film;
  RunInputs rays = InputsOfRays(package.whole, setup.light_field().encoding, choices);
  if (setup.is_guarded()) rays.emplace_back("guard", "on");
  for (auto& input : InputsOfRebinning(film, setup.max_cells(), HashOfCameras(package.path)))
    rays.push_back(std::move(input));
  return rays;
}

Result<std::string> PixelsOf(const LightField& light_field) {
  const std::string as_recorded = RunChoices().pixels;
  if (!HoldsPackedStore(light_field)) return as_recorded;
  LF_ASSIGN_OR_RETURN(std::string codec, ReadCodecSettings(light_field.folder));
  return codec.starts_with(kLosslessCodec) ? as_recorded : codec;
}

}  // namespace lf
