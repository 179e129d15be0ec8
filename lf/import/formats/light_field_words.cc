// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/light_field_words.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <filesystem>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "lf/core/parse_number.h"
#include "lf/core/shell_word.h"
#include "lf/core/spelling.h"
#include "lf/light_field/model/reduction.h"

namespace lf {
namespace {

Result<std::array<double, 3>> ParseBackground(const std::string& text) {
  if (text == "black" || text == kNoBackground) return std::array<double, 3>{0, 0, 0};
  if (text == "white") return std::array<double, 3>{1, 1, 1};
  std::array<double, 3> rgb = {};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (size_t c = 0; c < 3; ++c) {
    const auto [rest, error] = std::from_chars(at, end, rgb[c]);
    const bool is_followed = c == 2 ? rest == end : rest != end && *rest == ',';
    if (error != std::errc() || !is_followed || !(rgb[c] >= 0 && rgb[c] <= 1e6))
      return UsageError(
          fmt::format("{{background {}}}: expected black, white, none, or R,G,B as three numbers "
                      "from 0 to 1e6 in linear light, such as 0.2,0.2,0.3",
                      text));
    at = rest + 1;
  }
  return rgb;
}

// Returns the option of all programs for a member of LightFieldWords.
std::string OptionFor(std::string_view member) { return CommandLineOption({member}); }

// Sets a member by its option. Returns false for an unknown option or value.
bool SetByOption(const std::string& option, const std::string& value, LightFieldWords* words) {
  const auto set_number = [&](double most, double* number) {
    const std::optional<double> parsed = ParseNumber(value);
    if (!parsed || !(*parsed >= 0 && *parsed <= most)) return false;
    *number = *parsed;
    return true;
  };
  const auto set = [&](bool is_valid, std::string* text) {
    if (is_valid) *text = value;
    return is_valid;
  };
  constexpr double kAny = std::numeric_limits<double>::max(), kMostFov = 179;
  if (option == OptionFor("focal_px")) return set_number(kAny, &words->focal_px);
  if (option == OptionFor("fov_deg")) return set_number(kMostFov, &words->fov_deg);
  if (option == OptionFor("time")) {
    words->time = ParseNumber(value);
    return words->time.has_value();
  }
  if (option == OptionFor("recorded_fps")) return set_number(kAny, &words->recorded_fps.emplace());
  if (option == OptionFor("frame_cache")) return set(true, &words->frame_cache);
  if (option == OptionFor("reduce")) {
    double number = 0;
    const bool is_set = set_number(kMostReduction, &number);
    words->reduce = static_cast<int>(number);
    return is_set;
  }
  if (option == OptionFor("images")) return set(true, &words->images);
  if (option == OptionFor("image_scale")) return set(true, &words->image_scale);
  if (option == OptionFor("image_alpha"))
    return set(value == "auto" || AlphaMeaningOf(value), &words->image_alpha);
  if (option == OptionFor("background")) return set(!value.empty(), &words->background);
  return false;
}

}  // namespace

Result<OpenOptions> LightFieldWords::Options() const {
  OpenOptions options;
  options.alpha = AlphaMeaningOf(image_alpha);
  if (!background.empty()) {
    LF_ASSIGN_OR_RETURN(options.background, ParseBackground(background));
    options.keeps_opacity = background == kNoBackground;
  }
  LF_ASSIGN_OR_RETURN(options.image_scale, ParseImageScale(image_scale));
  if (focal_px > 0) options.focal_px = focal_px;
  if (fov_deg > 0) options.fov_deg = fov_deg;
  if (!images.empty()) options.images_folder = images;
  options.time = time;
  options.recorded_fps = recorded_fps;
  options.reduce = reduce;
  if (!frame_cache.empty()) options.frame_cache = frame_cache;
  return options;
}

std::vector<std::string> LightFieldWords::Words() const {
  std::vector<std::string> words;
  const auto add = [&](std::string_view member, std::string value) {
    words.insert(words.end(), {OptionFor(member), std::move(value)});
  };
  if (focal_px > 0) add("focal_px", fmt::format("{}", focal_px));
  if (fov_deg > 0) add("fov_deg", fmt::format("{}", fov_deg));
  if (!images.empty()) add("images", FileArgument(images));
  if (image_scale != "auto") add("image_scale", image_scale);
  if (image_alpha != "auto") add("image_alpha", image_alpha);
  if (!background.empty()) add("background", background);
  if (time) add("time", fmt::format("{}", *time));
  if (recorded_fps) add("recorded_fps", fmt::format("{}", *recorded_fps));
  if (!frame_cache.empty()) add("frame_cache", FileArgument(frame_cache));
  if (reduce != 1) add("reduce", fmt::format("{}", reduce));
  return words;
}

std::vector<std::string> LightFieldWords::WordsToKeep() const {
  LightFieldWords kept = *this;
  for (std::string* const folder : {&kept.images, &kept.frame_cache})
    if (!folder->empty()) *folder = std::filesystem::absolute(*folder).lexically_normal().string();
  return kept.Words();
}

Result<LightFieldWords> LightFieldWords::Of(const std::string& path,
                                            const std::vector<std::string>& words) {
  LightFieldWords read;
  for (size_t i = 0; i < words.size(); i += 2) {
    const std::string value = i + 1 < words.size() ? words[i + 1] : "";
    if (!SetByOption(words[i], value, &read))
      return InputError(
          fmt::format("the options of {} cannot be read again: found '{} {}', expected options of "
                      "LIGHTFIELD, each with its value",
                      path, words[i], value));
  }
  return read;
}

}  // namespace lf
