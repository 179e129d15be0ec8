// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/plan_settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/core/hash.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/part_set.h"
#include "lf/storage/packed/plane_table.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace {

std::string HashOfIds(const std::vector<uint32_t>& ids) {
  return ids.empty() ? std::string()
                     : fmt::format("{:016x}", HashBytes(BytesOf(std::span<const uint32_t>(ids))));
}

std::string HashOfRects(const std::vector<PixelRect>& rects) {
  if (rects.empty()) return {};
  Hasher hasher;
  for (const PixelRect& rect : rects) {
    const int32_t sides[] = {rect.x_begin, rect.y_begin, rect.x_end, rect.y_end};
    hasher.Add(BytesOf(std::span<const int32_t>(sides)));
  }
  return fmt::format("{:016x}", hasher.Hash());
}

std::string TextOf(const std::optional<DisplayLevels>& levels) {
  return levels ? fmt::format("{} {}", levels->black, levels->white) : std::string();
}

// Words for a setting that tell people more than its key.
struct SettingWords {
  std::string_view key, words;
  bool shows_values;  // false: the values are hashes or too long, and are not shown
};
constexpr SettingWords kSettingWords[] = {
    {"light_field.images", "a number of LF images of", true},
    {"light_field.names", "LF images or masks of other names", false},
    {"light_field.calibration", "another calibration (poses, gains or intrinsics)", false},
    {"images", "a number of stored LF images of", true},
    {"images.names", "LF images of other names", false},
    {"images.calibration", "another calibration (poses, gains, intrinsics or virtual LF images)",
     false},
    {"images.whole_ids", "another part of the light field's LF images", false},
    {"images.rects", "other parts of the LF images' pixels", false},
    {"film.lenses", "the packages of other films", false},
    {"film.lens_weights", "lens weights of", true},
    {"film.frames", "a number of frames of", true},
    {"shard_bytes", "a {shard_size}, in bytes, of", true},
    {kPartsKey, "a number of files for resolutions ({by_resolution}) of", true},
    {kDensifiedKey, "settings of the densifier of", true},
    {kPredictedKey, "LF images that are predicted from others, or without such LF images", false},
    {"response", "another response curve", false}};

// Returns the difference of a setting, in the words of kSettingWords, or of its key.
std::string TextOfDifference(std::string key, const std::string& begun, const std::string& now) {
  const auto shown = [](const std::string& value) { return value.empty() ? "(none)" : value; };
  for (const SettingWords& setting : kSettingWords) {
    if (setting.key != key) continue;
    if (!setting.shows_values) return std::string(setting.words);
    return fmt::format("{} {}, but now it is {}", setting.words, shown(begun), shown(now));
  }
  std::replace(key.begin(), key.end(), '_', ' ');
  return fmt::format("{} {}, but now it is {}", key, shown(begun), shown(now));
}

}  // namespace

SettingList SettingsOfPlan(const LightField& light_field, const PackedStorePlan& plan) {
  const LightFieldIdentity images = IdentityInStore(light_field);
  SettingList settings = {
      {"light_field.images", fmt::format("{}", plan.whole.image_count)},
      {"light_field.names", plan.whole.names},
      {"light_field.calibration", plan.whole.calibration},
      {"images", fmt::format("{}", images.image_count)},
      {"images.names", images.names},
      {"images.calibration", images.calibration},
      {"images.whole_ids", HashOfIds(plan.whole_ids)},
      {"images.rects", HashOfRects(plan.rects)},
      {"codec", plan.codec},
      {"display_levels", TextOf(plan.display_levels)},
      {"shard_bytes", fmt::format("{}", plan.shard_bytes)},
      {kPartsKey, plan.part_count > 0 ? fmt::format("{}", plan.part_count) : ""}};
  if (plan.films) {
    const StoreFilms& films = *plan.films;
    settings.insert(settings.end(),
                    {{"film.lenses", fmt::format("{}", fmt::join(films.lenses, " "))},
                     {"film.lens_weights", films.lens_weights},
                     {"film.frames", fmt::format("{}", films.frame_count)}});
  }
  if (plan.is_predicted) settings.push_back({kPredictedKey, "yes"});
  if (plan.densified) {
    const SettingList densified = SettingsOf(*plan.densified);
    settings.insert(settings.begin(), densified.begin(), densified.end());
  }
  const SettingList pixels = SettingsOfPixels(light_field);
  settings.insert(settings.end(), pixels.begin(), pixels.end());
  return settings;
}

Result<std::optional<StoreFilms>> FilmsOf(const Settings& settings) {
  StoreFilms films;
  std::istringstream lenses(settings.Text("film.lenses"));
  for (std::string hash; lenses >> hash;) films.lenses.push_back(hash);
  if (films.lenses.empty()) return std::optional<StoreFilms>();
  films.lens_weights = settings.Text("film.lens_weights");
  LF_ASSIGN_OR_RETURN(films.frame_count, settings.Whole("film.frames"));
  films.source = settings.Text("light_field");
  return std::optional(std::move(films));
}

std::optional<std::string> FirstDifference(const Settings& settings, const LightField& light_field,
                                           const PackedStorePlan& plan, bool any_shards) {
  if (!plan.densified && !settings.Text(kDensifiedKey).empty())
    return TextOfDifference(kDensifiedKey, settings.Text(kDensifiedKey), "");
  if (!plan.is_predicted && !settings.Text(kPredictedKey).empty())
    return TextOfDifference(kPredictedKey, settings.Text(kPredictedKey), "");
  // Older stores do not state the footprint that the pixels show.
  const auto is_free = [&](const std::string& key) {
    return (any_shards && key == "shard_bytes") ||
           (key == "footprint" && settings.Text(key).empty());
  };
  for (const auto& [key, value] : SettingsOfPlan(light_field, plan))
    if (settings.Text(key) != value && !is_free(key))
      return TextOfDifference(key, settings.Text(key), value);
  return {};
}

}  // namespace lf
