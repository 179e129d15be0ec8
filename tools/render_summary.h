// The summary of lfrenderer at the end of a render.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/render/state/report.h"

namespace lf {

// Logs counts, speed and memory; rebinned rays, lens weights and noise; warnings about elements
// without rays, and about lenses that exceed the capture or contain few LF images; and where to
// look at the result. EndOfRender() (render_end.h) reports the LF images that were left out.
void SummariseRender(const RenderReport& report, const std::string& look_at);

// Adds to the error of an interruption the command that resumes the render.
Error WithResumeCommand(Error error, int argc, char** argv);

// kBelowRequired, with the frames' numbers, if frames have fewer samples than were required.
Result<void> CheckRequired(const RenderReport& report, std::optional<uint32_t> samples);

// kBelowRequired, with the frames' numbers, if frames have more noise than was required, or no
// noise that could be measured.
Result<void> CheckRequiredNoise(const RenderReport& report, std::optional<double> noise);

}  // namespace lf
