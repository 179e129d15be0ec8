// lfvisualizer LIGHTFIELD PATH.yaml: shows what was captured and what a camera path needs of it.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/interrupt.h"
#include "tools/common/light_field_argument.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/visualizer/export_page.h"
#include "tools/visualizer/page_server.h"

#include "lf/core/log.h"
#include "lf/path/path_yaml.h"
#include "lf/pipeline/frame_range.h"
#include "lf/visualizer/scene_text.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfvisualizer capture/ path.yaml                          # open the address that it prints
  lfvisualizer capture/ path.yaml --watch frames           # with the render that lfrenderer writes there
  lfvisualizer capture/ path.yaml packages/*.lfp --serve 8080
  lfvisualizer capture/ path.yaml --export site            # as files for any web server
  lfvisualizer capture/ path.yaml --text > scene.txt

The page is served to this machine alone, at an address with a secret in it, until Ctrl-C. From
elsewhere: ssh -L 8080:127.0.0.1:8080 HOST, with --serve 8080.

--text prints lines of words, in world units:
  lf_camera ID X Y Z              every LF camera, from 0
  render_camera FRAME X Y Z       every frame asked for
  collected FRAME ID SHARE        what the frame collects from: LF cameras, and the share of their pixels)";

struct Arguments {
  lf::LightFieldArgument light_field;
  lf::PageArguments page;
  std::string path, watch, frames, export_folder;
  int port = 0;
  uint64_t max_images = 0, export_images = 400;
  bool text = false;
  lf::AllowMissing allow_missing;
};

void AddOptions(CLI::App& app, Arguments& a) {
  a.light_field.AddTo(app);
  app.add_option("PATH", a.path, "Camera path (doc/formats/path.md)")->required();
  app.add_option("PACKAGE", a.page.packages, "Packages that lfpreprocessor has made of it");
  auto* text =
      app.add_flag("--text", a.text, "Print LF cameras, render cameras and collected LF cameras");
  app.add_option("--frames", a.frames, "Only these frames: 1-100x2, 7, 3-5,9")
      ->needs(text)
      ->check(lf::NotEmpty());
  auto* serve = app.add_option("--serve", a.port, "Port of the page; 0: any that is free")
                    ->excludes(text)
                    ->check(CLI::Range(0, 65535));
  auto* watch =
      app.add_option("--watch", a.watch, "DIR of an lfrenderer: show its frames as they grow")
          ->excludes(text)
          ->check(lf::NotEmpty());
  auto* to_files = app.add_option("--export", a.export_folder,
                                  "Write the page and its data into a new folder, and end")
                       ->excludes(text)
                       ->excludes(serve)
                       ->excludes(watch)
                       ->check(lf::NotEmpty());
  app.add_option("--export-images", a.export_images,
                 "The most LF images that go with it, of those that frames take")
      ->needs(to_files)
      ->capture_default_str();
  a.allow_missing.AddTo(app, "those that go with the export")->needs(to_files);
  app.add_option("--max-images", a.max_images, "As of lfrenderer; 0: all")
      ->check(lf::WholeNumber());
  app.add_option("--max-angle", a.page.max_angle_deg, "As of lfpreprocessor, degrees; 0: any")
      ->check(CLI::Range(0.0, 180.0));
  app.add_option("--estimator", a.page.estimator, "As of lfrenderer")
      ->check(CLI::IsMember({"bilinear", "nearest"}));
  app.add_option("--lens-weights", a.page.lens_weights, "As of lfrenderer")
      ->check(CLI::IsMember({"auto", "none", "area", "hat"}));
}

lf::NeedsOptions Needs(const Arguments& a) {
  lf::NeedsOptions needs;
  if (a.page.estimator == "bilinear") needs.select.reach = lf::PixelReach::kNeighbours;
  if (a.page.max_angle_deg > 0)
    needs.select.max_angle_rad = lf::RadiansFromDegrees(a.page.max_angle_deg);
  for (const lf::LensWeights weights : {lf::LensWeights::kNone, lf::LensWeights::kAuto,
                                        lf::LensWeights::kArea, lf::LensWeights::kHat})
    if (a.page.lens_weights == lf::NameOf(weights)) needs.lens_weights = weights;
  if (a.max_images > 0) needs.max_image_count = a.max_images;
  return needs;
}

lf::Result<void> PrintText(const Arguments& a, const lf::CommonOptions& common) {
  LF_ASSIGN_OR_RETURN(const lf::LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(const lf::CameraPath path, lf::ReadPathYaml(a.path, light_field.unit_m));
  LF_ASSIGN_OR_RETURN(
      const std::vector<lf::FrameId> frames,
      lf::ParseFrameRange(a.frames.empty() ? fmt::format("1-{}", path.frame_count()) : a.frames,
                          path.frame_count()));
  lf::ThreadPool pool(common.threads);
  return lf::WriteSceneText(light_field, path, frames, common.seed, Needs(a), pool,
                            lf::PrintReport);
}

lf::MissingImages MissingOf(const lf::ExportFacts& facts) {
  return {facts.missing_count, facts.image_count,
          fmt::format("{} of {} LF images are not in the export, since they are missing or broken; "
                      "the first: {}",
                      facts.missing_count, facts.image_count, facts.first_missing),
          "once they are mended, export again"};
}

lf::Result<void> Run(Arguments& a, const lf::CommonOptions& common) {
  if (a.text && !a.page.packages.empty())
    return lf::UsageError("--text tells what a path takes of a light field: leave packages out");
  if (a.text) return PrintText(a, common);
  LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, a.allow_missing.Limit());
  const std::atomic<bool>& interrupted = lf::CatchInterrupts();
  a.page.light_field = a.light_field.path;
  a.page.light_field_options = a.light_field.Words();
  a.page.path = a.path;
  a.page.watch = a.watch;
  a.page.needs = Needs(a);
  a.page.seed = common.seed;
  a.page.threads = common.threads;
  LF_ASSIGN_OR_RETURN(lf::LightField light_field, a.light_field.Open());
  LF_ASSIGN_OR_RETURN(const auto scene, lf::PageScene::Open(std::move(light_field), a.page));
  if (!a.export_folder.empty()) {
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "steps");
    LF_ASSIGN_OR_RETURN(
        const lf::ExportFacts facts,
        lf::ExportPage(*scene, a.export_folder, a.export_images, interrupted,
                       [&](size_t done, size_t total) { meter.Update(done, total, "exporting"); }));
    LF_RETURN_IF_ERROR(lf::PrintReport(
        fmt::format("{}: {} files, {}B, {} LF images\n", a.export_folder, facts.file_count,
                    lf::ShortNumber(static_cast<double>(facts.byte_count)),
                    facts.image_count - facts.missing_count)));
    return lf::EndWithMissing(MissingOf(facts), limit);
  }
  LF_ASSIGN_OR_RETURN(const auto server, lf::PageServer::Open(*scene, a.port));
  LF_RETURN_IF_ERROR(lf::PrintReport(server->address() + "\n"));
  lf::LogInfo("open this address in a browser; Ctrl-C ends");
  return server->ServeUntil(interrupted);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfvisualizer", "Shows what was captured and what a camera path needs of it.",
                      kExamples);
  program.AddCommonOptions({.threads = true,
                            .seed = "Seed of the order of the LF images",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});
  AddOptions(program.app(), arguments);
  return program.Run(argc, argv, [&] { return Run(arguments, program.common()); });
}
