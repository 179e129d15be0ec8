// SPDX-License-Identifier: Apache-2.0
#include "lf/import/video/video_facts.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lf {
namespace {

const std::string kStream =
    "stream|width=160|height=120|pix_fmt=yuv420p|color_range=tv|color_space=bt709|"
    "color_transfer=unknown\n";

void ExpectFault(const std::string& text, const std::string& part) {
  const Result<RecordedVideo> video = ParseVideoFacts(text, "a/cam00.mp4");
  ASSERT_FALSE(video) << text;
  EXPECT_EQ(video.error().kind, ErrorKind::kInput);
  EXPECT_NE(video.error().message.find("a/cam00.mp4: "), std::string::npos);
  EXPECT_NE(video.error().message.find(part), std::string::npos) << video.error().message;
}

TEST(VideoFacts, FramesAreInTheOrderInWhichTheyAreShown) {
  const Result<RecordedVideo> video = ParseVideoFacts(
      "packet|pts_time=1.400000|flags=K_\npacket|pts_time=1.480000|flags=__\n"
      "packet|pts_time=1.440000|flags=__\npacket|pts_time=1.520000|flags=K__\n" +
          kStream + "format|start_time=1.400000\n",
      "a.mp4");
  ASSERT_TRUE(video) << video.error().message;
  EXPECT_EQ(video->width_px, 160);
  EXPECT_EQ(video->height_px, 120);
  EXPECT_EQ(video->matrix, "bt709");
  EXPECT_EQ(video->transfer, "unknown");
  EXPECT_EQ(video->begin_s, 1.4);
  EXPECT_EQ(video->shown_s, (std::vector<double>{1.4, 1.44, 1.48, 1.52}));
  EXPECT_EQ(video->keys, (std::vector<size_t>{0, 3}));
  EXPECT_NEAR(SecondsFromFirst(*video)[3], 0.12, 1e-12);
}

TEST(VideoFacts, FramesThatAreNotShownDoNotCount) {
  const Result<RecordedVideo> video = ParseVideoFacts(
      "packet|pts_time=-0.04|flags=KD_\npacket|pts_time=0.0|flags=___\n" + kStream, "a.mp4");
  ASSERT_TRUE(video) << video.error().message;
  EXPECT_EQ(video->shown_s, (std::vector<double>{0}));
  EXPECT_TRUE(video->keys.empty());
}

TEST(VideoFacts, FaultsAreNamed) {
  const std::string packet = "packet|pts_time=0.0|flags=K_\n";
  ExpectFault("", "holds no video");
  ExpectFault(packet, "holds no video");
  ExpectFault(kStream, "holds no frame");
  ExpectFault(kStream + "packet|pts_time=N/A|flags=K_\n", "frame 0 has no time");
  ExpectFault(kStream + packet + "packet|flags=K_\n", "frame 1 has no time");
  ExpectFault(packet + "stream|width=0|height=120\n", "0 x 120 pixels");
  ExpectFault(packet + "stream|width=9x|height=120\n", "0 x 120 pixels");
  ExpectFault(packet + "stream|width=160|height=120|color_transfer=smpte2084\n", "smpte2084");
  ExpectFault(packet + "stream|width=160|height=120|color_transfer=arib-std-b67\n",
              "dynamic range");
}

TEST(VideoFacts, DeepFormatsHaveMoreThanEightBits) {
  RecordedVideo video;
  for (const char* const format : {"yuv420p10le", "gray16be", "p010le", "gbrp12le"}) {
    video.pixel_format = format;
    EXPECT_TRUE(IsDeep(video)) << format;
  }
  for (const char* const format : {"yuv420p", "nv12", "rgb24", "gbrp", "rgb565le", "gray"}) {
    video.pixel_format = format;
    EXPECT_FALSE(IsDeep(video)) << format;
  }
}

TEST(VideoFacts, VideosAreKnownByTheirNames) {
  for (const char* const name : {"cam00.mp4", "a.b.MKV", "x.MOV"})
    EXPECT_TRUE(IsRecordedVideoName(name)) << name;
  for (const char* const name : {"cam00", ".mp4", ".hidden.mp4", "a.mp4.part", "a.png"})
    EXPECT_FALSE(IsRecordedVideoName(name)) << name;
}

TEST(VideoFacts, AFileThatIsNoVideoIsAnErrorOfInput) {
  const Result<RecordedVideo> video = ReadVideoFacts("/nonexistent/cam00.mp4");
  ASSERT_FALSE(video);
  EXPECT_EQ(video.error().kind, ErrorKind::kInput) << video.error().message;
}

}  // namespace
}  // namespace lf
