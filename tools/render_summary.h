// What lfrenderer tells at the end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lf/core/result.h"
#include "lf/record/report.h"

namespace lf {

// Counts, speed and memory; then what a person should know: thin frames, and where to look.
// EndOfRender() tells the LF images that were left out (render_end.h).
void SummariseRender(const RenderReport& report, const std::string& look_at);

// An interruption says with which call the render goes on.
Error WithResumeCommand(Error error, int argc, char** argv);

// kBelowRequired if frames have fewer samples than were asked for; names them.
Result<void> CheckRequired(const RenderReport& report, std::optional<uint32_t> samples);

// Returns kBelowRequired if frames have more noise than was asked for, or none that could be
// measured; names them.
Result<void> CheckRequiredNoise(const RenderReport& report, std::optional<double> noise);

}  // namespace lf
