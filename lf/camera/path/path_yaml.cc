// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/path_yaml.h"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "lf/camera/path/evaluate_path.h"
#include "lf/camera/path/path_description.h"
#include "lf/camera/path/read_quantity.h"
#include "lf/camera/path/read_sections.h"
#include "lf/camera/path/yaml_schema.h"
#include "lf/camera/path/yaml_tree.h"
#include "lf/core/file.h"
#include "lf/core/parse_number.h"

namespace lf {
namespace {

// Returns a rate, which may be a fraction, as video programs write rates: 24000/1001.
std::optional<double> ReadRate(const YamlNode& node, YamlErrors* errors) {
  constexpr NumberRange kRates = NumberRange::Within(1e-3, 1e6);
  if (node.kind != YamlNode::Kind::kPlain || node.text.find('/') == std::string::npos)
    return ReadNumber(node, "fps", kRates, errors);
  const std::optional<double> rate = ParseRate(node.text);
  if (rate && kRates.Holds(*rate)) return rate;
  AddExpected(node, "fps", "a rate from 0.001 to 1e+06, such as 24 or 24000/1001", errors);
  return std::nullopt;
}

// Reads the keys `fps`, `frames` and `first_frame`.
void ReadClock(YamlMap* file, PathDescription* path) {
  if (const YamlEntry* fps = file->Require("fps", "fps: 30"))
    path->fps = ReadRate(*fps->value, file->errors()).value_or(30);
  if (const YamlEntry* frames = file->Require("frames", "frames: 60"))
    path->frame_count =
        ReadInteger(*frames->value, "frames", 1, kMostFrames, file->errors()).value_or(1);
  const int largest = static_cast<int>(kLargestFrameNumber) - path->frame_count + 1;
  if (const YamlEntry* first = file->Find("first_frame"))
    path->first_frame =
        ReadInteger(*first->value, "first_frame", 0, largest, file->errors()).value_or(1);
}

void ReadResolution(YamlMap* file, PathDescription* path) {
  const YamlEntry* entry = file->Require("resolution", "resolution: [1920, 1080]");
  if (!entry) return;
  const YamlNode& node = *entry->value;
  if (node.kind != YamlNode::Kind::kSequence || node.items.size() != 2) {
    AddExpected(node, "resolution", "[width, height] in sensor plate elements", file->errors());
    return;
  }
  const auto read = [&](size_t i, const char* label) {
    return ReadInteger(*node.items[i], label, 1, kLargestPlateSide_px, file->errors()).value_or(1);
  };
  path->width_px = read(0, "resolution width");
  path->height_px = read(1, "resolution height");
  if (static_cast<long long>(path->width_px) * path->height_px > kMostPlateElements)
    file->errors()->Add(node.place,
                        fmt::format("resolution: {} x {} is more than {} elements", path->width_px,
                                    path->height_px, kMostPlateElements));
}

void ReadUnit(YamlMap* file, std::optional<double> light_field_unit_m, PathDescription* path) {
  path->unit_m = light_field_unit_m.value_or(1);
  const YamlEntry* entry = file->Find("unit_m");
  if (!entry) return;
  const auto unit_m =
      ReadNumber(*entry->value, "unit_m", NumberRange::Within(1e-9, 1e9), file->errors());
  if (!unit_m) return;
  if (light_field_unit_m && std::abs(*unit_m - *light_field_unit_m) > 1e-6 * *light_field_unit_m)
    file->errors()->Add(entry->value->place,
                        fmt::format("unit_m: {}, but a world unit of the light field is {} m; "
                                    "remove the key, and check the lengths of the path",
                                    *unit_m, *light_field_unit_m));
  if (!light_field_unit_m) path->unit_m = *unit_m;
}

// Reads the key `views`. ReadClock() must have been called.
void ReadViews(YamlMap* file, PathDescription* path) {
  const YamlEntry* entry = file->Find("views");
  if (!entry) return;
  path->views = ReadInteger(*entry->value, "views", 1, kMostViews, file->errors()).value_or(1);
  if (path->frame_count % path->views != 0)
    file->errors()->Add(entry->value->place,
                        fmt::format("views: {} do not divide the {} frames of the path: expected "
                                    "the same number of views of every moment",
                                    path->views, path->frame_count));
}

// Reads the mapping `shutter`. ReadViews() must have been called.
void ReadShutter(YamlMap* file, PathDescription* path) {
  const YamlEntry* entry = file->Find("shutter");
  if (!entry) return;
  YamlErrors* errors = file->errors();
  YamlMap shutter(*entry->value, "shutter", errors);
  const YamlEntry* angle = shutter.Require("angle_deg", "angle_deg: 180");
  const YamlEntry* samples = shutter.Require("samples", "samples: 8");
  shutter.CheckKeys();
  if (!angle || !samples) return;
  path->shutter.angle_deg =
      ReadNumber(*angle->value, "shutter.angle_deg", NumberRange::Within(0, 360), errors)
          .value_or(0);
  path->shutter.samples =
      ReadInteger(*samples->value, "shutter.samples", 1, kMostShutterSamples, errors).value_or(1);
  if (path->shutter.exists() && path->views > 1)
    errors->Add(
        entry->place,
        fmt::format("shutter: the path has {} views of each moment, between which no camera "
                    "moves: remove the shutter",
                    path->views));
  const long long count = static_cast<long long>(path->frame_count) * path->shutter.samples;
  if (path->shutter.exists() && count > kMostInstants)
    errors->Add(entry->place,
                fmt::format("shutter: {} frames with {} samples are {} cameras, more than {}; "
                            "reduce samples, or divide the path",
                            path->frame_count, path->shutter.samples, count, kMostInstants));
}

// Reads the mapping `time`.
void ReadRecordingClock(YamlMap* file, PathDescription* path) {
  const YamlEntry* entry = file->Find("time");
  if (!entry) return;
  YamlErrors* errors = file->errors();
  YamlMap time(*entry->value, "time", errors);
  const auto read = [&](const YamlEntry* value, const char* label, double otherwise) {
    if (!value) return otherwise;
    return ReadNumber(*value->value, label, NumberRange::Within(-1e9, 1e9), errors)
        .value_or(otherwise);
  };
  RecordingClock clock;
  clock.from = read(time.Require("from", "from: 0"), "time.from", clock.from);
  clock.speed = read(time.Find("speed"), "time.speed", clock.speed);
  time.CheckKeys();
  path->recording = clock;
}

// Checks the version of the format, which determines the meaning of all other keys. If the version
// is wrong, no other error is reported.
bool CheckFormat(YamlMap* file) {
  const YamlEntry* format = file->Require("format", "format: lfpath 1");
  return format && ReadWord(*format->value, "format", {"lfpath 1"}, file->errors());
}

PathDescription Describe(const YamlNode& root, std::optional<double> light_field_unit_m,
                         const ReadTransmission& read_transmission, YamlErrors* errors) {
  PathDescription path;
  path.file_name = errors->file_name();
  YamlMap file(root, "", errors);
  if (!errors->empty() || !CheckFormat(&file)) return path;
  ReadClock(&file, &path);
  ReadViews(&file, &path);
  ReadShutter(&file, &path);
  ReadRecordingClock(&file, &path);
  ReadUnit(&file, light_field_unit_m, &path);
  ReadResolution(&file, &path);
  const YamlEntry* camera = file.Require("camera", "camera: {position: [0, 0, -0.4], ...}");
  const YamlEntry* lens = file.Require("lens", "lens: {aperture_diameter_mm: 4, ...}");
  if (const YamlEntry* focus = file.Find("focus")) ReadFocusSection(*focus->value, &path, errors);
  QuantityReader quantities(file.Find("keyframes"), file.Find("accelerations"), path.unit_m,
                            errors);
  file.CheckKeys();
  if (!camera || !lens) return path;
  ReadCameraSection(*camera->value, &quantities, &path, errors);
  ReadLensSection(*lens->value, read_transmission, &quantities, &path, errors);
  quantities.CheckKeys();
  return path;
}

}  // namespace

Result<PathFrames> ParsePathFrames(std::string_view text, std::string_view name,
                                   std::optional<double> light_field_unit_m,
                                   const ReadTransmission& read_transmission) {
  LF_ASSIGN_OR_RETURN(const YamlNodePtr root, ParseYaml(text, name));
  YamlErrors errors(name);
  PathDescription description = Describe(*root, light_field_unit_m, read_transmission, &errors);
  if (!errors.empty()) return errors.First();
  return PathFrames(std::move(description));
}

Result<CameraPath> ParsePathYaml(std::string_view text, std::string_view name,
                                 std::optional<double> light_field_unit_m,
                                 const ReadTransmission& read_transmission) {
  LF_ASSIGN_OR_RETURN(const PathFrames frames,
                      ParsePathFrames(text, name, light_field_unit_m, read_transmission));
  return EvaluatePath(frames);
}

Result<PathFrames> ReadPathFrames(const std::filesystem::path& path,
                                  std::optional<double> light_field_unit_m,
                                  const ReadTransmission& read_transmission) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path, kMaxYamlBytes));
  return ParsePathFrames(text, path.string(), light_field_unit_m, read_transmission);
}

Result<CameraPath> ReadPathYaml(const std::filesystem::path& path,
                                std::optional<double> light_field_unit_m,
                                const ReadTransmission& read_transmission) {
  LF_ASSIGN_OR_RETURN(const PathFrames frames,
                      ReadPathFrames(path, light_field_unit_m, read_transmission));
  return EvaluatePath(frames);
}

}  // namespace lf
