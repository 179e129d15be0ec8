// What lfrenderer tells at the end.
#pragma once

#include <string>

#include "lf/pipeline/report.h"

namespace lf {

// Counts, speed and memory; then what a person should know: thin frames, skipped LF images, and
// where to look.
void SummariseRender(const RenderReport& report, const std::string& look_at);

}  // namespace lf
