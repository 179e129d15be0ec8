#include "lf/pipeline/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lf {
namespace {

TEST(Report, CountsEmptyElementsPerChannel) {
  DevelopedFrame developed;
  developed.ray_count = Image<uint32_t>(3, 1, 3);
  const uint32_t counts[] = {0, 5, 9, 0, 6, 1, 4, 7, 0};
  std::copy(std::begin(counts), std::end(counts), developed.ray_count.pixels().begin());
  const FrameReport report = MakeFrameReport(FrameId{4}, {2, 30, 20}, developed);
  EXPECT_EQ(report.empty_element_count, (std::array<uint64_t, 3>{2, 0, 1}));
  EXPECT_EQ(report.min_count, (std::array<uint64_t, 3>{0, 5, 0}));
  EXPECT_EQ(report.median_count, (std::array<uint64_t, 3>{0, 6, 1}));
}

TEST(Report, IsJsonEvenWithNamesThatAreNoText) {
  RenderReport report;
  report.frames.push_back({FrameId{7}, {3, 100, 90}, {}, {}, {}, 0});
  report.skipped.push_back({"a\xff.png", "broken", 0});
  const nlohmann::json json = nlohmann::json::parse(ToJson(report));
  EXPECT_EQ(json["frames"][0]["frame"], 7);
  EXPECT_EQ(json["rays_tested"], 100);
  EXPECT_EQ(json["skipped_lf_images"][0]["reason"], "broken");
}

}  // namespace
}  // namespace lf
