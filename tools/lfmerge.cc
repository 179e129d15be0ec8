// SPDX-License-Identifier: Apache-2.0
// lfmerge PLATES... -o DIR: adds the plates of a divided render and writes its frames.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/frame_options.h"
#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/programs.h"
#include "tools/common/progress.h"
#include "tools/common/validators.h"
#include "tools/render_end.h"

#include "lf/core/log.h"
#include "lf/import/formats/open_light_field.h"
#include "lf/light_field/model/image_files.h"
#include "lf/render/pipeline/merge_shards.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfmerge"),
    .usage = "  lfmerge PLATES... -o DIR [OPTIONS]",
    .examples =
        R"(  lfrenderer capture/ path.yaml -o frames --frames 7 --shard 1/3   # and 2/3, 3/3 elsewhere
  lfmerge frames/partial/shards -o frames
  lfmerge a/partial/shards b/partial/shards -o frames --video film.mp4
  lfrenderer capture/ path.yaml -o frames --keep-plates            # plates beside the frames
  lfmerge frames/*.plate -o again --format png16                   # in another format)",
    .details =
        R"(The frames are bit-identical to those of a render that was not divided. The order of the plates does
not matter. The heads of all plates are read first: a missing shard is reported before the plates are
added. The program needs the memory of one frame. It keeps the plates. The exit code is 6 if the
renders left out LF images because they were missing or broken.)",
};

// Returns the image files of the light field in the folder of the frames, if there is one. They
// must not be overwritten, and the plates do not state where they are.
std::vector<std::filesystem::path> LfImagesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> images;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return images;
  const lf::Result<lf::LightField> light_field = lf::OpenLightField(folder);
  if (!light_field) return images;
  for (uint32_t i = 0; i < light_field->size(); ++i)
    images.push_back(lf::ImageFileOf(*light_field, lf::LfImageId{i}));
  return images;
}

struct Arguments {
  std::vector<std::string> plates;
  std::string output, format = "exr", video;
  lf::PictureArguments picture;
  bool no_contact_sheet = false;
  lf::AllowMissing allow_missing;
};

void AddOptions(CLI::App& app, Arguments& a, lf::MergeOptions& options) {
  lf::OptionGroup input(app, lf::kInputGroup), output(app, lf::kOutputGroup);
  lf::OptionGroup running(app, lf::kRunningGroup);
  input.Add("PLATES", a.plates, "Plates of lfrenderer --shard or --keep-plates, or folders")
      ->required()
      ->check(lf::NotEmpty())
      ->check(lf::TakesFiles("plate"));
  a.allow_missing.AddTo(app, "the LF images of the frame with the most LF images");
  output.Add("-o,--output DIR", a.output, "Folder of the frames")
      ->required()
      ->check(lf::NotEmpty());
  lf::AddFrameFormat(output, a.format);
  a.picture.AddTo(output);
  lf::AddFilmFiles(output, a.video, a.no_contact_sheet);
  running.AddFlag("--resume", options.resume,
                  "Keep the frames that are in DIR, and write the others");
  running.AddFlag("--overwrite", options.overwrite, "Replace the frames in DIR")
      ->excludes("--resume");
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfmerge", kHelp);
  Arguments arguments;
  lf::MergeOptions options;
  AddOptions(program.app(), arguments, options);
  program.AddCommonOptions({.threads = true,
                            .json = "Print the report to stdout as JSON",
                            .progress = true,
                            .verbose = true,
                            .quiet = true});

  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    const lf::CommonOptions& common = program.common();
    LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, arguments.allow_missing.Limit());
    options.signals = &lf::CatchRenderSignals();
    options.output_folder = arguments.output;
    options.kept_files = LfImagesIn(arguments.output);
    options.format = *lf::ParseFrameFormat(arguments.format);
    options.adds_opacity = arguments.picture.HasAlpha();
    LF_ASSIGN_OR_RETURN(options.picture, arguments.picture.Make(options.format));
    if (!arguments.video.empty()) options.video = arguments.video;
    options.contact_sheet = !arguments.no_contact_sheet;
    lf::ThreadPool pool(common.threads);
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "plates");
    const std::vector<std::filesystem::path> files(arguments.plates.begin(),
                                                   arguments.plates.end());
    LF_ASSIGN_OR_RETURN(const lf::RenderReport report,
                        lf::MergeShards(files, options, pool, [&](const lf::MergeProgress& now) {
                          meter.Update(now.plate_count, now.plate_total,
                                       {{"frame", now.frame_count, now.frame_total}});
                        }));
    lf::LogInfo(
        "{} frame{} in {:.1f} s, peak memory {} MiB; see {}", report.frames.size(),
        report.frames.size() == 1 ? "" : "s", report.total_s, report.peak_memory_bytes >> 20,
        (options.output_folder / (arguments.no_contact_sheet ? "" : "contact_sheet.png")).string());
    if (common.json) LF_RETURN_IF_ERROR(lf::PrintReport(lf::ToJson(report)));
    return lf::EndWithMissing(
        lf::MissingOf(report,
                      "once they are mended, render their shards anew without --resume, and merge "
                      "with --overwrite"),
        limit);
  });
}
