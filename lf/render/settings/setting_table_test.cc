// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/setting_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "lf/core/geometry.h"
#include "lf/render/settings/test_settings.h"

namespace lf {
namespace {

TEST(SettingTable, EachRowSetsAMemberOfItsOwn) {
  std::set<std::string_view> keys;
  for (const Setting& setting : SettingTable()) {
    EXPECT_TRUE(keys.insert(setting.key).second) << setting.key;
    EXPECT_EQ(FindSetting(setting.key), &setting);
    FilmSettings film;
    const std::string another = testing::AnotherOf(setting);
    ASSERT_TRUE(setting.set(another, &film)) << setting.key << " " << another;
    for (const Setting& other : SettingTable()) {
      const bool is_changed = other.get(film) != other.get(FilmSettings());
      EXPECT_EQ(is_changed, other.key == setting.key) << setting.key << " " << other.key;
    }
    for (const std::string_view word : setting.words) {
      FilmSettings chosen;
      ASSERT_TRUE(setting.set(std::string(word), &chosen)) << setting.key << " " << word;
      const bool is_auto = setting.key == "estimator" && word == "bilinear";
      EXPECT_EQ(setting.get(chosen), is_auto ? "auto" : word) << setting.key;
    }
    ASSERT_TRUE(setting.set(setting.get(FilmSettings()), &film)) << setting.key;
    EXPECT_EQ(setting.get(film), setting.get(FilmSettings())) << setting.key;
  }
  EXPECT_EQ(FindSetting("lens weights"), nullptr);
}

TEST(SettingTable, RefusedTextsAreNamedAndChangeNothing) {
  for (const Setting& setting : SettingTable()) {
    std::vector<std::string> wrong = {"never heard of", "1 2"};
    if (std::isfinite(setting.most)) wrong.push_back(std::to_string(setting.most * 2));
    if (setting.kind != SettingKind::kText) wrong.insert(wrong.end(), {"", "nan", "0x1"});
    if (setting.kind != SettingKind::kText && setting.least >= 0) wrong.push_back("-1");
    for (const std::string& text : wrong) {
      FilmSettings film;
      const Result<void> set = setting.set(text, &film);
      ASSERT_FALSE(set) << setting.key << " '" << text << "'";
      EXPECT_EQ(set.error().kind, ErrorKind::kUsage);
      EXPECT_TRUE(set.error().message.starts_with("{" + std::string(setting.key)))
          << set.error().message;
      EXPECT_EQ(setting.get(film), setting.get(FilmSettings())) << setting.key;
    }
  }
}

TEST(SettingTable, TheFirstWordIsTheDefault) {
  for (const Setting& setting : SettingTable())
    if (setting.kind == SettingKind::kChoice) {
      EXPECT_EQ(setting.get(FilmSettings()), setting.words.front()) << setting.key;
    }
}

TEST(SettingTable, RecordsSettingsThatMatterByRole) {
  const auto texts = [](const FilmSettings& film, SettingRole role) {
    std::string joined;
    for (const auto& [key, text] : TextsOf(film, role)) joined += key + " " + text + "\n";
    return joined;
  };
  FilmSettings film;
  EXPECT_EQ(texts(film, SettingRole::kRays),
            "mode collect\nestimator bilinear\nfilter auto\nlf_pixels auto\nlens_weights auto\n"
            "guard on\norder spread\nseed 0\nback_end fast\n");
  EXPECT_EQ(texts(film, SettingRole::kPicture), "fill 2\nsmooth_below 0\n");
  EXPECT_EQ(texts(film, SettingRole::kMeasuring), "");
  film.reading.estimator = Estimator::kNearest;
  film.guard = false;
  film.max_image_count = 7;
  film.require.noise = 0.5;
  EXPECT_EQ(texts(film, SettingRole::kRays),
            "mode collect\nestimator nearest\nlens_weights auto\nmax_images 7\norder spread\n"
            "seed 0\nback_end fast\n");
  EXPECT_EQ(texts(film, SettingRole::kMeasuring), "require noise<=0.5\n");
  film.mode = RenderMode::kRebin;
  EXPECT_NE(texts(film, SettingRole::kRays).find("interpolation auto"), std::string::npos);
  EXPECT_EQ(texts(film, SettingRole::kRays).find("sigma_st"), std::string::npos);
  film.rebin.interpolation = RayInterpolation::kCells;
  EXPECT_NE(texts(film, SettingRole::kRays).find("sigma_st"), std::string::npos);
}

TEST(SettingTable, AnAngleKeepsItsDegrees) {
  for (const char* degrees : {"0.1", "30", "45", "90", "123.456", "180"}) {
    FilmSettings film;
    ASSERT_TRUE(FindSetting("max_angle_deg")->set(degrees, &film));
    EXPECT_EQ(FindSetting("max_angle_deg")->get(film), degrees);
    EXPECT_EQ(film.max_angle_rad, RadiansFromDegrees(std::stod(degrees)));
  }
}

}  // namespace
}  // namespace lf
