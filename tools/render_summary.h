// SPDX-License-Identifier: Apache-2.0
// The summary of lfrenderer at the end of a render.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/common/allow_missing.h"

#include "lf/core/result.h"
#include "lf/render/settings/film_settings.h"
#include "lf/render/state/report.h"

namespace lf {

// Logs counts, speed and memory; rebinned rays, virtual light, lens weights and noise; warnings
// about elements without rays, and about lenses that exceed the capture or contain few LF images;
// and where to look at the result. EndOfRender() (render_end.h) reports the LF images that were
// left out.
//   look_at             path of the contact sheet, or of the folder of the results
//   weights_are_chosen  true: the program chose the lens weights; false: an option did
void SummariseRender(const RenderReport& report, const std::string& look_at,
                     bool weights_are_chosen);

// Adds to an error of the kind kInterrupted the command that resumes the render. Returns other
// errors unchanged.
Error WithResumeCommand(Error error, int argc, char** argv);

// Returns kBelowRequired if, in any frame, fewer than 99 % of the elements that LF images see have
// the required number of samples. The message names the first ten such frames.
//   samples  N of --require "samples>=N"; unset: nothing is required
Result<void> CheckRequired(const RenderReport& report, std::optional<uint32_t> samples);

// Returns kBelowRequired if, in any frame, more than 10 % of the elements that LF images see have
// more noise than required, or if the noise could not be measured. The message names the first ten
// such frames.
//   noise  X of --require "noise<=X"; unset: nothing is required
Result<void> CheckRequiredNoise(const RenderReport& report, std::optional<double> noise);

// Returns the outcome of a render whose results are all written: kBelowRequired if frames have less
// quality than the options require, or if more LF images were left out than --allow-missing
// accepts.
//   densify  LF images that --densify left out
Result<void> OutcomeOf(const RenderReport& report, const FilmSettings& film,
                       const AllowMissing& allow_missing, const MissingImages& densify);

}  // namespace lf
