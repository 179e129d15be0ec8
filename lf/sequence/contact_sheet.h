// Up to a dozen frames, spread evenly over the sequence, on one page.
#pragma once

#include <filesystem>
#include <vector>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// Which of `frame_count` frames a contact sheet shows: at most `limit` indices, first and last
// among them.
std::vector<size_t> ContactSheetFrames(size_t frame_count, size_t limit = 12);

// Lays 8-bit sRGB pictures [height][width][3] of one size out in a grid with thin borders, each
// reduced (area average) so that the page is at most max_width_px wide, and writes it as PNG.
Result<void> WriteContactSheet(const std::filesystem::path& path,
                               const std::vector<Image<uint8_t>>& pictures,
                               int max_width_px = 1920);

}  // namespace lf
