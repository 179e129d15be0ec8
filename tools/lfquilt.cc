// SPDX-License-Identifier: Apache-2.0
// lfquilt FRAMES... -o OUT: joins the rendered views of stereo films and light field displays.
#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"

#include "lf/core/log.h"
#include "lf/film/develop/quilt_devices.h"
#include "lf/film/develop/video.h"
#include "lf/film/develop/view_film.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfquilt"),
    .usage = "  lfquilt FRAMES... -o OUT [OPTIONS]",
    .examples =
        R"(  lfpath path.yaml -o views.yaml --quilt 8x6       # cameras of the views
  lfrenderer capture/ views.yaml -o views
  lfquilt views -o film.mp4 --views 8x6            # film_qs8x6a0.75.mp4
  lfquilt views -o film.exr --views 8x6            # film_0001_qs8x6a0.75.exr, ...
  lfquilt stereo -o film.mp4 --layout side-by-side)",
    .details =
        R"(FRAMES are the frames of a path that lfpath made with --stereo or --quilt: all views of the first
moment, then those of the second, and so on. doc/stereo.md tells the layouts and the names of files.

Pictures have the format of the frames: 8 or 16 bit in PNG files, half or float in EXR files, with the
same primaries. PNG files of EXR frames are 8-bit sRGB, composited over black, as videos are. EXR
files have the channels R, G, B and, if the frames have it, A; channels that describe a single view,
such as counts, are left out. left-right copies whole frames. Videos are 8-bit sRGB (H.264), as those
of lfrenderer.

Everything is checked before the first file is written: a missing view, and views of other sizes or
colours, are errors. A file appears under its name when it is complete. After an interruption,
--resume writes what is missing. The program needs the memory of one joined picture, 12 or 16
bytes for a pixel of EXR files, of its encoded file, and of one view for every thread.)",
};

struct Arguments {
  std::vector<std::string> frames;
  std::string output, layout = "quilt";
  std::optional<std::pair<int, int>> views;  // columns, rows
  std::optional<std::pair<int, int>> tile;   // width, height
  std::string device;
  std::optional<double> fps;
  bool resume = false, overwrite = false;
};

void AddOptions(CLI::App& app, Arguments& a) {
  lf::OptionGroup input(app, lf::kInputGroup), output(app, lf::kOutputGroup);
  lf::OptionGroup running(app, lf::kRunningGroup);
  input
      .Add("FRAMES", a.frames,
           "Folder of the frames, or their files in order\n"
           "Of a folder, the files frame_0001.png or frame_0001.exr and so on are taken.")
      ->required()
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles(".png .exr folder"));
  output
      .Add("-o,--output OUT", a.output,
           "Picture or video to write: NAME.png, .exr or .mp4\n"
           "A film of several moments becomes NAME_0001.png and so on, or one video. The name of a "
           "quilt gets its description, such as NAME_qs8x6a0.75.mp4, from which light field "
           "displays "
           "know columns, rows and the width of a view divided by its height.")
      ->required()
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles(".png .exr .mp4"));
  output.AddChoice("--layout", a.layout,
                   {"quilt", "side-by-side", "over-under", "anaglyph", "left-right"},
                   "How views are joined\n"
                   "quilt: tiles, from the lower left to the right and upwards\n"
                   "side-by-side: the view of the left eye is on the left\n"
                   "over-under: the view of the left eye is above\n"
                   "anaglyph: red of the left eye's view, green and blue of the right eye's\n"
                   "left-right: files of their own, NAME_left and NAME_right");
  auto* views =
      output
          .Add("--views CxR", a.views,
               "Columns and rows of a quilt\n"
               "As for lfpath --quilt. Required for quilts, unless --device states it; the other "
               "layouts have two views.")
          ->delimiter('x')
          ->check(CLI::Range(1, 1000));
  auto* tile = output
                   .Add("--tile WxH", a.tile,
                        "Size of a tile of a quilt, in pixels (as the frames)\n"
                        "Whole views are squeezed into tiles of another aspect, as light field "
                        "displays expect. The name of the quilt keeps the aspect of the views.")
                   ->delimiter('x')
                   ->check(CLI::Range(1, 65536));
  output
      .Add("--device NAME", a.device,
           "Make the quilt of this Looking Glass display\n"
           "NAME: portrait, go, 16-landscape, 16-portrait, 32-landscape, 32-portrait or 65. "
           "It decides --views and --tile, by the settings of the maker (doc/stereo.md). The "
           "frames must be those of lfpath --device. For a video, tiles have even sizes.")
      ->check(CLI::IsMember(lf::NamesOfQuiltDevices()))
      ->excludes(views)
      ->excludes(tile);
  output
      .Add("--fps RATE", a.fps,
           "Frames per second of a video (as the frames state, else 30)\n"
           "A number, or a fraction such as 24000/1001.")
      ->transform(lf::Rate())
      ->check(CLI::Range(1e-3, 1e6));
  auto* resume = running.AddFlag(
      "--resume", a.resume,
      "Keep the files that exist, write the others\n"
      "A file that exists must be of the same frames and options: a file states what "
      "it was made of.");
  running.AddFlag("--overwrite", a.overwrite, "Replace the files that exist")->excludes(resume);
}

// Returns the options; kUsage if --views does not fit the layout.
lf::Result<lf::ViewFilmOptions> OptionsOf(const Arguments& a) {
  lf::ViewFilmOptions options;
  options.layout = *lf::ParseViewLayout(a.layout);
  const bool is_quilt = options.layout == lf::ViewLayout::kQuilt;
  if (is_quilt && !a.views && a.device.empty())
    return lf::UsageError(
        "--layout quilt needs --views CxR, the columns and rows that lfpath --quilt was given, or "
        "--device; give one of them, or choose another layout");
  if (!is_quilt && (a.tile || !a.device.empty()))
    return lf::UsageError(fmt::format(
        "--{} can only be used with --layout quilt, because the other layouts keep the size of "
        "views: leave it out",
        a.tile ? "tile" : "device"));
  if (!is_quilt && a.views)
    return lf::UsageError(fmt::format(
        "--views {}x{} can only be used with --layout quilt, because --layout {} has two views: "
        "leave it out",
        a.views->first, a.views->second, a.layout));
  if (a.views) options.grid = {a.views->first, a.views->second};
  if (a.tile) options.tile = lf::ViewSize{a.tile->first, a.tile->second};
  if (!a.device.empty()) {
    const lf::QuiltDevice& device = lf::QuiltDeviceNamed(a.device);
    lf::ViewSize tile = device.tile();
    if (lf::IsVideoName(a.output)) tile = {tile.width / 2 * 2, tile.height / 2 * 2};
    options.grid = device.grid;
    options.tile = tile;
    options.aspect = device.aspect();
  }
  options.output = a.output;
  options.fps = a.fps;
  options.resume = a.resume;
  options.overwrite = a.overwrite;
  return options;
}

std::string ToJson(const lf::ViewFilmReport& report) {
  nlohmann::json json = {{"moments", report.moment_count},
                         {"views", report.view_count},
                         {"resolution", {report.width, report.height}},
                         {"kept", report.kept_count},
                         {"files", nlohmann::json::array()}};
  if (report.fps) json["fps"] = *report.fps;
  for (const std::filesystem::path& file : report.files) json["files"].push_back(file.string());
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

lf::Result<void> Run(const Arguments& a, const lf::CommonOptions& common) {
  LF_ASSIGN_OR_RETURN(lf::ViewFilmOptions options, OptionsOf(a));
  const std::atomic<bool>& is_interrupted = lf::CatchInterrupts();
  options.is_interrupted = [&] { return is_interrupted.load(); };
  lf::ThreadPool pool(common.threads);
  lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "views");
  const std::vector<std::filesystem::path> frames(a.frames.begin(), a.frames.end());
  LF_ASSIGN_OR_RETURN(const lf::ViewFilmReport report,
                      lf::WriteViewFilm(frames, options, pool, [&](size_t done, size_t total) {
                        meter.Update(done, total, "");
                      }));
  const size_t count = report.files.size();
  lf::LogInfo("{}{}{}: {} x {} pixels, {} view{} of {} moment{}", report.files.front().string(),
              count > 1 ? " to " : "", count > 1 ? report.files.back().string() : "", report.width,
              report.height, report.view_count, report.view_count == 1 ? "" : "s",
              report.moment_count, report.moment_count == 1 ? "" : "s");
  if (report.kept_count > 0)
    lf::LogInfo("{} of {} files existed and were kept", report.kept_count, count);
  if (common.json) return lf::PrintReport(ToJson(report));
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfquilt", kHelp);
  AddOptions(program.app(), arguments);
  program.AddCommonOptions({.threads = true,
                            .json = "Print the report to stdout as JSON",
                            .progress = true,
                            .quiet = true});
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
