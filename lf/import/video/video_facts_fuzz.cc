// SPDX-License-Identifier: Apache-2.0
// Parses any bytes as what ffprobe prints about a video: the result must be a video whose frames
// are in order, or an error that names the file.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

#include "lf/core/check.h"
#include "lf/import/video/video_facts.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size_bytes) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size_bytes);
  const lf::Result<lf::RecordedVideo> video = lf::ParseVideoFacts(text, "f/cam00.mp4");
  if (!video) {
    LF_CHECK(video.error().message.starts_with("f/cam00.mp4: "));
    return 0;
  }
  LF_CHECK(video->width_px >= 1 && video->height_px >= 1 && !video->shown_s.empty());
  LF_CHECK(std::is_sorted(video->shown_s.begin(), video->shown_s.end(), std::less_equal<>()));
  LF_CHECK(std::is_sorted(video->keys.begin(), video->keys.end()));
  LF_CHECK(video->keys.empty() || video->keys.back() < video->shown_s.size());
  LF_CHECK(lf::SecondsFromFirst(*video).front() == 0);
  return 0;
}
