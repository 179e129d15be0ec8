// SPDX-License-Identifier: Apache-2.0
#include "tools/focus_through.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/focus_frame.h"
#include "tools/render_end.h"
#include "tools/render_summary.h"
#include "tools/through_arguments.h"

#include "lf/analysis/lens_statistics/lens_statistics.h"
#include "lf/analysis/lens_statistics/statistic_film.h"
#include "lf/core/geometry.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/core/quantities.h"
#include "lf/core/value_named.h"
#include "lf/core/version.h"
#include "lf/film/develop/frame_file.h"
#include "lf/import/paths/open_path.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/pipeline/render.h"
#include "lf/render/pipeline/render_packages.h"
#include "lf/render/state/other_films.h"
#include "lf/render/state/record_fields.h"

namespace lf {
namespace {

namespace fs = std::filesystem;

constexpr HelpTexts kHelp = {
    .summary = "Sees through leaves and rain: a statistic over the lens instead of the mean.",
    .usage = R"(  lffocus through LIGHTFIELD PATH -o FILE [-o FILE...] [OPTIONS]
  lffocus through LIGHTFIELD PATH -o FOLDER [OPTIONS]
  lffocus through LIGHTFIELD PACKAGE... -o FOLDER [OPTIONS])",
    .examples = R"(  lffocus through capture/ path.yaml -o seen.exr
  lffocus through capture/ path.yaml --frame 12 -o seen.png --statistic min
  lffocus through capture/ path.yaml --frames 1-100 -o seen --video seen.mp4
  lffocus through capture/ path.yaml -o seen.exr -o seen.png --statistic trimmed --trim 0.3
  lffocus through capture/ packages/package-*.lfp -o seen     # packages of lfpreprocessor)",
    .details =
        R"(A frame is the mean of the rays that pass the lens. Things in front of the focus plane become a blur
over it. This command takes the median of the rays of each element instead, or another statistic, so
that things which hide the focus plane from some LF cameras vanish. Focus on what is to be seen:
everything else becomes wrong, because the statistics of blur are no blur.

min shows what is behind bright things, max what is behind dark things, however many rays they hide,
as long as one ray is free. median needs more than half of the rays free. trimmed has less noise
than median, and needs the hidden rays within the share --trim at either end. Open the lens as wide
as the LF cameras reach: --json and the channel count tell the number of rays.

Each LF camera has one ray, and all count the same. Virtual LF images are left out. A focal surface in
PATH is rendered: the ground of a height map, for example, is seen through trees.

Without a name that ends in .exr or .png, OUT is a folder. It receives the frames of PATH as of
lfrenderer: frame_0001.exr ..., contact_sheet.png and report.json. On Ctrl-C (SIGINT), SIGTERM and
SIGHUP the program ends with exit code 5. Finished frames are kept, and --resume continues with the
frames that were being made.

Packages of lfpreprocessor share a film among machines, which may write into one FOLDER at the same
time: each package has its own report, and one that is rendered alone its own contact sheet.)",
};

using Arguments = ThroughArguments;

// Options of which it matters whether they are given.
struct Given {
  bool frame = false, trim = false;
};

LensStatistic StatisticOf(const Arguments& a) {
  return *ValueNamed(a.statistic, {LensStatistic::kMedian, LensStatistic::kTrimmed,
                                   LensStatistic::kMin, LensStatistic::kMax, LensStatistic::kMean});
}

bool IsFile(const std::string& output) {
  const std::string extension = fs::path(output).extension().string();
  return extension == ".exr" || extension == ".png";
}

// Returns the format of a file. kUsage: its name does not fit.
Result<FrameFormat> FormatOf(const Arguments& a, const std::string& output) {
  const std::string extension = fs::path(output).extension().string();
  if (a.format == "auto") return extension == ".exr" ? FrameFormat::kExrHalf : FrameFormat::kPng8;
  const FrameFormat format = *ParseFrameFormat(a.format);
  if (IsExr(format) == (extension == ".exr")) return format;
  return UsageError(fmt::format("-o {}: --format {} needs a name that ends in {}", output, a.format,
                                IsExr(format) ? ".exr" : ".png"));
}

// Returns true if the output is a folder, and false if all outputs are files. kUsage: an option
// does not go with it.
Result<bool> HasFolder(const Arguments& a, const Given& given) {
  const auto refuse = [](std::string_view option, const std::string& output, std::string_view why) {
    return UsageError(fmt::format("{} cannot be used with -o {}, {}", option, output, why));
  };
  for (const std::string& output : a.outputs) {
    if (IsFile(output)) continue;
    LF_RETURN_IF_ERROR(CheckFolderName(output, "seen.exr or seen.png"));
    if (a.outputs.size() > 1)
      return UsageError(fmt::format(
          "-o {} is a folder, beside which no other output is written: give one folder, or files "
          "that end in .exr or .png",
          output));
    if (given.frame)
      return refuse("--frame", output, "which is a folder: give --frames, or a file");
    return true;
  }
  constexpr const char* kFile = "which is a file of one frame: give a folder, or leave it out";
  if (!a.frames.range.empty()) return refuse("--frames", a.outputs.front(), kFile);
  if (a.frames.clamp) return refuse("--clamp-frames", a.outputs.front(), kFile);
  if (!a.video.empty()) return refuse("--video", a.outputs.front(), kFile);
  if (a.no_contact_sheet) return refuse("--no-contact-sheet", a.outputs.front(), kFile);
  if (a.resume) return refuse("--resume", a.outputs.front(), kFile);
  return false;
}

Result<void> CheckPaths(const Arguments& a, bool has_folder) {
  if (!a.HasPackages()) {
    if (a.paths.size() == 1) return {};
    return UsageError(fmt::format(
        "{} paths are given: expected one PATH, or only packages (files that end in .lfp)",
        a.paths.size()));
  }
  if (!has_folder)
    return UsageError(fmt::format(
        "-o {} is a file of one frame, but packages are rendered into a folder: give a folder, or "
        "the path that the packages were made for",
        a.outputs.front()));
  if (a.max_angle_deg > 0)
    return UsageError(
        "--max-angle cannot be used with packages, because lfpreprocessor has already selected "
        "their LF cameras: leave it out, or make the packages again with lfpreprocessor "
        "--max-angle");
  return a.light_field.CheckWithPackages();
}

Result<LensStatisticOptions> OptionsOf(const Arguments& a, const CommonOptions& common,
                                       const Given& given) {
  LensStatisticOptions options;
  options.statistic = StatisticOf(a);
  if (given.trim && options.statistic != LensStatistic::kTrimmed)
    return UsageError(fmt::format(
        "--trim cannot be used with --statistic {}: add --statistic trimmed, or leave it out",
        a.statistic));
  options.trim = a.trim;
  if (options.statistic == LensStatistic::kTrimmed && !(a.trim < 0.5))
    return UsageError(fmt::format(
        "--trim {}: expected a share from 0 to below 0.5: median is the limit", a.trim));
  options.order = a.order == "channels" ? StatisticOrder::kChannels : StatisticOrder::kLuminance;
  options.filter = ValueNamed(a.filter, {PixelFilter::kNearest, PixelFilter::kBilinear,
                                         PixelFilter::kBicubic, PixelFilter::kPrefiltered})
                       .value_or(PixelFilter::kAuto);
  if (a.lf_pixels != "auto")
    options.footprint = a.lf_pixels == "areas" ? PixelFootprint::kArea : PixelFootprint::kPoint;
  FilmSettings film;
  LF_RETURN_IF_ERROR(a.settings.Set(&film));
  options.max_image_count = film.max_image_count;
  if (a.max_angle_deg > 0) options.max_angle_rad = RadiansFromDegrees(a.max_angle_deg);
  LF_ASSIGN_OR_RETURN(options.memory_bytes, ParseByteSize(a.memory, "--memory"));
  options.strict = common.strict;
  options.adds_opacity = a.picture.HasAlpha();
  return options;
}

Result<void> CheckOutputs(const Arguments& a, const LightField& light_field) {
  // Inputs come first, because --overwrite does not replace them.
  std::vector<fs::path> inputs = FilesOfLightField(light_field, a.light_field.path);
  for (fs::path& file : FilesOfPath(a.frame.path)) inputs.push_back(std::move(file));
  LF_RETURN_IF_ERROR(CheckOutputFiles({a.outputs.begin(), a.outputs.end()}, inputs));
  for (const std::string& output : a.outputs) {
    std::error_code error;
    if (!a.overwrite && fs::exists(output, error))
      return UsageError(fmt::format(
          "{} exists already: give another name, or --overwrite to replace it", output));
  }
  return {};
}

// The light field, and the path with the focal surfaces of the frames that are made.
struct Opened {
  LightField light_field;
  CameraPath path;
  std::vector<FrameId> frames;  // frames of a folder; empty: all
};

Result<Opened> Open(const Arguments& a, bool has_folder, const std::atomic<bool>& interrupted,
                    ThreadPool& pool) {
  Opened opened;
  LF_ASSIGN_OR_RETURN(opened.light_field, a.light_field.Open());
  if (!has_folder) LF_RETURN_IF_ERROR(CheckOutputs(a, opened.light_field));
  LF_ASSIGN_OR_RETURN(opened.path, a.frame.Open(opened.light_field, PathOptions::Surface::kName));
  if (opened.path.shutter.exists())
    return UsageError(fmt::format(
        "{}: the path has a shutter, whose blur has no share in an order of rays: leave the "
        "shutter out",
        a.frame.path));
  LF_ASSIGN_OR_RETURN(opened.frames, a.frames.Of(opened.path.frames()));
  if (a.frames.IsNone(opened.frames)) return opened;
  SurfaceWork work = {opened.frames, &pool, &interrupted};
  if (!has_folder) work.frames = {a.frame.IdIn(opened.path)};
  // A film compares the surfaces of all frames of earlier renders that it finds.
  if (a.resume || (has_folder && !ReportsIn(a.outputs.front()).empty())) work.frames.clear();
  LF_RETURN_IF_ERROR(AddFocalSurfaces(a.frame.path, opened.light_field, work, &opened.path));
  return opened;
}

Result<StatisticFrame> MakeOne(const Arguments& a, Opened opened,
                               const LensStatisticOptions& options, const CommonOptions& common,
                               ThreadPool& pool) {
  ProgressMeter meter(ParseProgressStyle(common.progress), "LF images");
  const FrameId id = a.frame.IdIn(opened.path);
  LF_ASSIGN_OR_RETURN(StatisticFrame frame,
                      MakeStatisticFrame(std::move(opened.light_field), id, opened.path.Camera(id),
                                         options, pool, [&](size_t done, size_t total) {
                                           meter.Update(done, total, std::string(a.statistic));
                                         }));
  frame.notes.fps = opened.path.fps;
  frame.notes.first_frame = opened.path.first_frame;
  frame.notes.version = Version();
  return frame;
}

// The largest and the median number of rays of the elements that have some.
struct RayCounts {
  uint32_t median = 0, most = 0;
  double seen_share = 0;
};
RayCounts CountsOf(const DevelopedFrame& picture) {
  std::vector<uint32_t> counts;
  for (int y = 0; y < picture.ray_count.height(); ++y)
    for (int x = 0; x < picture.ray_count.width(); ++x)
      if (const uint32_t count = picture.ray_count.at(x, y, 0); count > 0) counts.push_back(count);
  RayCounts result;
  if (counts.empty()) return result;
  std::sort(counts.begin(), counts.end());
  result.median = counts[counts.size() / 2];
  result.most = counts.back();
  result.seen_share =
      static_cast<double>(counts.size()) / picture.ray_count.width() / picture.ray_count.height();
  return result;
}

// Returns the entries of the report that state the statistic.
nlohmann::ordered_json StatisticJson(const Arguments& a) {
  nlohmann::ordered_json json = {{"statistic", a.statistic}, {"order", a.order}};
  if (StatisticOf(a) == LensStatistic::kTrimmed) json["trim"] = a.trim;
  return json;
}

std::string ReportJson(const Arguments& a, const StatisticFrame& frame, const RayCounts& counts) {
  nlohmann::ordered_json report = {{"frame", frame.notes.frame.value}, {"files", a.outputs}};
  report.update(StatisticJson(a));
  report["lf_images"] = frame.image_count;
  report["lf_images_skipped"] = frame.skipped.size();
  report["parts"] = frame.part_count;
  report["rays_median"] = counts.median;
  report["rays_most"] = counts.most;
  report["seen_share"] = counts.seen_share;
  return RecordText(report);
}

// Returns the report of a film, with the entry "through".
std::string FilmJson(const Arguments& a, const RenderReport& film) {
  nlohmann::ordered_json report = nlohmann::ordered_json::parse(ToJson(film));
  report["through"] = StatisticJson(a);
  return RecordText(report);
}

// Makes the frame of --frame, and writes its files.
Result<void> RunFiles(const Arguments& a, const Program& program,
                      const LensStatisticOptions& options, const MissingLimit& limit) {
  std::vector<FrameFormat> formats;
  std::vector<PictureOptions> pictures;
  for (const std::string& output : a.outputs) {
    LF_ASSIGN_OR_RETURN(const FrameFormat format, FormatOf(a, output));
    formats.push_back(format);
    LF_ASSIGN_OR_RETURN(const PictureOptions picture, a.picture.Make(format));
    pictures.push_back(picture);
  }
  ThreadPool pool(program.common().threads);
  LF_ASSIGN_OR_RETURN(Opened opened, Open(a, false, *options.stop, pool));
  LF_ASSIGN_OR_RETURN(const std::vector<FileLock> locks,
                      LockOutputs({a.outputs.begin(), a.outputs.end()}));
  LF_RETURN_IF_ERROR(CheckOutputs(a, opened.light_field));  // another call may have ended just now
  LF_ASSIGN_OR_RETURN(const StatisticFrame frame,
                      MakeOne(a, std::move(opened), options, program.common(), pool));
  for (size_t i = 0; i < formats.size(); ++i)
    LF_RETURN_IF_ERROR(WritePicture(
        frame.notes, frame.picture, a.outputs[i], formats[i], pictures[i],
        [&] { return options.stop->load(); }, StatisticMetadata(options)));
  const RayCounts counts = CountsOf(frame.picture);
  LogInfo("{} of {} LF images, {} to {} rays in most elements{}", a.statistic, frame.image_count,
          counts.median, counts.most,
          frame.part_count > 1 ? fmt::format("; made in {} parts", frame.part_count) : "");
  if (program.common().json) LF_RETURN_IF_ERROR(PrintReport(ReportJson(a, frame, counts)));
  if (frame.skipped.empty()) return {};
  return EndWithMissing({frame.skipped.size(), frame.image_count,
                         fmt::format("{} of {} LF images were left out: {}", frame.skipped.size(),
                                     frame.image_count, frame.skipped.front().reason),
                         ""},
                        limit);
}

Result<FolderOptions> FolderOf(const Arguments& a) {
  FolderOptions folder;
  folder.output_folder = a.outputs.front();
  if (!a.HasPackages()) folder.inputs = FilesOfPath(a.frame.path);
  folder.inputs.emplace_back(a.light_field.path);
  folder.format = a.format == "auto" ? FrameFormat::kExrHalf : *ParseFrameFormat(a.format);
  LF_ASSIGN_OR_RETURN(folder.picture, a.picture.Make(folder.format));
  if (!a.video.empty()) folder.video = a.video;
  folder.contact_sheet = !a.no_contact_sheet;
  folder.resume = a.resume;
  folder.overwrite = a.overwrite;
  folder.version = Version();
  return folder;
}

// The source and the folder of the frames of a film, and the requests to its render.
struct FilmMaker {
  const LensStatisticOptions& statistic;
  const FolderOptions& folder;
  RenderSignals* signals;
  StatisticFilm* source;

  RenderOptions Options(const RadianceEncoding& encoding) const {
    RenderOptions options = RenderOptionsOf(statistic, encoding);
    options.folder = folder;
    options.signals = signals;
    options.source = source;
    return options;
  }
};

using Progress = std::function<void(const RenderProgress&)>;

// Renders the frames of --frames of PATH. Returns nullopt if no frame is left of them.
Result<std::optional<RenderReport>> RenderPath(const Arguments& a, const FilmMaker& film,
                                               ThreadPool& pool, const Progress& tell) {
  LF_ASSIGN_OR_RETURN(Opened opened, Open(a, true, film.signals->stop, pool));
  if (a.frames.IsNone(opened.frames)) return std::optional<RenderReport>();
  RenderOptions options = film.Options(opened.light_field.encoding);
  options.frames = opened.frames;
  LF_ASSIGN_OR_RETURN(Package package, PackageOfFilm(std::move(opened.light_field),
                                                     std::move(opened.path), options, pool));
  LF_ASSIGN_OR_RETURN(RenderReport report, Render(std::move(package), options, pool, tell));
  return std::optional<RenderReport>(std::move(report));
}

// Renders the frames of --frames that the packages have.
Result<std::optional<RenderReport>> RenderPackageFiles(const Arguments& a, const FilmMaker& film,
                                                       ThreadPool& pool, const Progress& tell) {
  LF_ASSIGN_OR_RETURN(const LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(const LightFieldPlace place, PlaceOf(a.light_field.path, light_field));
  LF_ASSIGN_OR_RETURN(PackagedFilm packages, OpenPackages({a.paths.begin(), a.paths.end()}, place));
  RenderOptions options = film.Options(packages.first.light_field.encoding);
  LF_ASSIGN_OR_RETURN(options.frames, a.frames.Of(packages.first.path.frames()));
  if (a.frames.IsNone(options.frames)) return std::optional<RenderReport>();
  LF_ASSIGN_OR_RETURN(RenderReport report,
                      RenderPackages(std::move(packages), options, pool, tell));
  return std::optional<RenderReport>(std::move(report));
}

// Makes the frames of --frames in a folder.
Result<void> RunFilm(const Arguments& a, const Program& program,
                     const LensStatisticOptions& statistic, RenderSignals* signals,
                     const MissingLimit& limit, int argc, char** argv) {
  const CommonOptions& common = program.common();
  const EndsSoon without_checkpoints;
  LF_ASSIGN_OR_RETURN(const FolderOptions folder, FolderOf(a));
  StatisticFilm source(statistic);
  const FilmMaker film = {statistic, folder, signals, &source};
  ThreadPool pool(common.threads);
  ProgressMeter meter(ParseProgressStyle(common.progress), "px");
  const auto tell = [&](const RenderProgress& now) {
    meter.Update(now.ray_count, now.ray_total,
                 {{"LF image", now.image_count, now.image_total},
                  {"frame", now.frame_count, now.frame_total}});
  };
  const bool has_packages = a.HasPackages();
  const auto report = (has_packages ? RenderPackageFiles : RenderPath)(a, film, pool, tell);
  if (!report) return WithResumeCommand(report.error(), argc, argv);
  if (!*report) {
    a.frames.TellNone();
    return common.json ? PrintReport(FilmJson(a, RenderReport())) : Result<void>();
  }
  fs::path look_at = a.outputs.front();
  if (!a.no_contact_sheet)
    look_at /= has_packages ? ContactSheetName({a.paths.begin(), a.paths.end()}) : kContactSheet;
  SummariseRender(**report, look_at.string(), false);
  if (common.json) LF_RETURN_IF_ERROR(PrintReport(FilmJson(a, **report)));
  return EndOfRender(**report, limit, {});
}

Result<void> Run(const Arguments& a, const Program& program, const Given& given, int argc,
                 char** argv) {
  LF_ASSIGN_OR_RETURN(const bool has_folder, HasFolder(a, given));
  LF_RETURN_IF_ERROR(CheckPaths(a, has_folder));
  LF_ASSIGN_OR_RETURN(const MissingLimit limit, a.allow_missing.Limit());
  LF_ASSIGN_OR_RETURN(LensStatisticOptions options, OptionsOf(a, program.common(), given));
  if (has_folder) return RunFilm(a, program, options, &CatchRenderSignals(), limit, argc, argv);
  options.stop = &CatchInterrupts();
  return RunFiles(a, program, options, limit);
}

}  // namespace

int RunFocusThrough(int argc, char** argv) {
  Program program("lffocus through", kHelp);
  Arguments arguments;
  arguments.AddTo(program.app());
  program.AddCommonOptions({.threads = true,
                            .strict = "A broken LF image is an error (it is left out)",
                            .json = "Print what was made as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  return program.Run(argc - 1, argv + 1, [&] {
    const Given given = {program.app().count("--frame") > 0, program.app().count("--trim") > 0};
    arguments.frame.path = arguments.paths.front();
    return Run(arguments, program, given, argc, argv);
  });
}

}  // namespace lf
