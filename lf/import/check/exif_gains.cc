// SPDX-License-Identifier: Apache-2.0
#include "lf/import/check/exif_gains.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lf/light_field/model/brackets.h"

namespace lf {
namespace {

constexpr float kLeastGain = 1e-6F, kMostGain = 1e6F;

// Returns the parts of the exposure that a file does not state, as a text that continues the word
// "no", such as "exposure time and no f-number"; "" if the file states all parts.
std::string MissingOf(const ExposureFacts& facts, bool wants_f_number) {
  std::vector<const char*> missing;
  if (!facts.time_s) missing.push_back("exposure time");
  if (wants_f_number && !facts.f_number) missing.push_back("f-number");
  if (!facts.iso) missing.push_back("ISO sensitivity");
  return fmt::format("{}", fmt::join(missing, " and no "));
}

// Returns kInput if an LF image does not state its exposure. The message names the first such LF
// image and says how many there are.
Result<void> CheckAllAreStated(std::span<const StatedExposure> stated,
                               const LightField& light_field, bool wants_f_number) {
  size_t fault_count = 0;
  const StatedExposure* first = nullptr;
  for (const StatedExposure& one : stated) {
    if (one.fault.empty() && MissingOf(one.facts, wants_f_number).empty()) continue;
    if (!first) first = &one;
    ++fault_count;
  }
  if (!first) return {};
  if (!first->fault.empty())
    return InputError(
        fmt::format("{{gain_from_exif}}: {}; {} of {} images do not state their exposure: leave "
                    "these images out ({{exclude}})",
                    first->fault, fault_count, stated.size()));
  return InputError(fmt::format(
      "{{gain_from_exif}}: {}: states no {} ({} of {} images lack such values); expected exposure "
      "time, f-number and ISO sensitivity in the Exif data of a JPEG, TIFF or PNG file, or in a "
      "camera raw file: copy the Exif data from the original photographs, state lf_gain in "
      "transforms.json, or estimate it with {{match_exposure}}",
      light_field.ImagePath(first->id).string(), MissingOf(first->facts, wants_f_number),
      fault_count, stated.size()));
}

}  // namespace

std::vector<StatedExposure> ReadStatedExposures(const LightField& light_field,
                                                std::span<const LfImageId> ids, ThreadPool& pool) {
  std::vector<StatedExposure> stated(ids.size());
  pool.ForEach(ids.size(), [&](size_t i) {
    stated[i].id = ids[i];
    const Result<ExposureFacts> facts = ReadExposureFacts(light_field.ImagePath(ids[i]));
    if (facts)
      stated[i].facts = *facts;
    else
      stated[i].fault = facts.error().message;
  });
  return stated;
}

double LightOf(const ExposureFacts& facts) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const double f_number = facts.f_number.value_or(1);
  return facts.time_s.value_or(kNone) * facts.iso.value_or(kNone) / (f_number * f_number);
}

Result<ExifGains> GainFromExif(std::span<const StatedExposure> stated, LightField* light_field) {
  LF_CHECK(stated.size() == light_field->size() && !stated.empty());
  ExifGains found;
  found.image_count = stated.size();
  // Files state no f-number if the lens has no electrical contacts.
  found.has_f_numbers = std::any_of(stated.begin(), stated.end(), [](const StatedExposure& one) {
    return one.facts.f_number.has_value();
  });
  LF_RETURN_IF_ERROR(CheckAllAreStated(stated, *light_field, found.has_f_numbers));
  std::vector<std::pair<double, uint32_t>> ascending;
  for (uint32_t i = 0; i < stated.size(); ++i) ascending.emplace_back(LightOf(stated[i].facts), i);
  const auto middle = ascending.begin() + static_cast<ptrdiff_t>((ascending.size() - 1) / 2);
  std::nth_element(ascending.begin(), middle, ascending.end());
  const auto [reference, reference_id] = *middle;
  found.reference = LfImageId{reference_id};
  std::vector<float> gains;
  for (uint32_t i = 0; i < stated.size(); ++i) {
    const auto gain = static_cast<float>(reference / LightOf(stated[i].facts));
    if (!(gain >= kLeastGain && gain <= kMostGain))
      return InputError(fmt::format(
          "{{gain_from_exif}}: {}: its exposure is {:.3g} times that of {}; expected a factor from "
          "1e-6 to 1e6: leave the first of these two images out ({{exclude}})",
          light_field->ImagePath(LfImageId{i}).string(), 1 / gain,
          light_field->ImagePath(found.reference).string()));
    gains.push_back(gain);
  }
  for (size_t i = 0; i < gains.size(); ++i) light_field->cameras[i].gain = gains[i];
  const auto [least, most] = std::minmax_element(gains.begin(), gains.end());
  found.least_gain = *least;
  found.most_gain = *most;
  MakeRoomForGains(light_field);
  return found;
}

}  // namespace lf
