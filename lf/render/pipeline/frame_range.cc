// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/frame_range.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lf {
namespace {

// Limits the time and memory that a list with many repeats takes.
constexpr size_t kMostNamed = 10'000'000;

// Reads a whole number at the beginning of `text` and removes it from there. Returns false if there
// is none.
bool TakeNumber(std::string_view* text, uint32_t* number) {
  const char* end = text->data() + text->size();
  const auto [rest, error] = std::from_chars(text->data(), end, *number);
  if (error != std::errc{}) return false;
  text->remove_prefix(static_cast<size_t>(rest - text->data()));
  return true;
}

bool TakeCharacter(std::string_view* text, char character) {
  if (text->empty() || text->front() != character) return false;
  text->remove_prefix(1);
  return true;
}

}  // namespace

Result<std::vector<FrameId>> ParseFrameRange(std::string_view text, const FrameNumbers& all,
                                             const char* option, FramesBeyondEnd beyond_end) {
  std::vector<FrameId> frames;
  std::string_view rest = text;
  do {
    uint32_t first = 0, last = 0, step = 1;
    bool good = TakeNumber(&rest, &first);
    last = first;
    if (good && TakeCharacter(&rest, '-')) good = TakeNumber(&rest, &last);
    if (good && (TakeCharacter(&rest, 'x') || TakeCharacter(&rest, ':')))
      good = TakeNumber(&rest, &step);
    if (!good || (!rest.empty() && rest.front() != ','))
      return UsageError(
          fmt::format("{} \'{}\': expected a range such as 1-100, 1-100x2 or 3,7,9", option, text));
    if (last < first)
      return UsageError(
          fmt::format("{} \'{}\': the first frame of a range must be at most the last: write {}-{}",
                      option, text, last, first));
    if (step < 1)
      return UsageError(
          fmt::format("{} \'{}\': the step is 0, expected at least 1 after x or :, as in 1-100x2",
                      option, text));
    if (beyond_end == FramesBeyondEnd::kLeftOut && first > all.last()) continue;
    if (beyond_end == FramesBeyondEnd::kLeftOut) last = std::min(last, all.last());
    if (first < all.first || last > all.last())
      return UsageError(fmt::format("{} \'{}\': expected frames from {} to {}, the last frame",
                                    option, text, all.first, all.last()));
    if ((last - first) / step >= kMostNamed - frames.size())
      return UsageError(
          fmt::format("{}: names more than {} frames, repeated frames included: give fewer frames",
                      option, kMostNamed));
    for (uint64_t n = first; n <= last; n += step)
      frames.push_back(FrameId{static_cast<uint32_t>(n)});
  } while (TakeCharacter(&rest, ','));
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

}  // namespace lf
