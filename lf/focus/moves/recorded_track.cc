// SPDX-License-Identifier: Apache-2.0
#include "lf/focus/moves/recorded_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "lf/core/parse_number.h"
#include "lf/light_field/model/capture_geometry.h"

namespace lf {
namespace {

// A name of an LF image: the last number in its last part, without suffix, and what stands around
// it.
struct NumberedName {
  std::string_view before, after;
  uint64_t number = 0;
};

std::optional<NumberedName> Numbered(std::string_view name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const size_t slash = name.find_last_of('/');
  const size_t begin = slash == std::string_view::npos ? 0 : slash + 1;
  const size_t dot = name.find_last_of('.');
  size_t end = dot == std::string_view::npos || dot < begin ? name.size() : dot;
  while (end > begin && !is_digit(name[end - 1])) --end;
  size_t first = end;
  while (first > begin && is_digit(name[first - 1])) --first;
  const std::optional<uint64_t> number = ParseWhole<uint64_t>(name.substr(first, end - first));
  if (!number) return std::nullopt;
  return NumberedName{name.substr(0, first), name.substr(end), *number};
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct SequenceImage {
  uint64_t number = 0;
  LfImageId id;
  Vec3 position_world;
};

// Returns the LF images whose names differ from that of `id` in the last number alone, in the order
// of these numbers.
std::vector<SequenceImage> SequenceOf(const LightField& light_field, LfImageId id) {
  const std::optional<NumberedName> own = Numbered(light_field.image_names[id.value]);
  std::vector<SequenceImage> sequence;
  if (!own) return sequence;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const std::optional<NumberedName> name = Numbered(light_field.image_names[i]);
    if (name && name->before == own->before && name->after == own->after)
      sequence.push_back({name->number, {i}, light_field.Camera({i}).CentreWorld()});
  }
  std::sort(sequence.begin(), sequence.end(),
            [](const auto& a, const auto& b) { return a.number < b.number; });
  // Several LF images may have one position: a camera at rest, or brackets. The one that was asked
  // for is kept.
  std::vector<SequenceImage> moving;
  for (const SequenceImage& image : sequence) {
    if (moving.empty() || moving.back().position_world != image.position_world)
      moving.push_back(image);
    else if (image.id == id)
      moving.back() = image;
  }
  return moving;
}

// Returns the share of the LF cameras of a track beside which the track passes again: where another
// LF camera is about as near as the next one, although it is far away along the track.
double ShareBeside(const RecordedTrack& track) {
  // A mean over neighbours removes the shaking of the hand, which makes a slow track long.
  const size_t count = track.images.size();
  std::vector<Vec3> points(count);
  for (size_t i = 0; i < count; ++i) {
    const size_t first = i < 2 ? 0 : i - 2, last = std::min(count - 1, i + 2);
    points[i] = Vec3::Zero();
    for (size_t k = first; k <= last; ++k)
      points[i] += track.positions_world[k] / static_cast<double>(last - first + 1);
  }
  std::vector<double> places_w = {0}, steps_w;
  for (size_t i = 1; i < count; ++i) {
    steps_w.push_back((points[i] - points[i - 1]).norm());
    places_w.push_back(places_w.back() + steps_w.back());
  }
  const double step_w = MedianOf(steps_w);
  constexpr double kNear = 2, kFarAlong = 3.5;
  constexpr size_t kSamples = 200;
  const size_t stride = std::max<size_t>(1, count / kSamples);
  size_t tested = 0, beside = 0;
  for (size_t i = 0; i < count; i += stride, ++tested)
    for (size_t k = 0; k < count; ++k) {
      const double distance_w = (points[k] - points[i]).norm();
      if (distance_w > kNear * step_w ||
          std::abs(places_w[k] - places_w[i]) < kFarAlong * std::max(distance_w, step_w))
        continue;
      ++beside;
      break;
    }
  return static_cast<double>(beside) / static_cast<double>(tested);
}

}  // namespace

Result<RecordedTrack> FindTrack(const LightField& light_field, LfImageId id) {
  const std::vector<SequenceImage> sequence = SequenceOf(light_field, id);
  constexpr size_t kLeastImages = 3;
  const std::string& name = light_field.image_names[id.value];
  if (sequence.size() < kLeastImages)
    return InputError(fmt::format(
        "there is no recorded track through LF camera {}: {} LF image(s) have names that differ "
        "from {} in the last number alone, at different positions, expected {} or more",
        id.value, sequence.size(), name, kLeastImages));
  std::vector<double> steps_w, speeds_w;  // from each LF image to the next; by their numbers
  for (size_t i = 0; i + 1 < sequence.size(); ++i) {
    steps_w.push_back((sequence[i + 1].position_world - sequence[i].position_world).norm());
    const uint64_t difference = sequence[i + 1].number - sequence[i].number;
    speeds_w.push_back(steps_w.back() / static_cast<double>(std::max<uint64_t>(1, difference)));
  }
  const double median_w = MedianOf(steps_w), spacing_w = MedianSpacing(light_field);
  constexpr double kMostSpacings = 3;
  if (median_w > kMostSpacings * spacing_w)
    return InputError(fmt::format(
        "there is no recorded track: LF cameras that follow each other in the order of their "
        "names, such as {}, are {:.3g} apart in world units, and other LF cameras {:.3g}",
        name, median_w, spacing_w));
  const auto is_gap = [&](size_t i) {
    constexpr double kJump = 2, kFar = 8;
    double beside_w = 0;
    if (i > 0) beside_w = std::max(beside_w, speeds_w[i - 1]);
    if (i + 1 < speeds_w.size()) beside_w = std::max(beside_w, speeds_w[i + 1]);
    return steps_w[i] > kFar * median_w ||
           (speeds_w[i] > kJump * beside_w && steps_w[i] > kJump * median_w);
  };
  const auto of_id = std::find_if(sequence.begin(), sequence.end(),
                                  [&](const SequenceImage& image) { return image.id == id; });
  if (of_id == sequence.end())
    return InputError(fmt::format(
        "there is no recorded track through LF camera {} ({}): another LF image of the sequence "
        "has its position",
        id.value, name));
  const size_t at = static_cast<size_t>(of_id - sequence.begin());
  size_t first = at, last = at;
  while (first > 0 && !is_gap(first - 1)) --first;
  while (last + 1 < sequence.size() && !is_gap(last)) ++last;
  if (last - first + 1 < kLeastImages)
    return InputError(fmt::format(
        "there is no recorded track: only {} LF image(s) around {} follow each other without a "
        "gap in the order of their names, expected {} or more",
        last - first + 1, name, kLeastImages));
  RecordedTrack track;
  track.at = at - first;
  track.neighbour_w = median_w;
  for (size_t i = first; i <= last; ++i) {
    track.images.push_back(sequence[i].id);
    track.positions_world.push_back(sequence[i].position_world);
    track.places_w.push_back(i == first ? 0 : track.places_w.back() + steps_w[i - 1]);
  }
  return track;
}

bool IsDenseTrack(const LightField& light_field, const RecordedTrack& track,
                  double focus_distance_w) {
  constexpr size_t kLeastImages = 12;
  constexpr double kMostOfExtent = 1 / 12.0, kMostAngle_deg = 3, kMostBeside = 0.3;
  if (track.images.size() < kLeastImages || track.images.size() * 2 < light_field.size())
    return false;
  Eigen::AlignedBox3d box;
  for (const Vec3& position : track.positions_world) box.extend(position);
  return track.neighbour_w <= kMostOfExtent * box.diagonal().norm() &&
         track.neighbour_w <= RadiansFromDegrees(kMostAngle_deg) * focus_distance_w &&
         ShareBeside(track) <= kMostBeside;
}

SmoothTrack::Point SmoothTrack::At(double place_w) const {
  // The line a + b x that minimises the weighted sum of squared distances, by its sums.
  double sum = 0, sum_x = 0, sum_xx = 0;
  Vec3 sum_p = Vec3::Zero(), sum_xp = Vec3::Zero();
  for (size_t i = 0; i < track_.places_w.size(); ++i) {
    const double x = (track_.places_w[i] - place_w) / sigma_w_;
    const double weight = std::exp(-x * x / 2);
    const Vec3 p = track_.positions_world[i] - track_.positions_world[track_.at];
    sum += weight;
    sum_x += weight * x;
    sum_xx += weight * x * x;
    sum_p += weight * p;
    sum_xp += weight * x * p;
  }
  const double determinant = sum * sum_xx - sum_x * sum_x;
  const Vec3& origin = track_.positions_world[track_.at];
  constexpr double kSingular = 1e-12;
  if (!(determinant > kSingular * sum * sum)) return {origin + sum_p / sum, Vec3::Zero()};
  const Vec3 a = (sum_xx * sum_p - sum_x * sum_xp) / determinant;
  const Vec3 b = (sum * sum_xp - sum_x * sum_p) / determinant;
  return {origin + a, b.norm() > 0 ? Vec3(b.normalized()) : Vec3(Vec3::Zero())};
}

}  // namespace lf
