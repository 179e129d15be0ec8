// SPDX-License-Identifier: Apache-2.0
// lfcammvminfo PATH: prints the camera of each frame of a path.
#include <optional>
#include <string>
#include <vector>

#include "tools/common/program.h"
#include "tools/common/programs.h"

#include "lf/camera/path/camera_table.h"
#include "lf/core/log.h"
#include "lf/import/paths/open_path.h"

namespace {

constexpr lf::HelpTexts kHelp = {
    .summary = lf::SummaryOf("lfcammvminfo"),
    .usage = "  lfcammvminfo PATH [OPTIONS]",
    .examples = R"(  lfcammvminfo path.yaml                        # all frames, a line each
  lfcammvminfo path.yaml --frame 12             # one frame, a line per number
  lfcammvminfo path.yaml --csv > cameras.csv
  lfcammvminfo path.yaml --json | jq '.cameras[].f_number')",
    .details =
        R"(Lengths that end in _w are world units. The others are computed from them by unit_m, the metres per
world unit. The depth of field is the range of distances along the optical axis at which the blur is
smaller than one element of the sensor plate. forward and up are the camera's axes in the world. The
program also checks the path: the exit code is 0 if the path has no error.)",
};

struct Arguments {
  std::string path;
  std::optional<uint32_t> frame;  // number of the frame to be shown; unset: all frames
  std::optional<double> unit_m;
  bool csv = false;
};

lf::Result<std::vector<lf::FrameId>> ChooseFrames(const Arguments& arguments,
                                                  const lf::CameraPath& path) {
  if (!arguments.frame) return path.frames().All();
  if (!path.frames().Has({*arguments.frame}))
    return lf::UsageError(fmt::format("--frame {}: {} has no such frame; expected {} to {}",
                                      *arguments.frame, arguments.path, path.frames().first,
                                      path.frames().last()));
  return std::vector<lf::FrameId>{{*arguments.frame}};
}

lf::Result<void> Report(const Arguments& arguments, bool json) {
  LF_ASSIGN_OR_RETURN(const lf::CameraPath path,
                      lf::OpenPath(arguments.path, {.light_field_unit_m = arguments.unit_m,
                                                    .surface = lf::PathOptions::Surface::kName}));
  LF_ASSIGN_OR_RETURN(const auto frames, ChooseFrames(arguments, path));
  if (json) return lf::PrintReport(lf::CameraJson(path, frames));
  if (arguments.csv) return lf::PrintReport(lf::CameraCsv(path, frames));
  if (arguments.frame) return lf::PrintReport(lf::CameraBlock(path, frames.front()));
  return lf::PrintReport(lf::CameraTable(path, frames));
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  lf::Program program("lfcammvminfo", kHelp);
  lf::OptionGroup input(program.app(), lf::kInputGroup), output(program.app(), lf::kOutputGroup);
  input.Add("PATH", arguments.path, lf::kPathHelp)->required();
  input
      .Add("--unit-m METRES", arguments.unit_m, "Metres per world unit, if PATH does not state it")
      ->check(CLI::Range(1e-9, 1e9));
  output.Add("--frame N", arguments.frame, "Print only the frame with the number N (all)")
      ->check(CLI::Range(uint32_t{0}, lf::kLargestFrameNumber));
  CLI::Option* const csv = output.AddFlag(
      "--csv", arguments.csv, "Print a comma-separated table, with all digits of numbers");
  program.AddCommonOptions({.json = "Print JSON with all digits\n"
                                    "Infinite numbers are null.",
                            .quiet = true});
  csv->excludes("--json");
  return program.Run(argc, argv, [&] { return Report(arguments, program.common().json); });
}
