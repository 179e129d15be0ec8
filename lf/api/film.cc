// SPDX-License-Identifier: Apache-2.0
#include "lf/api/film.h"

#include <cstdio>
#include <utility>

#include "lf/core/parallel.h"
#include "lf/core/spelling.h"
#include "lf/core/version.h"
#include "lf/import/paths/focal_surface_file.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/recording_times.h"
#include "lf/render/package/package.h"
#include "lf/render/pipeline/render.h"

namespace lf {
int Report(const Error& error) {
  std::fprintf(stderr, "error: %s\n", Spelled(error.message).c_str());
  return static_cast<int>(error.kind);
}

Result<LightField> Open(const std::filesystem::path& light_field, const OpenOptions& options) {
  return OpenLightField(light_field, options);
}

Result<Film> OpenFilm(LightField light_field, const std::filesystem::path& path,
                      PathOptions options) {
  const PathOptions of_field = PathOptionsToRender(light_field);
  options.light_field_unit_m = of_field.light_field_unit_m;
  options.depth_range = of_field.depth_range;
  options.light_field = of_field.light_field;
  options.surface = of_field.surface;
  Film film;
  LF_ASSIGN_OR_RETURN(film.path, OpenPath(path, options));
  LF_RETURN_IF_ERROR(FitToOpenTimes(light_field, &film.path));
  ThreadPool pool;
  LF_RETURN_IF_ERROR(AddFocalSurfaces(path, light_field, {{}, &pool, nullptr}, &film.path));
  film.light_field = std::move(light_field);
  film.files = FilesOfPath(path);
  return film;
}

Result<RenderReport> RenderFilm(const Film& film, FolderOptions folder, std::vector<FrameId> frames,
                                RenderSignals* signals,
                                const std::function<void(const RenderProgress&)>& progress) {
  RenderOptions options = {.frames = std::move(frames),
                           .film = film.settings,
                           .work = film.work,
                           .folder = std::move(folder),
                           .signals = signals};
  options.folder.version = Version();
  options.folder.inputs.insert(options.folder.inputs.end(), film.files.begin(), film.files.end());
  options.folder.inputs.push_back(film.light_field.source);
  ThreadPool pool(film.work.threads);
  LF_ASSIGN_OR_RETURN(Package package, PackageOfFilm(film.light_field, film.path, options, pool));
  return Render(std::move(package), options, pool, progress);
}

}  // namespace lf
