// SPDX-License-Identifier: Apache-2.0
#include "lf/analysis/epi/epipolar_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <utility>

#include "lf/analysis/rectified/rectified_view.h"

namespace lf {
namespace {

constexpr float kNoLight = std::numeric_limits<float>::quiet_NaN();

// A line of the picture: the LF images before and behind its position, as indices into the
// CameraLine, and the weight of the second.
struct LineSource {
  double position_w = 0;
  size_t first = 0;
  size_t second = 0;
  double second_weight = 0;

  size_t nearest() const { return second_weight > 0.5 ? second : first; }
};

std::vector<LineSource> RecordedLines(const CameraLine& line) {
  std::vector<LineSource> sources;
  for (size_t i = 0; i < line.ids.size(); ++i) sources.push_back({line.positions_w[i], i, i, 0});
  return sources;
}

std::vector<LineSource> EvenLines(const CameraLine& line, size_t count, bool is_linear) {
  const double first_w = line.positions_w.front(), last_w = line.positions_w.back();
  std::vector<LineSource> sources;
  size_t behind = 1;
  for (size_t i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count - 1);
    const double position_w = first_w + share * (last_w - first_w);
    while (behind + 1 < line.ids.size() && line.positions_w[behind] < position_w) ++behind;
    const double before_w = line.positions_w[behind - 1], behind_w = line.positions_w[behind];
    double weight = std::clamp((position_w - before_w) / (behind_w - before_w), 0.0, 1.0);
    if (!is_linear) weight = weight > 0.5 ? 1 : 0;
    sources.push_back({position_w, behind - 1, behind, weight});
  }
  return sources;
}

// Loads the line of pixels of each LF image.
class PixelLines {
 public:
  PixelLines(const LightField& light_field, const LfImageStore& store,
             const EpipolarOptions& options, const CameraLine& line)
      : light_field_(light_field),
        store_(store),
        options_(options),
        line_(line),
        view_(PinholeOf(light_field.Camera(options.through).intrinsics)),
        loaded_(line.ids.size()) {
    view_.skew_px = 0;
    // A column is read as a row of the view whose axes are exchanged.
    if (options.kind == LineKind::kColumn) {
      std::swap(view_.fx_px, view_.fy_px);
      std::swap(view_.cx_px, view_.cy_px);
      std::swap(view_.width_px, view_.height_px);
    }
  }

  int length_px() const { return view_.width_px; }
  double focal_px() const { return view_.fx_px; }
  const Image<float>& at(size_t i) const { return loaded_[i]; }
  const std::map<size_t, std::string>& failed() const { return failed_; }

  Result<void> CheckPixel() const {
    if (options_.pixel >= 0 && options_.pixel < view_.height_px) return {};
    return UsageError(fmt::format("the {} {} is not in the view of {}: expected 0 to {}",
                                  options_.kind == LineKind::kRow ? "row" : "column",
                                  options_.pixel, light_field_.image_names[options_.through.value],
                                  view_.height_px - 1));
  }

  Result<void> Load(const std::set<size_t>& wanted, ThreadPool& pool,
                    const std::function<void(size_t, size_t)>& progress) {
    const std::vector<size_t> list(wanted.begin(), wanted.end());
    size_t done = 0;
    pool.ForEach(list.size(), [&](size_t k) {
      if (IsStopped()) return;
      Result<Image<float>> row = LoadRow(list[k]);
      const std::lock_guard lock(mutex_);
      if (row) {
        loaded_[list[k]] = *std::move(row);
      } else {
        machine_.Note(row.error());
        failed_.emplace(list[k], row.error().message);
      }
      if (progress) progress(++done, list.size());
    });
    if (IsStopped()) return Error{ErrorKind::kInterrupted, "interrupted; nothing is written"};
    LF_RETURN_IF_ERROR(machine_.Check());
    if (!failed_.empty() && (options_.strict || failed_.size() == list.size()))
      return InputError(failed_.begin()->second);
    return {};
  }

 private:
  bool IsStopped() const { return options_.stop != nullptr && *options_.stop; }

  Result<Image<float>> LoadRow(size_t i) const {
    const PinholeCamera camera = light_field_.Camera(line_.ids[i]);
    const double shift_px = options_.focus_distance_w
                                ? -view_.fx_px * line_.positions_w[i] / *options_.focus_distance_w
                                : 0;
    const PixelRect rect = {0, options_.pixel, view_.width_px, options_.pixel + 1};
    if (options_.kind == LineKind::kRow)
      return LoadRectified(light_field_, store_, line_.ids[i],
                           RectifiedRays(camera, line_.rotation, view_), rect, shift_px);
    Mat3 exchanged = line_.rotation;
    exchanged.row(0).swap(exchanged.row(1));
    return LoadRectified(light_field_, store_, line_.ids[i],
                         RectifiedRays(camera, exchanged, view_), rect, shift_px);
  }

  const LightField& light_field_;
  const LfImageStore& store_;
  const EpipolarOptions& options_;
  const CameraLine& line_;
  Intrinsics view_;
  std::vector<Image<float>> loaded_;  // one row for each LF image; empty if it is not loaded
  std::mutex mutex_;
  std::map<size_t, std::string> failed_;  // LF images that cannot be loaded, and why
  MachineFailure machine_;
};

// Writes a line of the picture, mixed from the lines of its LF images.
void MixInto(float* to, const PixelLines& lines, const LineSource& source) {
  const size_t count = static_cast<size_t>(lines.length_px()) * 3;
  std::fill_n(to, count, kNoLight);
  const Image<float>& first = lines.at(source.first);
  const Image<float>& second = lines.at(source.second);
  const auto weight = static_cast<float>(source.second_weight);
  if (weight == 0 && !first.empty()) {
    std::copy_n(first.row(0), count, to);
  } else if (weight == 1 && !second.empty()) {
    std::copy_n(second.row(0), count, to);
  } else if (!first.empty() && !second.empty()) {
    for (size_t i = 0; i < count; ++i)
      to[i] = (1 - weight) * first.row(0)[i] + weight * second.row(0)[i];
  }
}

}  // namespace

Result<EpipolarPicture> MakeEpipolarPicture(
    const LightField& light_field, const LfImageStore& store, const EpipolarOptions& options,
    ThreadPool& pool, const std::function<void(size_t done, size_t total)>& progress) {
  if (light_field.encoding.masks_clipped)
    return InputError(
        "the LF images are brackets, of which each shows only a part of the scene: make epipolar "
        "pictures of one exposure ({lfimport exclude} leaves LF images out)");
  EpipolarPicture picture;
  LF_ASSIGN_OR_RETURN(picture.line, FindCameraLine(light_field, options.through, options.kind,
                                                   options.tolerance_w));
  picture.lines = options.lines;
  if (options.lines == EpipolarLines::kAuto)
    picture.lines = picture.line.is_even && !options.line_count ? EpipolarLines::kRecorded
                                                                : EpipolarLines::kNearest;
  const size_t count = options.line_count.value_or(picture.line.ids.size());
  if (count < 2 || count > kMostEpipolarLines)
    return UsageError(fmt::format("{} lines: expected 2 to {}", count, kMostEpipolarLines));
  PixelLines lines(light_field, store, options, picture.line);
  LF_RETURN_IF_ERROR(lines.CheckPixel());
  const std::vector<LineSource> sources =
      picture.lines == EpipolarLines::kRecorded
          ? RecordedLines(picture.line)
          : EvenLines(picture.line, count, picture.lines == EpipolarLines::kLinear);
  std::set<size_t> wanted;
  for (const LineSource& source : sources) {
    if (source.second_weight < 1) wanted.insert(source.first);
    if (source.second_weight > 0) wanted.insert(source.second);
  }
  LF_RETURN_IF_ERROR(lines.Load(wanted, pool, progress));
  picture.focal_px = lines.focal_px();
  picture.light = Image<float>(lines.length_px(), static_cast<int>(sources.size()), 3);
  for (size_t i = 0; i < sources.size(); ++i) {
    MixInto(picture.light.row(static_cast<int>(i)), lines, sources[i]);
    picture.positions_w.push_back(sources[i].position_w);
    picture.ids.push_back(picture.line.ids[sources[i].nearest()]);
  }
  for (const auto& [i, reason] : lines.failed()) picture.missing.push_back(picture.line.ids[i]);
  if (!lines.failed().empty()) picture.first_reason = lines.failed().begin()->second;
  return picture;
}

}  // namespace lf
