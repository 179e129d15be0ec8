// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/interpolation.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "lf/render/settings/setting_table.h"
#include "lf/render/settings/test_settings.h"

namespace lf {
namespace {

FilmSettings Rebinned(RenderMode mode, RayInterpolation interpolation = RayInterpolation::kAuto) {
  FilmSettings film;
  film.mode = mode;
  film.rebin.interpolation = interpolation;
  return film;
}

TEST(Interpolation, SettingsThatOnlyCellsUseChooseCells) {
  for (const RenderMode mode : {RenderMode::kRebin, RenderMode::kHybrid}) {
    EXPECT_EQ(InterpolationOf(Rebinned(mode)), RayInterpolation::kPixels);
    size_t of_cells = 0;
    for (const Setting& setting : SettingTable()) {
      if (setting.key == "mode" || setting.key == "interpolation") continue;
      FilmSettings film = Rebinned(mode);
      ASSERT_TRUE(setting.set(testing::AnotherOf(setting), &film));
      const bool is_of_thesis = mode == RenderMode::kRebin && setting.key == "lens_weights";
      const bool chooses = IsOfCells(setting.key) || is_of_thesis;
      EXPECT_EQ(InterpolationOf(film) == RayInterpolation::kCells, chooses) << setting.key;
      EXPECT_EQ(KeepsCells(film), chooses) << setting.key;
      EXPECT_EQ(KeepsPixels(film), !chooses) << setting.key;
      film.rebin.interpolation = RayInterpolation::kPixels;
      EXPECT_EQ(InterpolationOf(film), RayInterpolation::kPixels) << setting.key;
      of_cells += IsOfCells(setting.key) ? 1 : 0;
    }
    EXPECT_EQ(of_cells, 15u);
    EXPECT_EQ(InterpolationOf(Rebinned(mode, RayInterpolation::kCells)), RayInterpolation::kCells);
  }
  FilmSettings hybrid = Rebinned(RenderMode::kHybrid);
  hybrid.lens_weights = LensWeights::kNone;
  EXPECT_EQ(InterpolationOf(hybrid), RayInterpolation::kPixels);
}

TEST(Interpolation, ACollectedFilmKeepsNeither) {
  FilmSettings film = Rebinned(RenderMode::kCollect, RayInterpolation::kCells);
  film.rebin.query.sigma_st = 0.7;
  EXPECT_FALSE(KeepsCells(film));
  EXPECT_FALSE(KeepsPixels(film));
  EXPECT_TRUE(HasLensWeights(film));
  EXPECT_TRUE(CheckInterpolation(film));
}

// Settings of rebinned rays would change nothing in frames that have none.
TEST(Interpolation, CollectionRefusesSettingsOfRebinnedRays) {
  size_t count = 0;
  for (const Setting& setting : SettingTable()) {
    if (setting.key == "mode") continue;
    for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
      FilmSettings film;
      film.mode = mode;
      EXPECT_TRUE(CheckMode(film));
      ASSERT_TRUE(setting.set(testing::AnotherOf(setting), &film));
      const Result<void> checked = CheckMode(film);
      const bool is_refused = mode == RenderMode::kCollect && IsOfRebinning(setting.key);
      EXPECT_EQ(!checked, is_refused) << setting.key;
      if (checked) continue;
      ++count;
      EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
      EXPECT_EQ(checked.error().message.find("{" + std::string(setting.key) + " "), 0u);
      EXPECT_EQ(CollectInstead(film), "{mode collect} without {" + std::string(setting.key) + "}");
    }
  }
  EXPECT_GT(count, 20u);
  EXPECT_TRUE(IsOfRebinning("alpha"));
  EXPECT_TRUE(IsOfRebinning("nearest"));
  EXPECT_FALSE(IsOfRebinning("lens_weights"));
}

TEST(Interpolation, OnlyCellsAloneHaveNoLensWeights) {
  for (const RayInterpolation way : {RayInterpolation::kPixels, RayInterpolation::kCells})
    for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid})
      EXPECT_EQ(HasLensWeights(Rebinned(mode, way)),
                way == RayInterpolation::kPixels || mode != RenderMode::kRebin);
}

TEST(Interpolation, PixelsRefuseSettingsThatOnlyCellsUse) {
  for (const Setting& setting : SettingTable()) {
    if (setting.key == "interpolation" || setting.key == "mode") continue;
    for (const RayInterpolation way : {RayInterpolation::kPixels, RayInterpolation::kCells}) {
      FilmSettings film = Rebinned(RenderMode::kHybrid, way);
      ASSERT_TRUE(setting.set(testing::AnotherOf(setting), &film));
      const Result<void> checked = CheckInterpolation(film);
      EXPECT_EQ(!checked, way == RayInterpolation::kPixels && IsOfCells(setting.key))
          << setting.key;
      if (checked) continue;
      EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
      const std::string& message = checked.error().message;
      EXPECT_NE(message.find("{interpolation pixels}"), std::string::npos) << message;
      EXPECT_NE(message.find("{" + std::string(setting.key) + " "), std::string::npos) << message;
      EXPECT_NE(message.find("use {interpolation cells}"), std::string::npos) << message;
    }
  }
}

// Hoods, transmissions, focal surfaces, shutters, opacities and limits are refused for cells alone.
TEST(Interpolation, CellsRefuseWhatTheyCannotRender) {
  struct Case {
    std::string words;
    std::function<Result<void>(FilmSettings)> check;
  };
  const auto lens = [](const std::function<void(RenderCamera&)>& change) {
    return [change](const FilmSettings& film) {
      std::vector<RenderCamera> cameras(2);
      change(cameras[1]);
      return CheckLenses(cameras, film);
    };
  };
  const std::vector<Case> cases = {
      {"an alpha channel",
       [](const FilmSettings& film) {
         RadianceEncoding encoding;
         encoding.alpha = AlphaMeaning::kStraight;
         encoding.keeps_opacity = true;
         return CheckOpacity(encoding, film);
       }},
      {"a lens with a hood (lens.hood_diameter in the path)", lens([](RenderCamera& camera) {
         camera.hood = {0.1, 0.2};
       })},
      {"a lens with a transmission (lens.transmission in the path)", lens([](RenderCamera& camera) {
         camera.transmission = std::make_shared<const Transmission>(*Transmission::FromText("ff"));
       })},
      {"a focal surface (focus.surface in the path)", lens([](RenderCamera& camera) {
         camera.surface = std::make_shared<const FocalSurface>(
             *FocalSurface::Of(4, 3, {{{0, 0, 4, 3}, Vec3(0, 0, 1)}}));
       })},
      {"a path with a shutter",
       [](const FilmSettings& film) { return CheckShutter(true, film, false); }},
      {"{max_images}", [](FilmSettings film) {
         film.max_image_count = 5;
         return CheckMaxImages(film);
       }}};
  for (const Case& one : cases)
    for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
      EXPECT_TRUE(one.check(Rebinned(mode))) << one.words;
      EXPECT_TRUE(one.check(Rebinned(mode, RayInterpolation::kPixels))) << one.words;
      const Result<void> checked = one.check(Rebinned(mode, RayInterpolation::kCells));
      ASSERT_EQ(checked.has_value(), mode == RenderMode::kCollect) << one.words;
      if (checked) continue;
      EXPECT_EQ(checked.error().kind, ErrorKind::kUsage);
      const std::string& message = checked.error().message;
      EXPECT_NE(message.find(one.words), std::string::npos) << message;
      EXPECT_NE(message.find(std::string("{mode ") + NameOf(mode) + "}"), std::string::npos);
      EXPECT_NE(message.find("use {interpolation pixels}"), std::string::npos) << message;
      EXPECT_NE(message.find("{mode collect} without {interpolation}"), std::string::npos)
          << message;
    }
}

TEST(Interpolation, AGuardedPlateRefusesAShutterInEveryMode) {
  for (const RenderMode mode : {RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid}) {
    const Result<void> checked = CheckShutter(true, Rebinned(mode), true);
    ASSERT_FALSE(checked);
    EXPECT_NE(checked.error().message.find("{guard off}"), std::string::npos);
    EXPECT_TRUE(CheckShutter(false, Rebinned(mode), true));
  }
}

// The remedy is one that works: the settings that chose cells must go.
TEST(Interpolation, TheRemedyNamesTheSettingsThatMustGo) {
  FilmSettings film = Rebinned(RenderMode::kRebin);
  EXPECT_EQ(PixelsInstead(film), "{interpolation pixels}");
  film.rebin.query.sigma_st = 0.7;
  film.rebin.reparameterise = false;
  EXPECT_EQ(PixelsInstead(film), "{interpolation pixels} without {sigma_st}, {reparameterise}");
  EXPECT_NE(CheckShutter(true, film, false).error().message.find(PixelsInstead(film)),
            std::string::npos);
  EXPECT_EQ(PixelsInstead(film, {"{kept edges}"}),
            "{interpolation pixels} without {sigma_st}, {reparameterise}, {kept edges}");
}

// A message says which setting has chosen cells, if they were not asked for.
TEST(Interpolation, CellsAreNamedWithTheSettingThatChoseThem) {
  FilmSettings film = Rebinned(RenderMode::kRebin);
  film.lens_weights = LensWeights::kNone;
  EXPECT_EQ(CellsInWords(film),
            "{mode rebin} with {interpolation cells} (chosen by {lens_weights none})");
  film.rebin.query.lens_sets = 2;
  EXPECT_EQ(CellsInWords(film),
            "{mode rebin} with {interpolation cells} (chosen by {lens_sets 2})");
  film.rebin.interpolation = RayInterpolation::kCells;
  EXPECT_EQ(CellsInWords(film), "{mode rebin} with {interpolation cells}");
}

// Lens weights state a transmission, so that a remedy that keeps it must leave them on.
TEST(Interpolation, TheRemedyForATransmissionHasLensWeights) {
  std::vector<RenderCamera> cameras(1);
  cameras[0].transmission = std::make_shared<const Transmission>(*Transmission::FromText("ff"));
  FilmSettings film = Rebinned(RenderMode::kRebin);
  film.lens_weights = LensWeights::kNone;
  EXPECT_NE(CheckLenses(cameras, film)
                .error()
                .message.find("use {interpolation pixels} or {mode collect}, both without "
                              "{lens_weights none}, or leave"),
            std::string::npos);
  film = Rebinned(RenderMode::kHybrid, RayInterpolation::kCells);
  film.smooth_below = 2;
  EXPECT_NE(CheckLenses(cameras, film).error().message.find("both without {smooth_below}, or"),
            std::string::npos);
}

TEST(Interpolation, OnlyCellsRecordTheirSettings) {
  for (const RayInterpolation way : {RayInterpolation::kPixels, RayInterpolation::kCells}) {
    std::string keys;
    for (const auto& [key, text] : TextsOf(Rebinned(RenderMode::kRebin, way), SettingRole::kRays))
      keys += key + " " + text + "\n";
    EXPECT_NE(keys.find(std::string("interpolation ") + NameOf(way) + "\n"), std::string::npos);
    EXPECT_NE(keys.find("kept auto\n"), std::string::npos);
    EXPECT_EQ(keys.find("sigma_st") != std::string::npos, way == RayInterpolation::kCells);
    EXPECT_EQ(keys.find("nearest 0") != std::string::npos, way == RayInterpolation::kCells);
  }
}

}  // namespace
}  // namespace lf
