#include "tools/focus_frame.h"

#include <fmt/format.h>

#include "lf/import/paths/open_path.h"

namespace lf {

void FrameArgument::AddTo(OptionGroup& input) {
  input.Add("PATH", path, kPathHelp)->required();
  input.Add("--frame N", frame, "Frame of PATH whose camera is used, from 1")
      ->check(CLI::Range(1, kMostFrames));
}

Result<CameraPath> FrameArgument::Open(const LightField& light_field,
                                       const std::string& source) const {
  LF_ASSIGN_OR_RETURN(CameraPath opened, OpenPath(path, PathOptionsFor(light_field, source)));
  if (frame > opened.frame_count())
    return UsageError(fmt::format("--frame {}: {} has {} frame{}: give a number from 1 to {}",
                                  frame, path, opened.frame_count(),
                                  opened.frame_count() == 1 ? "" : "s", opened.frame_count()));
  return opened;
}

}  // namespace lf
