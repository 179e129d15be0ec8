// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/lens_statistics/statistic_film.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace lf {
namespace {

TEST(StatisticFilm, RefusesWhatHasNoMeaningForAStatistic) {
  Package package;
  package.path.cameras.resize(1);
  package.frames = {{.id = FrameId{1}}};
  const LensStatisticOptions statistic;
  const StatisticFilm film(statistic);
  const RenderOptions plain = RenderOptionsOf(statistic, {});
  ASSERT_TRUE(film.Check(package, plain));
  struct Case {
    std::string word;
    std::function<void(RenderOptions&)> change;
  };
  const Case cases[] = {
      {"cannot be added",
       [](RenderOptions& o) {
         o.film.shard = Shard{1, 2};
       }},
      {"noise", [](RenderOptions& o) { o.film.stop_when.noise = 0.1; }},
      {"{stop_when}", [](RenderOptions& o) { o.film.stop_when.samples = 8; }},
      {"{require}", [](RenderOptions& o) { o.film.require.samples = 8; }},
      {"{mode rebin}", [](RenderOptions& o) { o.film.mode = RenderMode::kRebin; }},
      {"{keep_plates}", [](RenderOptions& o) { o.folder.keep_plates = true; }},
      {"{finish}", [](RenderOptions& o) { o.folder.finish_early = {FrameId{1}}; }},
  };
  for (const Case& one : cases) {
    SCOPED_TRACE(one.word);
    RenderOptions options = plain;
    one.change(options);
    const Result<void> checked = film.Check(package, options);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
    EXPECT_NE(checked.error().message.find(one.word), std::string::npos) << checked.error().message;
  }
}

}  // namespace
}  // namespace lf
