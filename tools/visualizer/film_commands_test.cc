// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/film_commands.h"

#include <gtest/gtest.h>

#include "lf/render/settings/setting_table.h"
#include "lf/render/settings/test_settings.h"

namespace lf {
namespace {

PageArguments Page() {
  PageArguments page;
  page.light_field = "capture";
  page.path = "path.yaml";
  return page;
}

TEST(FilmCommands, LeaveDefaultsOut) {
  const FilmCommands commands = CommandsOf(Page());
  EXPECT_EQ(commands.forecast, "lfpreprocessor capture path.yaml --plan");
  EXPECT_EQ(commands.render, "lfrenderer capture path.yaml -o frames");
  EXPECT_EQ(commands.packages,
            "lfpreprocessor capture path.yaml -o packages\n"
            "lfrenderer packages/package-*.lfp -o frames");
}

TEST(FilmCommands, PackagesHoldSomeSettings) {
  PageArguments page = Page();
  page.light_field_options = {"--fov-deg", "60"};
  page.watch = "my frames";
  page.film.max_image_count = 50;
  page.film.max_angle_rad = RadiansFromDegrees(20);
  page.film.seed = 3;
  page.film.lens_weights = LensWeights::kNone;
  page.film.reading = Estimator::kNearest;
  page.film.guard = false;
  const FilmCommands commands = CommandsOf(page);
  EXPECT_EQ(commands.render,
            "lfrenderer capture path.yaml -o 'my frames' --fov-deg 60 --estimator nearest "
            "--lens-weights none --no-guard --max-images 50 --max-angle 20 --seed 3");
  EXPECT_EQ(commands.packages,
            "lfpreprocessor capture path.yaml -o packages --fov-deg 60 --estimator nearest "
            "--lens-weights none --no-guard --max-images 50 --max-angle 20 --seed 3\n"
            "lfrenderer packages/package-*.lfp -o 'my frames' --estimator nearest --lens-weights "
            "none --no-guard");
  EXPECT_EQ(commands.forecast,
            "lfpreprocessor capture path.yaml --plan --fov-deg 60 --estimator nearest "
            "--lens-weights none --no-guard --max-images 50 --max-angle 20 --seed 3");
}

TEST(FilmCommands, StateEverySetting) {
  for (const Setting& setting : SettingTable()) {
    PageArguments page = Page();
    ASSERT_TRUE(setting.set(testing::AnotherOf(setting), &page.film));
    EXPECT_NE(CommandsOf(page).render, CommandsOf(Page()).render) << setting.key;
  }
}

TEST(FilmCommands, QuoteNames) {
  PageArguments page = Page();
  page.light_field = "it's";
  page.path = "-p.yaml";
  page.watch = "-out";
  EXPECT_EQ(CommandsOf(page).render, "lfrenderer 'it'\\''s' ./-p.yaml -o ./-out");
}

}  // namespace
}  // namespace lf
