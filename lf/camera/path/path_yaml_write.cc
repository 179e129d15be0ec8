// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/path_yaml_write.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "lf/camera/path/path_description.h"
#include "lf/camera/path/path_yaml.h"

namespace lf {
namespace {

constexpr double kEqualOptics = 1e-12;  // relative difference of field of view and focal length

// A quantity of the file, with the text of its value in each frame.
struct YamlQuantity {
  std::string key;
  std::vector<std::string> values;
  std::vector<bool> jumps = {};  // true where the value cannot be interpolated; may be empty

  bool Moves() const {
    return std::any_of(values.begin(), values.end(),
                       [&](const std::string& value) { return value != values[0]; });
  }
};

using ValueText = std::function<std::string(const RenderCamera&)>;

YamlQuantity QuantityOf(const CameraPath& path, const char* key, const ValueText& text) {
  YamlQuantity quantity{key, {}};
  quantity.values.reserve(path.frame_count());
  for (const RenderCamera& camera : path.cameras) quantity.values.push_back(text(camera));
  return quantity;
}

std::string PointText(const Vec3& point) {
  // The sum with 0 makes 0 of -0.
  return fmt::format("[{}, {}, {}]", point.x() + 0.0, point.y() + 0.0, point.z() + 0.0);
}

Eigen::Quaterniond WorldFromCamOf(const RenderCamera& camera) {
  return Eigen::Quaterniond(Mat3(camera.pinhole.cam_from_world.rotation.transpose()));
}

YamlQuantity Orientation(const CameraPath& path) {
  YamlQuantity quantity = QuantityOf(path, "quaternion", [](const RenderCamera& camera) {
    const Eigen::Quaterniond q = WorldFromCamOf(camera);
    return fmt::format("[{}, {}, {}, {}]", q.w(), q.x(), q.y(), q.z());
  });
  // Half a turn between two frames has no shorter arc.
  constexpr double kHalfTurn = 1e-6;
  quantity.jumps.assign(path.frame_count(), false);
  for (size_t i = 1; i < path.frame_count(); ++i)
    quantity.jumps[i] =
        std::abs(WorldFromCamOf(path.cameras[i - 1]).dot(WorldFromCamOf(path.cameras[i]))) <
        kHalfTurn;
  return quantity;
}

// Width of the sensor that gives the field of view with the focal length.
double EffectiveSensorWidth(const RenderCamera& camera) {
  const Intrinsics& k = camera.pinhole.intrinsics;
  return k.width_px * camera.focal_length_w / k.fx_px;
}

// Returns true if the sensor width is the same in all frames and gives the field of view.
bool HasOneSensor(const CameraPath& path) {
  const double width_w = path.cameras[0].sensor_width_w;
  return std::all_of(path.cameras.begin(), path.cameras.end(), [&](const RenderCamera& camera) {
    return camera.sensor_width_w == width_w &&
           std::abs(EffectiveSensorWidth(camera) - width_w) <= kEqualOptics * width_w;
  });
}

std::string PairText(const Vec2& pair) {
  return fmt::format("{{horizontal: {}, vertical: {}}}", pair.x() + 0.0, pair.y() + 0.0);
}
constexpr std::string_view kNoPair = "{horizontal: 0, vertical: 0}";

// Appends a quantity, unless it is `unused` in all frames.
void AddIfUsed(YamlQuantity quantity, std::string_view unused, std::vector<YamlQuantity>* section) {
  if (quantity.Moves() || quantity.values[0] != unused) section->push_back(std::move(quantity));
}

// Returns focal length and sensor width if there is one sensor, otherwise focal length and field of
// view, which together imply the sensor width; and the shift, which that width scales.
std::vector<YamlQuantity> Optics(const CameraPath& path) {
  std::vector<YamlQuantity> optics = {QuantityOf(
      path, "focal_length",
      [](const RenderCamera& camera) { return fmt::format("{}", camera.focal_length_w); })};
  const bool has_one_sensor = HasOneSensor(path);
  if (has_one_sensor)
    optics.push_back(QuantityOf(path, "sensor_width", [](const RenderCamera& camera) {
      return fmt::format("{}", camera.sensor_width_w);
    }));
  else
    optics.push_back(QuantityOf(path, "field_of_view_deg", [](const RenderCamera& camera) {
      const Intrinsics& k = camera.pinhole.intrinsics;
      return fmt::format("{}", DegreesFromRadians(2 * std::atan(k.width_px / (2 * k.fx_px))));
    }));
  AddIfUsed(QuantityOf(path, "shift",
                       [has_one_sensor](const RenderCamera& camera) {
                         RenderCamera written = camera;
                         if (!has_one_sensor) written.sensor_width_w = EffectiveSensorWidth(camera);
                         return PairText(ShiftOf(written));
                       }),
            kNoPair, &optics);
  return optics;
}

std::vector<YamlQuantity> CameraSection(const CameraPath& path) {
  std::vector<YamlQuantity> section = Optics(path);
  section.push_back(QuantityOf(path, "position", [](const RenderCamera& camera) {
    return PointText(camera.pinhole.CentreWorld());
  }));
  section.push_back(Orientation(path));
  return section;
}

std::vector<YamlQuantity> LensSection(const CameraPath& path) {
  std::vector<YamlQuantity> section = {
      QuantityOf(path, "aperture_diameter",
                 [](const RenderCamera& c) { return fmt::format("{}", 2 * c.aperture.radius_w); }),
      QuantityOf(path, "focus_distance",
                 [](const RenderCamera& c) { return fmt::format("{}", c.focus_distance_w); })};
  AddIfUsed(QuantityOf(path, "focus_tilt_deg",
                       [](const RenderCamera& c) {
                         return PairText({DegreesFromRadians(c.focus_tilt.horizontal_rad),
                                          DegreesFromRadians(c.focus_tilt.vertical_rad)});
                       }),
            kNoPair, &section);
  AddIfUsed(QuantityOf(path, "blade_rotation_deg",
                       [](const RenderCamera& c) {
                         return fmt::format("{}", DegreesFromRadians(c.aperture.rotation_rad));
                       }),
            "0", &section);
  return section;
}

// Adds the quantities that rest. `more` are further lines.
void AddSection(const char* name, const std::vector<YamlQuantity>& section, const std::string& more,
                std::string* text) {
  std::string lines;
  for (const YamlQuantity& quantity : section)
    if (!quantity.Moves()) lines += fmt::format("  {}: {}\n", quantity.key, quantity.values[0]);
  lines += more;
  *text += fmt::format("{}:{}\n{}", name, lines.empty() ? " {}" : "", lines);
}

void AddKeyframes(const CameraPath& path, const std::vector<YamlQuantity>& section,
                  std::string* text) {
  for (const YamlQuantity& quantity : section) {
    if (!quantity.Moves()) continue;
    *text += fmt::format("  {}:\n", quantity.key);
    for (size_t i = 0; i < quantity.values.size(); ++i)
      *text += fmt::format(
          "  - {{time: {}, value: {}{}}}\n", static_cast<double>(i) / path.fps, quantity.values[i],
          !quantity.jumps.empty() && quantity.jumps[i] ? ", interpolation: step" : "");
  }
}

bool AnyMoves(const std::vector<YamlQuantity>& section) {
  return std::any_of(section.begin(), section.end(),
                     [](const YamlQuantity& quantity) { return quantity.Moves(); });
}

// Returns the lines of the opening's shape and of the hood, which cannot move.
std::string ShapeText(const RenderCamera& camera) {
  const Aperture& aperture = camera.aperture;
  std::string text;
  if (aperture.blades > 0) text += fmt::format("  blades: {}\n", aperture.blades);
  if (aperture.roundness != 0) text += fmt::format("  blade_roundness: {}\n", aperture.roundness);
  if (aperture.ratio != 1) text += fmt::format("  ratio: {}\n", aperture.ratio);
  if (camera.hood.exists())
    text += fmt::format("  hood_distance: {}\n  hood_diameter: {}\n", camera.hood.distance_w,
                        2 * camera.hood.radius_w);
  if (camera.transmission)
    text += fmt::format("  transmission: \"{}\"\n", camera.transmission->Text());
  return text;
}

// Returns true if two cameras have the same quantities of ShapeText(), but for rounding errors.
bool HaveOneShape(const RenderCamera& a, const RenderCamera& b) {
  const auto agree = [](double x, double y) {
    return std::abs(x - y) <= kEqualOptics * std::max(std::abs(x), std::abs(y));
  };
  const bool same_transmission =
      a.transmission == b.transmission ||
      (a.transmission && b.transmission && *a.transmission == *b.transmission);
  return a.aperture.blades == b.aperture.blades && same_transmission &&
         agree(a.aperture.roundness, b.aperture.roundness) &&
         agree(a.aperture.ratio, b.aperture.ratio) && a.hood.exists() == b.hood.exists() &&
         agree(a.hood.distance_w, b.hood.distance_w) && agree(a.hood.radius_w, b.hood.radius_w);
}

// Returns the recording times of the frames as a clock; nullopt if there are none. Sets *lost_count
// to the number of frames that show another time than the clock tells.
std::optional<RecordingClock> ClockOf(const CameraPath& path, size_t* lost_count) {
  constexpr double kEqualTimes = 1e-9;
  const RenderCamera& first = path.cameras.front();
  const RenderCamera& last = path.cameras.back();
  if (!first.recording_time || !last.recording_time) return std::nullopt;
  const auto seconds_of = [&](size_t frame) {
    return static_cast<double>(frame / static_cast<size_t>(path.views)) / path.fps;
  };
  const double duration_s = seconds_of(path.frame_count() - 1);
  RecordingClock clock = {*first.recording_time, 0};
  if (duration_s > 0) clock.speed = (*last.recording_time - clock.from) / duration_s;
  for (size_t i = 0; i < path.frame_count(); ++i) {
    const std::optional<double>& time = path.cameras[i].recording_time;
    const double told = clock.At(seconds_of(i));
    if (!time || !(std::abs(*time - told) <= kEqualTimes * std::max(1.0, std::abs(told))))
      ++*lost_count;
  }
  return clock;
}

// Returns the section of the focal surface.
std::string FocusText(const FocalSurfaceSource& source) {
  std::string quoted;
  for (const char c : source.file) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  const bool is_depth = source.kind == FocalSurfaceSource::Kind::kDepths;
  std::string text =
      fmt::format("focus:\n  surface: \"{}\"\n  kind: {}\n", quoted, is_depth ? "depth" : "height");
  if (source.scale != 1) text += fmt::format("  scale: {}\n", source.scale);
  if (source.nodata) text += fmt::format("  nodata: {}\n", *source.nodata);
  if (source.most_blur_px != 0.5) text += fmt::format("  blur: {}\n", source.most_blur_px);
  if (is_depth) return text;
  if (!source.needs_origin)
    text += fmt::format("  origin: {}\n", PointText(source.origin_w));
  else if (source.map_origin_m != Vec3::Zero())
    text += fmt::format("  map_origin: {}\n", PointText(source.map_origin_m));
  if (!source.needs_cell) text += fmt::format("  cell: {}\n", source.right_w.norm());
  text += fmt::format("  right: {}\n  down: {}\n  up: {}\n", PointText(source.right_w.normalized()),
                      PointText(source.down_w.normalized()), PointText(source.up));
  if (source.offset_w != 0) text += fmt::format("  offset: {}\n", source.offset_w);
  return text;
}

std::vector<std::string> LostOf(const CameraPath& path) {
  size_t stretched = 0, shapes = 0;
  for (const RenderCamera& camera : path.cameras) {
    const Intrinsics& k = camera.pinhole.intrinsics;
    if (std::abs(k.fx_px - k.fy_px) > kEqualOptics * k.fx_px || k.skew_px != 0) ++stretched;
    if (!HaveOneShape(camera, path.cameras[0])) ++shapes;
  }
  std::vector<std::string> lost;
  const auto add = [&](size_t count, const char* what) {
    if (count > 0)
      lost.push_back(fmt::format("{} of {} frame{}", what, count, count == 1 ? "" : "s"));
  };
  size_t other_times = 0;
  ClockOf(path, &other_times);
  add(other_times, "the time of the light field video, which does not pass evenly,");
  add(stretched, "the shape of the elements, which are no squares,");
  add(shapes, "blades, ratio, hood and transmission, which differ from those of the first frame,");
  return lost;
}

}  // namespace

Result<PathYaml> PathYamlOf(const CameraPath& path) {
  const Intrinsics& plate = path.cameras.front().pinhole.intrinsics;
  const std::vector<YamlQuantity> camera = CameraSection(path), lens = LensSection(path);
  PathYaml yaml;
  yaml.text =
      fmt::format("format: lfpath 1\nfps: {}\nframes: {}\nunit_m: {}\nresolution: [{}, {}]\n",
                  path.fps, path.frame_count(), path.unit_m, plate.width_px, plate.height_px);
  if (path.first_frame != 1) yaml.text += fmt::format("first_frame: {}\n", path.first_frame);
  if (path.views > 1) yaml.text += fmt::format("views: {}\n", path.views);
  if (path.shutter.exists())
    yaml.text += fmt::format("shutter: {{angle_deg: {}, samples: {}}}\n", path.shutter.angle_deg,
                             path.shutter.samples);
  size_t other_times = 0;
  if (const std::optional<RecordingClock> clock = ClockOf(path, &other_times))
    yaml.text += fmt::format("time: {{from: {}, speed: {}}}\n", clock->from, clock->speed);
  if (path.focal_surface) yaml.text += FocusText(*path.focal_surface);
  AddSection("camera", camera, "", &yaml.text);
  AddSection("lens", lens, ShapeText(path.cameras[0]), &yaml.text);
  if (AnyMoves(camera) || AnyMoves(lens)) yaml.text += "keyframes:\n";
  AddKeyframes(path, camera, &yaml.text);
  AddKeyframes(path, lens, &yaml.text);
  if (const auto read = ParsePathYaml(yaml.text, "the written path", std::nullopt); !read)
    return OutputError(
        fmt::format("the path cannot be written as YAML; write another format, such as JSON: {}",
                    read.error().message));
  yaml.lost = LostOf(path);
  return yaml;
}

}  // namespace lf
