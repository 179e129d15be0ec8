// SPDX-License-Identifier: Apache-2.0
#include "tools/render_densified.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "tools/common/progress.h"

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/densify/densify.h"
#include "lf/densify/densify_report.h"
#include "lf/densify/depth_cache.h"
#include "lf/render/pipeline/render.h"
#include "lf/storage/packed/packed_store_file.h"
#include "lf/storage/packed/packed_store_writer.h"

namespace lf {
namespace {

// Checks the options as if the light field were densified already.
Result<void> CheckDensified(const LightField& light_field, const CameraPath& path,
                            const RenderOptions& options) {
  Package package = PackageOfAll(light_field, path, 0);
  package.whole_virtual_count = 1;
  return CheckRenderOptions(package, options);
}

Result<DensifyOptions> OptionsOf(const LightField& light_field, const CameraPath& path,
                                 const RenderArguments& arguments, const RenderOptions& options) {
  DensifyOptions densify;
  LF_ASSIGN_OR_RETURN(densify.cache, DepthCacheFolder(arguments.cache, light_field));
  densify.store = options.folder.output_folder / "densified.lfs";
  densify.choices.frames.assign(path.AllInstants().begin(), path.AllInstants().end());
  // With the default of --memory, this is the default of lfdensify.
  densify.memory_bytes = options.work.memory_bytes / 4;
  densify.overwrite = options.folder.overwrite;
  densify.resume =
      options.folder.resume || (!options.folder.overwrite && IsPackedStore(densify.store) &&
                                !PackedStoreWriter::IsUnfinished(densify.store));
  densify.strict = options.work.strict;
  densify.source_name = arguments.inputs.front();
  densify.source_options = arguments.light_field.Words();
  densify.version = options.folder.version;
  if (options.signals != nullptr) densify.interrupted = &options.signals->stop;
  return densify;
}

// Tells what was done, and names the LF images that were left out.
void Tell(const DensifyReport& report, const DensifyOptions& options) {
  for (const DensifyReport::Skipped& skipped : report.skipped)
    LogWarning("{}: left out: {}", skipped.name, skipped.reason);
  if (report.cached_planes > 0)
    LogInfo("{}: had {} depth planes of an earlier call", options.cache.string(),
            report.cached_planes);
  LogInfo("{}: {} recorded and {} virtual LF images, copies at most {:.2g} px apart{}",
          options.store.string(), report.recorded_count, report.virtual_count, report.spacing_px,
          report.was_there ? "; existed already" : "");
  if (report.filled_diameter_w)
    LogWarning(
        "not all lenses are filled with virtual LF images: the LF cameras are near enough to fill "
        "one of a diameter of {:.4g} world units",
        *report.filled_diameter_w);
}

}  // namespace

Result<DensifiedFilm> DensifyForFilm(LightField light_field, const CameraPath& path,
                                     const RenderArguments& arguments, const RenderOptions& options,
                                     const CommonOptions& common, ThreadPool& pool) {
  LF_RETURN_IF_ERROR(CheckDensified(light_field, path, options));
  LF_ASSIGN_OR_RETURN(const DensifyOptions densify,
                      OptionsOf(light_field, path, arguments, options));
  std::vector<OutputFile> outputs = {{densify.store, "the densified store"}};
  if (options.folder.video) outputs.emplace_back(*options.folder.video, "the video", "--video");
  LF_RETURN_IF_ERROR(CheckOutputFiles(std::move(outputs), options.folder.inputs));
  LF_RETURN_IF_ERROR(CreateFolder(options.folder.output_folder));
  ProgressMeter meter(ParseProgressStyle(common.progress), "comparisons");
  LF_ASSIGN_OR_RETURN(
      const DensifyReport report,
      Densify(light_field, densify, pool, [&](const DensifyProgress& now) {
        meter.Update(now.work_done, now.work_total, {{now.step, now.done, now.total}});
      }));
  if (!report.dense.empty()) {
    LogInfo("--densify makes no virtual LF images: {}", report.dense);
    return DensifiedFilm{std::move(light_field), {}};
  }
  Tell(report, densify);
  DensifiedFilm film;
  film.missing = {report.skipped.size(), report.asked_count(), MissingText(report, densify),
                  "once they are mended, render again with --overwrite"};
  LF_ASSIGN_OR_RETURN(film.light_field, OpenLightField(densify.store, OpenOptions{}));
  // The store may have been made for frames over another background.
  film.light_field.encoding.background = light_field.encoding.background;
  film.light_field.encoding.keeps_opacity = light_field.encoding.keeps_opacity;
  return film;
}

}  // namespace lf
