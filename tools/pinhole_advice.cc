// SPDX-License-Identifier: Apache-2.0
#include "tools/pinhole_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/common/next_step.h"

#include "lf/core/log.h"
#include "lf/core/shell_word.h"
#include "lf/focus/propose_lens.h"

namespace lf {
namespace {

bool IsMeant(const LightField& light_field, const FilmSettings& film) {
  return film.lens_weights != LensWeights::kAuto || film.Rebins() || film.CountsRays() ||
         HasVirtual(light_field);
}

// Returns the number with few digits, as people write f-numbers: 2.8, 0.35.
std::string FNumberText(double f_number) { return fmt::format("{:.2g}", f_number); }

}  // namespace

void WarnOfPinhole(const LightField& light_field, const CameraPath& path, const FilmSettings& film,
                   const std::string& light_field_name, const std::string& path_name) {
  if (IsMeant(light_field, film)) return;
  if (std::any_of(path.cameras.begin(), path.cameras.end(),
                  [](const RenderCamera& camera) { return camera.aperture.radius_w > 0; }))
    return;
  const size_t count = path.frame_count();
  std::string words = fmt::format(
      "the aperture is 0 in {}: a pinhole, which sees few LF cameras and has no blur. "
      "To film a pinhole without this warning, add --lens-weights hat, which changes no bit",
      count == 1 ? "the frame" : fmt::format("all {} frames", count));
  const RenderCamera& first = path.cameras.front();
  const std::optional<ProposedLens> lens =
      ProposeLens(light_field, first.pinhole, first.focus_distance_w);
  if (!lens || !(first.focal_length_w > 0)) return LogWarning("{}", words);
  words += fmt::format("; a lens of this capture could be {:.3g} world units wide ({})",
                       lens->diameter_w, lens->reason);
  if (lens->needs_densifying) words += "; such a film needs virtual LF images (--densify)";
  const std::string f_number = FNumberText(first.focal_length_w / lens->diameter_w);
  LogWarning(
      "{}. To make a path with f/{}: {}", words, f_number,
      ShellCommand({"lfpath", FileArgument(path_name), "-o", FreeName("lens", ".yaml"),
                    "--lightfield", FileArgument(light_field_name), "--f-number", f_number}));
}

}  // namespace lf
