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
  const FilmCommands commands = CommandsOf(Page(), true);
  EXPECT_EQ(commands.forecast, "lfpreprocessor capture path.yaml --plan");
  EXPECT_EQ(commands.render, "lfrenderer capture path.yaml -o frames");
  EXPECT_EQ(commands.packages,
            "lfpreprocessor capture path.yaml -o packages\n"
            "lfrenderer packages/package-*.lfp -o frames");
  EXPECT_EQ(commands.densify, "lfrenderer capture path.yaml --densify -o frames");
  EXPECT_EQ(CommandsOf(Page(), false).densify, "");
}

TEST(TakesDensify, RefusesWhatTheRendererRefuses) {
  LightField field;
  FilmSettings film;
  EXPECT_TRUE(TakesDensify(field, film, false));
  EXPECT_FALSE(TakesDensify(field, film, true));
  film.mode = RenderMode::kRebin;
  EXPECT_TRUE(TakesDensify(field, film, false));
  film.rebin.interpolation = RayInterpolation::kCells;
  EXPECT_FALSE(TakesDensify(field, film, false));
  film = {};
  field.encoding.bayer = BayerPattern::kRggb;
  EXPECT_FALSE(TakesDensify(field, film, false));
  film.guard = false;
  EXPECT_TRUE(TakesDensify(field, film, false));
  EXPECT_TRUE(TakesDensify(field, film, true));
  field.encoding = {};
  field.encoding.masks_clipped = true;
  EXPECT_FALSE(TakesDensify(field, film, false));
  field.encoding = {};
  field.cameras.resize(1);
  field.cameras[0].is_virtual = true;
  EXPECT_FALSE(TakesDensify(field, film, false));
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
  const FilmCommands commands = CommandsOf(page, true);
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
    EXPECT_NE(CommandsOf(page, true).render, CommandsOf(Page(), true).render) << setting.key;
  }
}

TEST(FilmCommands, QuoteNames) {
  PageArguments page = Page();
  page.light_field = "it's";
  page.path = "-p.yaml";
  page.watch = "-out";
  EXPECT_EQ(CommandsOf(page, true).render, "lfrenderer 'it'\\''s' ./-p.yaml -o ./-out");
}

}  // namespace
}  // namespace lf
