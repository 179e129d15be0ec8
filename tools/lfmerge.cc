// lfmerge PLATES... -o DIR: adds the plates of a divided render and writes its frames.
#include <fmt/format.h>

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "tools/common/allow_missing.h"
#include "tools/common/interrupt.h"
#include "tools/common/program.h"
#include "tools/common/progress.h"
#include "tools/render_end.h"

#include "lf/calibration/open_light_field.h"
#include "lf/core/log.h"
#include "lf/pipeline/merge_shards.h"

namespace {

constexpr const char* kExamples = R"(Examples:
  lfrenderer capture/ path.yaml -o frames --frames 7 --shard 1/3   # on three machines: 1/3, 2/3, 3/3
  lfmerge frames/partial/shards -o frames
  lfmerge a/partial/shards b/partial/shards -o frames --video film.mp4
  lfrenderer capture/ path.yaml -o frames --keep-plates            # plates beside the frames
  lfmerge frames/*.plate -o again --format png16                   # developed again

The frames are those of a render that was not divided, to the bit; the order of the plates does not
matter. Plates are read twice, what they say first: a shard that is missing is known before the work.
The memory is that of one frame. Plates stay where they are. Where their renders left out LF images that
were missing or broken, the exit code is 6.)";

// Returns the LF images of a light field in the folder of the frames, which plates do not know.
std::vector<std::filesystem::path> LfImagesIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> images;
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) return images;
  const lf::Result<lf::LightField> light_field = lf::OpenLightField(folder);
  if (!light_field) return images;
  for (uint32_t i = 0; i < light_field->size(); ++i)
    images.push_back(light_field->ImagePath(lf::LfImageId{i}));
  return images;
}

}  // namespace

int main(int argc, char** argv) {
  lf::Program program("lfmerge", "Adds the plates of a divided render and writes its frames.",
                      kExamples);
  program.AddCommonOptions({.threads = true, .progress = true, .verbose = true, .quiet = true});
  std::vector<std::string> plates;
  std::string output, format = "exr", video;
  bool no_contact_sheet = false;
  lf::AllowMissing allow_missing;
  lf::MergeOptions options;
  CLI::App& app = program.app();
  app.add_option("PLATES", plates,
                 "Files of lfrenderer --shard or --keep-plates, or folders with them")
      ->required()
      ->check(lf::NotEmpty());
  app.add_option("-o,--output", output, "Folder of the frames")->required()->check(lf::NotEmpty());
  app.add_option("--format", format, "exr (16-bit float), exr-float, png (8-bit sRGB), png16")
      ->check(CLI::IsMember({"exr", "exr-float", "png", "png16"}));
  app.add_option("--video", video, "Also write an mp4 (needs ffmpeg)")->check(lf::NotEmpty());
  app.add_flag("--no-contact-sheet", no_contact_sheet, "Do not write contact_sheet.png");
  app.add_flag("--resume", options.resume, "Keep the frames that are there, write the others");
  app.add_flag("--overwrite", options.overwrite, "Write all frames anew")->excludes("--resume");
  allow_missing.AddTo(app, "those of the frame that takes most");
  program.AddJsonOption("Print the report to stdout");

  return program.Run(argc, argv, [&]() -> lf::Result<void> {
    const lf::CommonOptions& common = program.common();
    LF_ASSIGN_OR_RETURN(const lf::MissingLimit limit, allow_missing.Limit());
    options.signals = &lf::CatchRenderSignals();
    options.output_folder = output;
    options.kept_files = LfImagesIn(output);
    options.format = *lf::ParseFrameFormat(format);
    if (!video.empty()) options.video = video;
    options.contact_sheet = !no_contact_sheet;
    lf::ThreadPool pool(common.threads);
    lf::ProgressMeter meter(lf::ParseProgressStyle(common.progress), "plates");
    const std::vector<std::filesystem::path> files(plates.begin(), plates.end());
    LF_ASSIGN_OR_RETURN(const lf::RenderReport report,
                        lf::MergeShards(files, options, pool, [&](const lf::MergeProgress& now) {
                          meter.Update(now.plate_count, now.plate_total,
                                       {{"frame", now.frame_count, now.frame_total}});
                        }));
    lf::LogInfo("{} frames in {:.1f} s, peak memory {} MiB; look at {}", report.frames.size(),
                report.total_s, report.peak_memory_bytes >> 20,
                (options.output_folder / (no_contact_sheet ? "" : "contact_sheet.png")).string());
    if (common.json) LF_RETURN_IF_ERROR(lf::PrintReport(lf::ToJson(report)));
    return lf::EndWithMissing(
        lf::MissingOf(report,
                      "once they are mended, render their shards anew without --resume, and merge "
                      "with --overwrite"),
        limit);
  });
}
