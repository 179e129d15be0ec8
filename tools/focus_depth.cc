// SPDX-License-Identifier: Apache-2.0
#include "tools/focus_depth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/frame_options.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"
#include "tools/focus_frame.h"

#include "lf/analysis/depth/depth_files.h"
#include "lf/analysis/depth/depth_map.h"
#include "lf/analysis/focus_stack/focus_planes.h"
#include "lf/core/log.h"
#include "lf/core/output_files.h"
#include "lf/core/quantities.h"
#include "lf/core/version.h"
#include "lf/film/develop/frame_file.h"
#include "lf/import/paths/open_path.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/develop_frame.h"
#include "lf/render/pipeline/frame_metadata.h"
#include "lf/render/state/record_fields.h"
#include "lf/selection/image_index.h"
#include "lf/storage/load/open_store.h"

namespace lf {
namespace {

constexpr const char* kMethod =
    R"(The camera is that of one frame of PATH. The LF images behind its lens are compared at many distances
(a plane sweep): where they agree, there is a surface. The wider the lens, the finer the depths; a
lens with fewer than 12 LF cameras is widened. Surfaces without texture, beyond --near and --far, or
seen by too few LF cameras have no depth. An element
has no depth either if most elements of its colour around it have none or another one: a border
beside it may belong to another surface. Virtual LF images are left out.

A densified store (lfdensify) has the depths of recorded LF images. With --from store, they are used
in place of a comparison: if LF cameras are far apart, many more elements have a depth, also on
surfaces without texture, where it may be wrong.)";

const HelpTexts kDepthHelp = {
    .summary = "Finds the depth of every element of a frame.",
    .usage = R"(  lffocus depth LIGHTFIELD PATH -o FILE [-o FILE...] [OPTIONS])",
    .examples = R"(  lffocus depth capture/ path.yaml -o depth.exr
  lffocus depth capture/ path.yaml --frame 12 -o depth.pfm -o points.ply -o depth.png
  lffocus depth capture/ path.yaml -o depth.exr --near 0.4 --far 2 --planes 100 --fill)",
    .details = kMethod,
};

const HelpTexts kSharpHelp = {
    .summary = "Makes a picture in which everything is in focus.",
    .usage = R"(  lffocus sharp LIGHTFIELD PATH -o FILE [OPTIONS])",
    .examples = R"(  lffocus sharp capture/ path.yaml -o sharp.exr
  lffocus sharp capture/ path.yaml --frame 12 -o sharp.png --near 400mm --far 2)",
    .details =
        R"(Every element is focused at its own depth, which is found as lffocus depth finds it. The light is that
of a pinhole, interpolated between the LF cameras around it. Elements whose depth is not known take
the depths of those around them.)",
};

struct DepthArguments {
  LightFieldArgument light_field;
  FrameArgument frame;
  std::string near, far, memory = "8G";
  std::vector<std::string> outputs;
  size_t planes = 0, views = 200;
  int window = 5;
  double confidence = 0.5;
  std::string from = "sweep";
  bool fill = false, clean = false, overwrite = false;
  AllowMissing allow_missing;
};

void AddInput(CLI::App& app, DepthArguments& a) {
  a.light_field.AddTo(app);
  a.light_field.AddReduceTo(app);
  OptionGroup input(app, kInputGroup);
  a.frame.AddTo(input);
  a.allow_missing.AddTo(app, "the LF images that are compared");
}

void AddSweep(CLI::App& app, DepthArguments& a) {
  OptionGroup sweep(app, kPictureGroup);
  sweep.AddChoice("--from", a.from, {"sweep", "store"},
                  "Where depths come from\n"
                  "sweep: LF images are compared. store: LIGHTFIELD is a densified store, and the "
                  "12 LF images nearest to the camera vote with the depths that it has of them; "
                  "the options of the comparison cannot be given.");
  sweep
      .Add("--planes N", a.planes,
           "Number of distances that are tested (by the lens)\n"
           "They are even in 1 / distance. By the lens: so many that a point moves by at most half "
           "an element in the outermost LF images from one distance to the next, from 8 to 256.")
      ->check(CLI::Range(size_t{2}, kMostDepthPlanes));
  sweep
      .Add(
          "--near DISTANCE", a.near,
          "Nearest distance that is tested (found)\n"
          "In world units, such as 0.4, or in millimetres, such as 400mm. Found: the nearest depth "
          "of the scene that the light field states; if it states none, LF images are compared.")
      ->check(NotEmpty());
  sweep
      .Add("--far DISTANCE", a.far,
           "Farthest distance that is tested (found)\n"
           "As --near.")
      ->check(NotEmpty());
  sweep
      .Add("--views N", a.views,
           "Largest number of LF images that are compared\n"
           "They are spread evenly over the lens.")
      ->check(CLI::Range(3, 4096));
  sweep
      .Add(
          "--window N", a.window,
          "Width of the windows over which LF images are compared\n"
          "An odd number of elements. Wider windows are less disturbed by noise, and blur borders.")
      ->check(CLI::Range(1, 33));
  sweep
      .Add("--confidence X", a.confidence,
           "Least confidence of a depth, from 0 to 1\n"
           "How much better the LF images agree at this depth than at others.")
      ->check(CLI::Range(0.0, 1.0));
  sweep.AddFlag(
      "--clean", a.clean,
      "Mend wrong and missing depths by the colours around them\n"
      "They become the median of the depths of the elements of their colour around them, if "
      "most of these have about the same depth. Edges stay sharp, and large places without "
      "texture stay unknown.");
}

void AddRunning(CLI::App& app, DepthArguments& a) {
  OptionGroup running(app, kRunningGroup);
  running
      .Add("--memory SIZE", a.memory,
           "Memory of the LF images, such as 8G\n"
           "If they take more, the frame is made in parts, and LF images are read once for each.")
      ->check(NotEmpty());
  running.AddFlag("--overwrite", a.overwrite, "Replace files that exist");
}

Result<void> CheckOutputs(const DepthArguments& a, const LightField& light_field) {
  // Inputs come first, because --overwrite does not replace them.
  std::vector<std::filesystem::path> inputs = FilesOfLightField(light_field, a.light_field.path);
  for (std::filesystem::path& file : FilesOfPath(a.frame.path)) inputs.push_back(std::move(file));
  LF_RETURN_IF_ERROR(CheckOutputFiles({a.outputs.begin(), a.outputs.end()}, inputs));
  for (const std::string& output : a.outputs) {
    std::error_code error;
    if (!a.overwrite && std::filesystem::exists(output, error))
      return UsageError(fmt::format(
          "{}: exists already: give another name, or replace it with --overwrite", output));
  }
  return {};
}

Result<DepthRange> RangeOf(const DepthArguments& a, const LightField& light_field,
                           const RenderCamera& camera, ThreadPool& pool) {
  std::optional<double> near_w, far_w;
  if (!a.near.empty()) {
    LF_ASSIGN_OR_RETURN(near_w, ParseFocusDistance(a.near, "--near", camera.unit_m));
  }
  if (!a.far.empty()) {
    LF_ASSIGN_OR_RETURN(far_w, ParseFocusDistance(a.far, "--far", camera.unit_m));
  }
  Result<DepthRange> range = RangeToSweep(light_field, camera, near_w, far_w, pool);
  if (!range && range.error().kind == ErrorKind::kInput)
    return Error{ErrorKind::kInput, range.error().message + ", by --near and --far"};
  return range;
}

struct Made {
  DepthMap map;
  DevelopedFrame picture;
  std::vector<FileLock> locks;  // of the outputs
};

Result<Made> Make(const DepthArguments& a, const CommonOptions& common, ThreadPool& pool,
                  const std::atomic<bool>& interrupted) {
  LF_RETURN_IF_ERROR(a.allow_missing.Limit());
  const DepthArguments defaults;
  if (a.from == "store" &&
      (a.planes != defaults.planes || a.near != defaults.near || a.far != defaults.far || a.clean ||
       a.window != defaults.window || a.views != defaults.views))
    return UsageError(
        "--from store: LF images are not compared: leave out --planes, --near, --far, --views, "
        "--window and --clean");
  if (a.window % 2 == 0)
    return UsageError(fmt::format("--window {}: expected an odd number of elements", a.window));
  DepthMapOptions options;
  LF_ASSIGN_OR_RETURN(options.memory_bytes, ParseByteSize(a.memory, "--memory"));
  LF_ASSIGN_OR_RETURN(const LightField light_field, a.light_field.Open());
  LF_RETURN_IF_ERROR(CheckOutputs(a, light_field));
  Made made;
  LF_ASSIGN_OR_RETURN(made.locks, LockOutputs({a.outputs.begin(), a.outputs.end()}));
  LF_RETURN_IF_ERROR(CheckOutputs(a, light_field));  // another call may have ended just now
  LF_ASSIGN_OR_RETURN(const CameraPath path,
                      a.frame.Open(light_field, PathOptions::Surface::kName));
  const FrameId id = a.frame.IdIn(path);
  const RenderCamera& camera = path.Camera(id);
  options.from_store = a.from == "store";
  if (!options.from_store) {
    LF_ASSIGN_OR_RETURN(options.range, RangeOf(a, light_field, camera, pool));
  }
  options.plane_count = a.planes;
  options.window_radius = a.window / 2;
  options.least_confidence = a.confidence;
  options.clean = a.clean;
  options.most_views = a.views;
  options.strict = common.strict;
  options.stop = &interrupted;
  LF_ASSIGN_OR_RETURN(
      const std::unique_ptr<LfImageStore> store,
      OpenStore(light_field, Mosaics::kToRgb,
                options.from_store ? StoreContent::kPixelsAndDepths : StoreContent::kPixels));
  const ImageIndex index(light_field);
  ProgressMeter meter(ParseProgressStyle(common.progress), "elements");
  const auto total = static_cast<uint64_t>(camera.pinhole.intrinsics.width_px) *
                     static_cast<uint64_t>(camera.pinhole.intrinsics.height_px);
  std::mutex mutex;
  LF_ASSIGN_OR_RETURN(made.map,
                      MakeDepthMap(index, *store, id, camera, options, pool, [&](double share) {
                        const std::lock_guard lock(mutex);
                        meter.Update(static_cast<uint64_t>(share * static_cast<double>(total)),
                                     total, std::string("depth"));
                      }));
  made.map.notes.fps = path.fps;
  made.map.notes.first_frame = path.first_frame;
  made.map.notes.version = Version();
  made.picture = DevelopFrame(made.map.notes, made.map.sharp, nullptr, false, pool, {}).picture;
  return made;
}

double KnownShare(const DepthMap& map) {
  return static_cast<double>(map.known_count) / (map.depth_w.width() * map.depth_w.height());
}

// Returns the number of distances that were tested, without one at either end.
size_t PlaneCount(const DepthMap& map) {
  return map.planes_w.empty() ? 0 : map.planes_w.size() - 2;
}

std::string ReportJson(const DepthArguments& a, const Made& made) {
  nlohmann::ordered_json report = {{"frame", made.map.notes.frame.value},
                                   {"files", a.outputs},
                                   {"from", a.from},
                                   {"near_w", made.map.range.near_w},
                                   {"far_w", made.map.range.far_w},
                                   {"planes", PlaneCount(made.map)},
                                   {"lf_images_compared", made.map.view_count},
                                   {"lf_images_skipped", made.map.skipped.size()},
                                   {"known_share", KnownShare(made.map)}};
  return RecordText(report);
}

// Returns the error of a map in which no element has a depth.
Error NothingKnown(const DepthArguments& a, const DepthMap& map) {
  constexpr size_t kShare = 10;  // every kShare-th element is surer
  std::vector<float> sure(map.confidence.pixels().begin(), map.confidence.pixels().end());
  const auto tenth = sure.begin() + static_cast<std::ptrdiff_t>(sure.size() / kShare);
  std::nth_element(sure.begin(), tenth, sure.end(), std::greater<>());
  return Error{
      ErrorKind::kBelowRequired,
      fmt::format("no element has a depth (the files are written): 0 of {} are sure enough, and a "
                  "tenth of them reaches a confidence of {:.2f}. Give the distances of the scene "
                  "by --near and --far, or accept less sure depths by --confidence{}{}",
                  sure.size(), *tenth, a.overwrite ? "" : ", and add --overwrite",
                  map.skipped.empty()
                      ? ""
                      : fmt::format("; {} of {} LF images were broken: {}", map.skipped.size(),
                                    map.view_count, map.skipped.front().reason))};
}

// Tells what was made, and decides about LF images that were left out.
Result<void> Finish(const DepthArguments& a, const CommonOptions& common, const Made& made) {
  const DepthMap& map = made.map;
  if (a.from == "store")
    LogInfo(
        "{}: has the depths of {} LF images near the camera, which were used in place of a sweep: "
        "from {:.6g} to {:.6g} world units; {:.1f} % of the elements have a depth",
        a.light_field.path, map.view_count, map.range.near_w, map.range.far_w,
        100 * KnownShare(map));
  else
    LogInfo(
        "{} LF images compared at {} distances from {:.6g} to {:.6g} world units; {:.1f} % of the "
        "elements have a depth",
        map.view_count, PlaneCount(map), map.range.near_w, map.range.far_w, 100 * KnownShare(map));
  if (common.json) LF_RETURN_IF_ERROR(PrintReport(ReportJson(a, made)));
  if (map.known_count == 0) return NothingKnown(a, map);
  if (map.skipped.empty()) return {};
  LF_ASSIGN_OR_RETURN(const MissingLimit limit, a.allow_missing.Limit());
  return EndWithMissing({map.skipped.size(), map.view_count,
                         fmt::format("{} of {} LF images were left out: {}", map.skipped.size(),
                                     map.view_count, map.skipped.front().reason),
                         ""},
                        limit);
}

Result<void> RunDepth(const DepthArguments& a, const Program& program) {
  for (const std::string& output : a.outputs)
    if (!DepthFormatOf(output))
      return UsageError(
          fmt::format("-o {}: expected a name that ends in .exr, .pfm, .ply or .png", output));
  const std::atomic<bool>& interrupted = CatchInterrupts();
  ThreadPool pool(program.common().threads);
  LF_ASSIGN_OR_RETURN(const Made made, Make(a, program.common(), pool, interrupted));
  for (const std::string& output : a.outputs)
    LF_RETURN_IF_ERROR(WriteDepth(output, made.map, made.picture, a.fill));
  return Finish(a, program.common(), made);
}

Result<void> RunSharp(const DepthArguments& a, const Program& program) {
  const std::filesystem::path output = a.outputs.front();
  const bool is_png = output.extension() == ".png";
  if (!is_png && output.extension() != ".exr")
    return UsageError(
        fmt::format("-o {}: expected a name that ends in .exr or .png", output.string()));
  const std::atomic<bool>& interrupted = CatchInterrupts();
  ThreadPool pool(program.common().threads);
  LF_ASSIGN_OR_RETURN(const Made made, Make(a, program.common(), pool, interrupted));
  const FrameFormat format = is_png ? FrameFormat::kPng8 : FrameFormat::kExrHalf;
  LF_RETURN_IF_ERROR(WriteFrame(output, made.picture, format,
                                FileMetadata(made.map.notes, format, ColourSpace::kRec709)));
  return Finish(a, program.common(), made);
}

constexpr OfferedOptions kCommon = {.threads = true,
                                    .strict = "A broken LF image is an error (it is left out)",
                                    .json = "Print what was made as JSON",
                                    .progress = true,
                                    .verbose = true,
                                    .quiet = true};

}  // namespace

int RunFocusDepth(int argc, char** argv) {
  Program program("lffocus depth", kDepthHelp);
  DepthArguments a;
  AddInput(program.app(), a);
  OptionGroup output(program.app(), kOutputGroup);
  output
      .Add("-o,--output FILE", a.outputs,
           "File to write; may be repeated\n"
           ".exr: the sharp picture, the depth Z and its confidence; .pfm: Z; .ply: points with "
           "colours; .png: a picture of 1 / Z. Z is in world units along the optical axis, and "
           "infinite where it is not known.")
      ->required()
      ->check(NotEmpty())
      ->check(TakesFiles(".exr .pfm .ply .png"));
  output.AddFlag("--fill", a.fill,
                 "Also give elements without a depth one\n"
                 "It is a mean of the depths around them.");
  AddSweep(program.app(), a);
  AddRunning(program.app(), a);
  program.AddCommonOptions(kCommon);
  return program.Run(argc - 1, argv + 1, [&] { return RunDepth(a, program); });
}

int RunFocusSharp(int argc, char** argv) {
  Program program("lffocus sharp", kSharpHelp);
  DepthArguments a;
  AddInput(program.app(), a);
  OptionGroup output(program.app(), kOutputGroup);
  std::string file;
  output.Add("-o,--output FILE", file, "File to write: .exr, or .png in sRGB")
      ->required()
      ->check(NotEmpty())
      ->check(TakesFiles(".exr .png"));
  AddSweep(program.app(), a);
  AddRunning(program.app(), a);
  program.AddCommonOptions(kCommon);
  return program.Run(argc - 1, argv + 1, [&] {
    a.outputs = {file};
    return RunSharp(a, program);
  });
}

}  // namespace lf
