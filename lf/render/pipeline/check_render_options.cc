// SPDX-License-Identifier: Apache-2.0
// The functions of render.h that run before a render starts: they check its options, and put the LF
// images in order.
#include <fmt/format.h>

#include <utility>

#include "lf/render/needs/film_order.h"
#include "lf/render/pipeline/check_film_settings.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/frame_source.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/pipeline/resolved_settings.h"
#include "lf/render/settings/interpolation.h"

namespace lf {

Result<void> CheckRenderOptions(const Package& package, const RenderOptions& options) {
  const FilmSettings& film = options.film;
  const FolderOptions& folder = options.folder;
  if (options.source != nullptr) LF_RETURN_IF_ERROR(options.source->Check(package, options));
  if (film.mode == RenderMode::kRebin && KeepsCells(film) && folder.keep_plates)
    return UsageError(
        fmt::format("{{keep_plates}} cannot be used with {}, because a frame that is interpolated "
                    "from cells has no sums of rays: leave it out, or use {} or {}",
                    CellsInWords(film), PixelsInstead(film), CollectInstead(film)));
  LF_RETURN_IF_ERROR(CheckOutputs(package, options));
  LF_RETURN_IF_ERROR(CheckFilmSettings(package, film, options.frames));
  if (!folder.finish_early.empty() && (film.shard || !folder.resume))
    return UsageError(
        "{finish} finishes frames with the rays of an unfinished render: add {resume}, and leave "
        "out {shard}, because the shards of a frame must use all of its LF images");
  if (film.shard && (folder.keep_plates || folder.video))
    return UsageError(
        "{keep_plates} and {video} cannot be used with {shard}, which writes no frames: leave them "
        "out, and give {video} to lfmerge");
  if (film.shard && (film.adds_opacity || folder.picture != PictureOptions()))
    return UsageError(
        "{frame_alpha}, {colour_space}, {z}, {channels}, {exr_compression} and {view} cannot be "
        "used with {shard}, which writes no frames: leave them out, and give them to lfmerge");
  if (folder.picture.channels == FrameChannels::kRgba && !film.adds_opacity)
    return UsageError("{channels rgba} needs frames with alpha: add {frame_alpha}");
  return {};
}

Result<Package> PackageOfFilm(LightField light_field, CameraPath path, const RenderOptions& options,
                              ThreadPool& pool) {
  const FilmSettings& film = options.film;
  const bool depends_on_frames = DependsOnFrames(film.order);
  Package package = PackageOfAll(std::move(light_field), std::move(path), film.seed,
                                 depends_on_frames ? ImageOrder::kShuffle : film.order);
  package.choices.order = film.order;
  package.choices.max_angle_rad = film.max_angle_rad;
  LF_RETURN_IF_ERROR(CheckRenderOptions(package, options));
  if (!depends_on_frames) return package;
  WorkSettings work = options.work;
  if (options.signals != nullptr) work.stop = &options.signals->stop;
  const NeedsOptions needs = NeedsOfFilm(package, Resolved(film, package), work);
  LF_ASSIGN_OR_RETURN(package.ranks, RanksOfFilm(film.order, film.seed, package.light_field,
                                                 package.path, needs, pool));
  return package;
}

}  // namespace lf
