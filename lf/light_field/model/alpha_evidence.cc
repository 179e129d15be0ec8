// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/alpha_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "lf/light_field/model/alpha_facts.h"
#include "lf/light_field/model/channel_use.h"
#include "lf/light_field/model/image_files.h"
#include "lf/pixels/files/image_file.h"

namespace lf {
namespace {

constexpr size_t kLookedAt = 3;  // number of LF images whose pixels are examined
// Each of the kLookedAt LF images is the first one with a readable header among this many
// successive LF images.
constexpr size_t kAskedFrom = 5;

// Thresholds, chosen on the first half of the drawn captures of doc/judgements.md.
constexpr double kOneColour = 0.97;     // least AlphaFacts::one_colour_share of an object alone
constexpr double kPicture = 0.85;       // largest one_colour_share of a picture that is masked
constexpr double kPictureDetail = 0.2;  // least detail_share of such a picture
constexpr double kSamePixels = 0.98;    // least share of pixels that are transparent in all images
constexpr double kFilled = 0.6;         // least opaque share of images that an object may not fill
// Least number of half-transparent pixels that tell straight from premultiplied, and the shares of
// them up to which colours are straight, and from which they are premultiplied.
constexpr size_t kLeastEdge = 30;
constexpr double kStraight = 0.3, kMultiplied = 0.7;

// Returns the number of pixels that are transparent in both images, as a share of those that are
// transparent in at least one.
double SharedTransparency(const AlphaFacts& a, const AlphaFacts& b) {
  if (a.width != b.width || a.is_transparent.size() != b.is_transparent.size()) return 0;
  size_t both_count = 0;
  for (size_t i = 0; i < a.is_transparent.size(); ++i)
    both_count += a.is_transparent[i] && b.is_transparent[i];
  return static_cast<double>(both_count) /
         static_cast<double>(a.transparent_count + b.transparent_count - both_count);
}

// Returns a share in per cent that is 100 or 0 only if the share is 1 or 0.
std::string Percent(double share) {
  if (share > 0.99 && share < 1) return fmt::format("{:.2f} %", std::min(99.99, 100 * share));
  if (share > 0 && share < 0.01) return fmt::format("{:.2f} %", std::max(0.01, 100 * share));
  return fmt::format("{:.0f} %", 100 * share);
}

// Returns the first LF image with a readable header among the kAskedFrom images from `first` on.
std::optional<LfImageId> ReadableFrom(const LightField& light_field, size_t first,
                                      ImageFileInfo* info) {
  for (size_t i = first; i < std::min(first + kAskedFrom, light_field.size()); ++i) {
    const LfImageId id{static_cast<uint32_t>(i)};
    std::error_code error;
    if (!std::filesystem::exists(ImageFileOf(light_field, id), error)) continue;
    const Result<ImageFileInfo> read = ReadImageInfo(light_field.ImagePath(id));
    if (!read) continue;
    *info = *read;
    return id;
  }
  return std::nullopt;
}

// Measures those examined LF images that have transparent pixels.
std::vector<AlphaFacts> MeasureSome(const LightField& light_field) {
  std::vector<size_t> firsts;
  for (size_t i = 0; i < kLookedAt; ++i)
    firsts.push_back(i * (light_field.size() - 1) / (kLookedAt - 1));
  firsts.erase(std::unique(firsts.begin(), firsts.end()), firsts.end());
  std::vector<AlphaFacts> images;
  std::optional<LfImageId> last;
  for (const size_t first : firsts) {
    ImageFileInfo info;
    const std::optional<LfImageId> id = ReadableFrom(light_field, first, &info);
    if (!id || id == last || !UseOf(info).alpha) continue;
    last = id;
    const Result<StoredImage> image = ReadImage(light_field.ImagePath(*id));
    if (!image) continue;
    AlphaFacts facts = MeasureAlpha(light_field.encoding, *image, UseOf(info));
    facts.image_name = light_field.image_names[id->value];
    if (facts.transparent_count > 0) images.push_back(std::move(facts));
  }
  return images;
}

// Judges whether colours are multiplied by alpha, for images of an object alone. Float files over
// black are premultiplied unless their pixels deny it, because renderers write them so.
void JudgeColours(const AlphaFacts& facts, AlphaEvidence* evidence) {
  const bool is_black = facts.background == std::array<double, 3>{};
  const bool is_rendered = facts.is_float && is_black;
  evidence->meaning = is_rendered ? AlphaMeaning::kPremultiplied : AlphaMeaning::kStraight;
  if (facts.edge_count < kLeastEdge) {
    if (facts.half_count < kLeastEdge || facts.is_float) return;
    evidence->is_sure = false;
    evidence->reason += fmt::format(
        "; but {} pixels are half transparent, and too few of them lie beside opaque ones to tell "
        "whether colours are multiplied by alpha",
        facts.half_count);
    return;
  }
  evidence->reason += fmt::format(
      "; the light of {} of {} half-transparent pixels beside opaque ones is multiplied by alpha",
      Percent(facts.multiplied_share), facts.edge_count);
  if (facts.multiplied_share <= kStraight || !is_black)
    evidence->meaning = AlphaMeaning::kStraight;
  else if (facts.multiplied_share >= kMultiplied)
    evidence->meaning = AlphaMeaning::kPremultiplied;
  else
    evidence->is_sure = false;
}

}  // namespace

std::optional<AlphaEvidence> FindAlphaEvidence(const LightField& light_field) {
  const std::vector<AlphaFacts> images = MeasureSome(light_field);
  if (images.empty()) return std::nullopt;
  const AlphaFacts& facts =
      *std::min_element(images.begin(), images.end(), [](const AlphaFacts& a, const AlphaFacts& b) {
        return a.one_colour_share < b.one_colour_share;
      });
  AlphaEvidence evidence;
  evidence.image_name = facts.image_name;
  double shared = images.size() > 1 ? 1 : 0, opaque = 1;
  for (const AlphaFacts& image : images) {
    shared = std::min(shared, SharedTransparency(facts, image));
    opaque = std::min(opaque, image.opaque_share);
  }
  const bool is_same = shared >= kSamePixels, is_filled = opaque >= kFilled;
  if (is_same && (facts.opaque_spans_image || is_filled)) {
    evidence.reason = fmt::format("{} of the transparent pixels are the same in {} LF images",
                                  Percent(shared), images.size());
    return evidence;
  }
  const bool is_picture = facts.one_colour_share < kPicture;
  evidence.reason =
      fmt::format("{}{} of the {} transparent pixels{} of {} have about one colour",
                  is_picture ? "only " : "", Percent(facts.one_colour_share), facts.inner_count,
                  facts.has_inner ? " away from outlines" : "", facts.image_name);
  if (is_picture) {
    evidence.is_sure = facts.has_inner && facts.detail_share >= kPictureDetail;
    evidence.reason +=
        fmt::format(", and {} differ from the pixel beside them", Percent(facts.detail_share));
    return evidence;
  }
  if (is_filled)
    evidence.reason += fmt::format(
        ", but {} of the pixels or more are opaque, as in photographs of which parts are masked",
        Percent(opaque));
  if (is_filled && !facts.is_float) {  // cameras write no floating-point files with alpha
    evidence.is_sure = false;
    return evidence;
  }
  evidence.is_sure = !is_same && !is_filled && facts.one_colour_share >= kOneColour;
  if (is_same)
    evidence.reason += fmt::format(", but {} of them are the same in {} LF images", Percent(shared),
                                   images.size());
  evidence.background = images[0].background;
  JudgeColours(images[0], &evidence);
  return evidence;
}

}  // namespace lf
