// SPDX-License-Identifier: Apache-2.0
#include "lf/render/settings/setting_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "lf/core/geometry.h"
#include "lf/core/parse_number.h"
#include "lf/render/settings/interpolation.h"
#include "lf/render/settings/setting_rows.h"

namespace lf {
namespace {

bool IsBilinear(const FilmSettings& film) { return film.reading.estimator == Estimator::kBilinear; }

// Returns the angle in degrees, without the rounding errors of a conversion there and back: 60, not
// 59.99999999999999.
double DegreesOf(double angle_rad) {
  const double degrees = DegreesFromRadians(angle_rad);
  const double rounded = ParseNumber(fmt::format("{:.14g}", degrees)).value_or(degrees);
  return RadiansFromDegrees(rounded) == angle_rad ? rounded : degrees;
}

void AddPictureRows(std::vector<Setting>& rows) {
  rows.push_back(Choice(
      {.key = "mode",
       .text =
           "How frames are made from recorded rays\n"
           "collect: frames are averages of the recorded rays\n"
           "rebin: frames are made of rays that are kept in memory, interpolated where some are "
           "missing\n"
           "hybrid: frames are collected; where no recorded ray passes the lens, they are "
           "interpolated"},
      LF_MEMBER(mode), Named({RenderMode::kCollect, RenderMode::kRebin, RenderMode::kHybrid})));
  // "auto" is bilinear, the first word with this value, and comes first for get().
  Setting estimator =
      Choice({.key = "estimator",
              .text = "How LF pixels contribute to elements\n"
                      "An element is a pixel of the frame before it is developed.\n"
                      "auto, bilinear: every element reads each LF image at the point that "
                      "it sees, interpolated as {filter} says\n"
                      "nearest: every LF pixel is added to one element; mosaics are not "
                      "interpolated"},
             LF_MEMBER(reading.estimator),
             Words<Estimator>{{"auto", Estimator::kBilinear},
                              {"nearest", Estimator::kNearest},
                              {"bilinear", Estimator::kBilinear}});
  estimator.recorded = [](const FilmSettings& film) { return NameOf(film.reading.estimator); };
  rows.push_back(std::move(estimator));
  rows.push_back(Choice(
      {.key = "filter",
       .matters = IsBilinear,
       .text =
           "Interpolation between LF pixels\n"
           "Used by {estimator bilinear}.\n"
           "auto: mosaic for mosaics, bicubic for brackets (LF images of one pose with different "
           "exposures), otherwise prefiltered\n"
           "prefiltered: each LF image is first filtered for the size of elements, then "
           "interpolated linearly; sharper than bicubic and faster\n"
           "mosaic: for mosaics; like prefiltered, after a correction that depends on how many LF "
           "images an element averages"},
      LF_MEMBER(reading.filter),
      Named({PixelFilter::kAuto, PixelFilter::kNearest, PixelFilter::kBilinear,
             PixelFilter::kBicubic, PixelFilter::kMosaic, PixelFilter::kPrefiltered})));
  rows.push_back(
      Choice({.key = "lf_pixels",
              .matters = IsBilinear,
              .text = "What LF pixels show, for {filter prefiltered} and mosaic\n"
                      "areas: the mean light of their area, as in photographs\n"
                      "points: the light of their centre, as in renders without anti-aliasing\n"
                      "auto: as lf_pixels of the light field says, otherwise measured"},
             LF_MEMBER(reading.footprint),
             Words<std::optional<PixelFootprint>>{{"auto", std::nullopt},
                                                  {"areas", PixelFootprint::kArea},
                                                  {"points", PixelFootprint::kPoint}}));
  rows.push_back(Choice(
      {.key = "lens_weights",
       .text = "Weight of each LF image in a frame\n"
               "none: all LF images have the same weight\n"
               "area: the weight of an LF image is the area of the lens that is nearer to its LF "
               "camera than to any other\n"
               "hat: interpolation between the nearest LF images, for small lenses and pinholes\n"
               "auto: area for large lenses, hat for small ones, a mix of both in between"},
      LF_MEMBER(lens_weights),
      Named({LensWeights::kAuto, LensWeights::kNone, LensWeights::kArea, LensWeights::kHat})));
  rows.push_back(Switch(
      {.key = "guard",
       .matters = [](const FilmSettings& film) { return film.guard; },
       .text = "Show recorded LF images alone where a frame is in focus\n"
               "Concerns frames of densified light fields. off: they show the rays of all LF "
               "images everywhere, those of virtual ones included."},
      LF_MEMBER(guard)));
  Setting fill = {
      .key = "fill",
      .role = SettingRole::kPicture,
      .placeholder = "RADIUS|off",
      .text =
          "Radius for filling elements without rays, in elements\n"
          "An element without rays gets the mean light of collected elements at most RADIUS "
          "elements away, or black if there is none. Its coverage stays below 1.\n"
          "off: elements without rays are black"};
  fill.get = [](const FilmSettings& film) { return fmt::format("{}", film.fill_radius_px); };
  fill.set = [](const std::string& text, FilmSettings* film) -> Result<void> {
    const std::optional<int> radius_px = text == "off" ? 0 : ParseWhole<int>(text);
    if (!radius_px || *radius_px < 0 || *radius_px > kMostFillRadius_px)
      return UsageError(
          fmt::format("{{fill {}}}: expected a number of elements from 0 to {}, or off", text,
                      kMostFillRadius_px));
    film->fill_radius_px = *radius_px;
    return {};
  };
  rows.push_back(std::move(fill));
  rows.push_back(
      Plain({.key = "smooth_below",
             .role = SettingRole::kPicture,
             .placeholder = "N",
             .text = "Smooth elements with fewer rays than this (none)\n"
                     "Such an element is averaged with its neighbours, up to 32 elements away."},
            LF_MEMBER(smooth_below)));
}

void AddQualityRows(std::vector<Setting>& rows) {
  rows.push_back(ZeroIfUnset(
      {.key = "max_images",
       .is_in_packages = true,
       .placeholder = "N",
       .text = "Maximum number of LF images per frame (all)\n"
               "A frame uses the first N of the LF images that contribute to it, in the order of "
               "{order}."},
      LF_MEMBER(max_image_count)));
  rows.push_back(ZeroIfUnset(
      {.key = "max_angle_deg",
       .is_in_packages = true,
       .placeholder = "DEGREES",
       .most = 180,
       .text = "Largest angle between LF camera and frame axes (no limit)\n"
               "A frame uses only LF cameras whose optical axis is within DEGREES of its own "
               "optical axis."},
      LF_MEMBER(max_angle_rad), DegreesOf, RadiansFromDegrees));
  rows.push_back(Choice(
      {.key = "order",
       .is_in_packages = true,
       .text = "Order in which frames take LF images\n"
               "The order matters if {max_images} or {stop_when} end a frame early.\n"
               "spread: LF images whose positions are spread evenly over the lens, however many "
               "are taken; by {seed}\n"
               "shuffle: random, by {seed}\n"
               "round-robin: always an LF image for the frame with the fewest rays\n"
               "area: LF images with the most rays first\n"
               "groups: groups of neighbours one after another, by {seed}; predicted LF images of "
               "packed stores are then decoded with little memory"},
      LF_MEMBER(order),
      Named({ImageOrder::kSpread, ImageOrder::kShuffle, ImageOrder::kRoundRobin, ImageOrder::kArea,
             ImageOrder::kGroups})));
  rows.push_back(Plain({.key = "seed",
                        .is_in_packages = true,
                        .placeholder = "N",
                        .text = "Seed of {order} and {kept edges}"},
                       LF_MEMBER(seed)));
  rows.push_back(Rule(
      {.key = "stop_when",
       .placeholder = "RULE",
       .text =
           "Finish a frame early: noise<=X or samples>=N\n"
           "noise<=X: the frame is finished when at least 90 % of the elements that LF images see "
           "have a noise of at most X. The noise of an element is the standard error of its mean, "
           "in linear light where white is 1; 0.002 is half an 8-bit level in a mid-grey. With "
           "{order spread} it is a bound, and frames are nearer to those of all LF images. Works "
           "with every {mode} and all {lens_weights}. With {mode rebin} it needs 24 bytes of "
           "memory for each element of every frame.\n"
           "samples>=N: the frame is finished when at least 99 % of the elements that LF images "
           "see have N rays in every colour channel. {lens_weights auto} then means none."},
      LF_MEMBER(stop_when)));
  rows.push_back(Rule(
      {.key = "require",
       .role = SettingRole::kMeasuring,
       .placeholder = "RULE",
       .text = "Exit with code 6 unless noise<=X or samples>=N\n"
               "The rules are those of {stop_when}. The exit code is 6 if a finished frame has "
               "more noise or fewer rays than the rule says."},
      LF_MEMBER(require)));
}

void AddMeasuringRows(std::vector<Setting>& rows) {
  rows.push_back(Choice({.key = "back_end",
                         .text = "Implementation of the ray model\n"
                                 "fast: the quick implementation\n"
                                 "reference: the formulas applied literally, one ray at a time"},
                        LF_MEMBER(back_end),
                        Words<CollectBackEnd>{{"fast", CollectBackEnd::kFast},
                                              {"reference", CollectBackEnd::kReference}}));
  rows.push_back(Plain({.key = "nearest",
                        .placeholder = "N",
                        .most = 1000,
                        .text = "Interpolate from the N nearest rays (all within 3 sigma)\n"
                                "Needs {back_end reference}, and chooses {interpolation cells}. "
                                "The N nearest rays are used at any distance. 0: "
                                "all rays within three times {sigma_st} and {sigma_uv} are used."},
                       LF_MEMBER(rebin.nearest)));
  rows.push_back(Plain(
      {.key = "coverage_cells",
       .placeholder = "N",
       .least = 4,
       .most = 1024,
       .text = "Cells of the coverage map across a frame\n"
               "The coverage map finds rays that no frame needs, so that they are not kept. "
               "A map of more cells finds more of these rays. Another number than the default "
               "chooses {interpolation cells}."},
      LF_MEMBER(rebin.coverage.cells_across)));
}

}  // namespace

std::span<const Setting> SettingTable() {
  static const std::vector<Setting> rows = [] {
    std::vector<Setting> made;
    const auto add = [&made](SettingGroup group, void (*add_rows)(std::vector<Setting>&)) {
      const size_t begin = made.size();
      add_rows(made);
      for (size_t i = begin; i < made.size(); ++i) made[i].group = group;
    };
    add(SettingGroup::kPicture, AddPictureRows);
    add(SettingGroup::kQuality, AddQualityRows);
    const size_t begin_of_rebinning = made.size();
    add(SettingGroup::kRebinning, AddRebinRows);
    for (size_t i = begin_of_rebinning; i < made.size(); ++i)
      made[i].matters = [](const FilmSettings& film) { return film.Rebins(); };
    add(SettingGroup::kMeasuring, AddMeasuringRows);
    for (Setting& setting : made)
      if (IsOfCells(setting.key)) setting.matters = KeepsCells;
    return made;
  }();
  return rows;
}

const Setting* FindSetting(std::string_view key) {
  const std::span<const Setting> rows = SettingTable();
  const auto row = std::find_if(rows.begin(), rows.end(),
                                [key](const Setting& setting) { return setting.key == key; });
  return row == rows.end() ? nullptr : &*row;
}

SettingTexts TextsOf(const FilmSettings& film, SettingRole role) {
  SettingTexts texts;
  for (const Setting& setting : SettingTable()) {
    if (setting.role != role || !setting.matters(film)) continue;
    std::string text = setting.recorded ? setting.recorded(film) : setting.get(film);
    const bool is_unset = text.empty() || (setting.is_optional && text == "0");
    if (!is_unset) texts.emplace_back(setting.key, std::move(text));
  }
  return texts;
}

}  // namespace lf
