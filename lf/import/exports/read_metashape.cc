// SPDX-License-Identifier: Apache-2.0
#include "lf/import/exports/read_metashape.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lf/core/file.h"
#include "lf/core/log.h"
#include "lf/import/exports/export_xml.h"
#include "lf/import/exports/import_limits.h"
#include "lf/light_field/model/rotation.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr double kMostMetashapeNumber = 1e9;  // largest coefficient or length in pixels
constexpr int kMostMetashapeId = std::numeric_limits<int>::max();

Result<Mat3> RotationOf(const XmlElement& element, const std::vector<double>& rows) {
  Result<Mat3> rotation = RotationOfRows(rows);
  if (!rotation) return element.Fault(rotation.error().message);
  return rotation;
}

// Reads the sixteen numbers of a camera's <transform>, the rows of chunk_from_cam.
Result<RigidTransform> PoseOf(const XmlElement& transform) {
  LF_ASSIGN_OR_RETURN(const std::vector<double> m, transform.Numbers(16, kLargest_w));
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    return transform.Wrong("a 4x4 matrix with the last row 0 0 0 1");
  LF_ASSIGN_OR_RETURN(const Mat3 rotation, RotationOf(transform, {m[0], m[1], m[2], m[4], m[5],
                                                                  m[6], m[8], m[9], m[10]}));
  return RigidTransform{rotation, {m[3], m[7], m[11]}};
}

// The <transform> of a component or chunk: point_world = scale rotation point_chunk + translation.
struct ChunkPlacement {
  double scale = 1;
  RigidTransform rigid = {};
};

Result<ChunkPlacement> PlacementOf(const XmlElement& transform) {
  ChunkPlacement placement;
  if (const XmlElement element = transform.Child("rotation"); element.exists()) {
    LF_ASSIGN_OR_RETURN(const std::vector<double> rows, element.Numbers(9, kMostMetashapeNumber));
    LF_ASSIGN_OR_RETURN(placement.rigid.rotation, RotationOf(element, rows));
  }
  if (const XmlElement element = transform.Child("translation"); element.exists()) {
    LF_ASSIGN_OR_RETURN(const std::vector<double> t, element.Numbers(3, kLargest_w));
    placement.rigid.translation = {t[0], t[1], t[2]};
  }
  LF_ASSIGN_OR_RETURN(placement.scale, transform.NumberOr("scale", 1, kMostMetashapeNumber));
  if (!(placement.scale >= 1 / kMostMetashapeNumber))
    return transform.Child("scale").Wrong(
        fmt::format("a number from {:g} to {:g}", 1 / kMostMetashapeNumber, kMostMetashapeNumber));
  return placement;
}

RigidTransform CamFromWorld(const RigidTransform& chunk_from_cam, const ChunkPlacement& placement) {
  const RigidTransform world_from_cam = {
      placement.rigid.rotation * chunk_from_cam.rotation,
      placement.scale * (placement.rigid.rotation * chunk_from_cam.translation) +
          placement.rigid.translation};
  return world_from_cam.Inverse();
}

// Returns the calibration to use of a sensor: the adjusted one, or the only one.
Result<XmlElement> CalibrationOf(const XmlElement& sensor) {
  const std::vector<XmlElement> all = sensor.Children("calibration");
  for (const std::string_view wanted : {"adjusted", "", "initial"})
    for (const XmlElement& calibration : all)
      if (calibration.Attribute("class").value_or("") == wanted) return calibration;
  return sensor.Fault(
      "has no calibration: align the photographs, and export the cameras again as Agisoft XML");
}

Result<Distortion> MetashapeDistortion(const XmlElement& calibration, std::string_view type) {
  DistortionParameters p = {};
  constexpr const char* kNames[] = {"k1", "k2", "p2", "p1", "k3", "k4"};  // in the order of kBrown
  for (size_t i = 0; i < std::size(kNames); ++i) {
    LF_ASSIGN_OR_RETURN(p[i], calibration.NumberOr(kNames[i], 0, kMostMetashapeNumber));
  }
  for (const char* const name : {"p3", "p4"}) {
    LF_ASSIGN_OR_RETURN(const double value, calibration.NumberOr(name, 0, kMostMetashapeNumber));
    if (value != 0)
      return calibration.Child(name).Wrong(
          "0, because the formula of this coefficient is not known: optimize the cameras in "
          "Metashape without it, and export them again");
  }
  const bool is_tangential = p[2] != 0 || p[3] != 0;
  if (type == "fisheye" || type == "equidistant_fisheye") {
    if (is_tangential) return Distortion{DistortionModel::kThinPrism, p};
    return Distortion{DistortionModel::kFisheye, {p[0], p[1], p[4], p[5]}};
  }
  if (type != "frame")
    return calibration.Fault(
        fmt::format("is of the type \"{}\": expected frame, fisheye or equidistant_fisheye; export "
                    "undistorted photographs with their cameras from Metashape instead (File > "
                    "Export > Convert Images)",
                    type.substr(0, 80)));
  if (p[5] != 0) return Distortion{DistortionModel::kBrown, p};
  if (std::all_of(p.begin(), p.end(), [](double x) { return x == 0; })) return Distortion{};
  return Distortion{DistortionModel::kRadialTangential, p};
}

Result<Intrinsics> IntrinsicsOf(const XmlElement& sensor) {
  LF_ASSIGN_OR_RETURN(const XmlElement calibration, CalibrationOf(sensor));
  if (calibration.Child("fx").exists())
    return calibration.Fault(
        "is of PhotoScan 1.1 or older, whose cx and cy mean something else: open the project in a "
        "newer version, and export the cameras again");
  XmlElement resolution = calibration.Child("resolution");
  if (!resolution.exists()) resolution = sensor.Child("resolution");
  if (!resolution.exists()) return sensor.Fault("has no <resolution width=... height=...>");
  Intrinsics k;
  LF_ASSIGN_OR_RETURN(k.width_px, resolution.WholeAttribute("width", 1, 1 << 16));
  LF_ASSIGN_OR_RETURN(k.height_px, resolution.WholeAttribute("height", 1, 1 << 16));
  if (!calibration.Child("f").exists()) return calibration.Fault("has no <f>, the focal length");
  LF_ASSIGN_OR_RETURN(k.fy_px, calibration.Child("f").Number(kMostMetashapeNumber));
  LF_ASSIGN_OR_RETURN(const double b1, calibration.NumberOr("b1", 0, kMostMetashapeNumber));
  LF_ASSIGN_OR_RETURN(k.skew_px, calibration.NumberOr("b2", 0, kMostMetashapeNumber));
  LF_ASSIGN_OR_RETURN(const double cx, calibration.NumberOr("cx", 0, kMostMetashapeNumber));
  LF_ASSIGN_OR_RETURN(const double cy, calibration.NumberOr("cy", 0, kMostMetashapeNumber));
  k.fx_px = k.fy_px + b1;
  k.cx_px = 0.5 * k.width_px + cx;
  k.cy_px = 0.5 * k.height_px + cy;
  std::string_view type = sensor.Attribute("type").value_or("frame");
  if (const auto own = calibration.Attribute("type")) type = *own;
  LF_ASSIGN_OR_RETURN(k.distortion, MetashapeDistortion(calibration, type));
  return k;
}

// Returns where a sensor is in its rig: the pose of its cameras in the axes of the master's; none
// if the file does not state it.
Result<std::optional<RigidTransform>> OffsetOf(const XmlElement& sensor) {
  if (!sensor.Attribute("master_id")) return std::optional(RigidTransform());
  XmlElement location = sensor.Child("location");
  if (!location.exists()) location = sensor.Child("translation");
  const XmlElement rotation = sensor.Child("rotation");
  if (!location.exists() || !rotation.exists()) return std::optional<RigidTransform>();
  LF_ASSIGN_OR_RETURN(const std::vector<double> rows, rotation.Numbers(9, kMostMetashapeNumber));
  RigidTransform offset;
  LF_ASSIGN_OR_RETURN(offset.rotation, RotationOf(rotation, rows));
  LF_ASSIGN_OR_RETURN(const std::vector<double> t, location.Numbers(3, kLargest_w));
  offset.translation = {t[0], t[1], t[2]};
  return std::optional(offset);
}

// A sensor, whose lens is read only if an image needs it.
struct RigSensor {
  XmlElement element;
  std::optional<Intrinsics> intrinsics = {};
  std::optional<RigidTransform> master_from_cam = {};
};

// The parts of a chunk that cameras refer to, by their ids.
class MetashapeChunk {
 public:
  static Result<MetashapeChunk> Of(const XmlElement& chunk) {
    MetashapeChunk read(chunk);
    LF_RETURN_IF_ERROR(read.ReadSensors());
    LF_RETURN_IF_ERROR(read.ReadComponents());
    for (const XmlElement& cameras : chunk.Children("cameras")) read.AddCameras(cameras, "");
    return read;
  }

  const std::vector<XmlElement>& cameras() const { return cameras_; }

  // Returns where the image of a camera may be, beside others of the same label: in a folder named
  // after the camera's group or, if it is in none, after its sensor. Metashape takes the
  // photographs of rigs from folders, in which they have the same names.
  Result<std::string> NameInFolder(const XmlElement& camera) {
    const std::string label(camera.Attribute("label").value_or(""));
    LF_ASSIGN_OR_RETURN(const int id, camera.WholeAttribute("id", 0, kMostMetashapeId));
    const auto in_group = group_of_.find(id);
    if (in_group != group_of_.end()) return in_group->second + "/" + label;
    LF_ASSIGN_OR_RETURN(RigSensor* const sensor, SensorOf(camera));
    return std::string(sensor->element.Attribute("label").value_or("")) + "/" + label;
  }

  Result<Intrinsics> IntrinsicsOfCamera(const XmlElement& camera) {
    LF_ASSIGN_OR_RETURN(RigSensor* const sensor, SensorOf(camera));
    if (!sensor->intrinsics) {
      LF_ASSIGN_OR_RETURN(sensor->intrinsics, IntrinsicsOf(sensor->element));
    }
    return *sensor->intrinsics;
  }

  // Returns chunk_from_cam; none if the camera was not aligned.
  Result<std::optional<RigidTransform>> PoseOfCamera(const XmlElement& camera) {
    if (const XmlElement transform = camera.Child("transform"); transform.exists()) {
      LF_ASSIGN_OR_RETURN(const RigidTransform pose, PoseOf(transform));
      return std::optional(pose);
    }
    if (!camera.Attribute("master_id")) return std::optional<RigidTransform>();
    LF_ASSIGN_OR_RETURN(const int master_id,
                        camera.WholeAttribute("master_id", 0, kMostMetashapeId));
    const auto master = by_id_.find(master_id);
    if (master == by_id_.end())
      return camera.Fault(fmt::format("has the master {}, which is not in the file", master_id));
    const XmlElement transform = cameras_[master->second].Child("transform");
    if (!transform.exists()) return std::optional<RigidTransform>();
    LF_ASSIGN_OR_RETURN(const RigidTransform pose, PoseOf(transform));
    LF_ASSIGN_OR_RETURN(RigSensor* const of_master, SensorOf(cameras_[master->second]));
    LF_ASSIGN_OR_RETURN(RigSensor* const of_camera, SensorOf(camera));
    if (!of_master->master_from_cam || !of_camera->master_from_cam)
      return std::optional<RigidTransform>();
    // The master of the cameras need not be that of the sensors.
    return std::optional(pose * of_master->master_from_cam->Inverse() *
                         *of_camera->master_from_cam);
  }

  // A part of the chunk whose cameras stand relative to each other.
  struct Part {
    int component = 0;  // kPlaced: all components that are placed in the chunk's coordinate system
    std::optional<ChunkPlacement> placement = {};
  };
  static constexpr int kPlaced = -1;

  Result<Part> PartOf(const XmlElement& camera) const {
    int id = 0;
    if (camera.Attribute("component_id")) {
      LF_ASSIGN_OR_RETURN(id, camera.WholeAttribute("component_id", 0, kMostMetashapeId));
    }
    const auto component = components_.find(id);
    if (component != components_.end() && component->second)
      return Part{kPlaced, component->second};
    if (of_chunk_ && (components_.size() <= 1 || id == active_component_))
      return Part{kPlaced, of_chunk_};
    return Part{id, std::nullopt};
  }

 private:
  explicit MetashapeChunk(const XmlElement& element) : element_(element) {}

  Result<void> ReadSensors() {
    for (const XmlElement& element : element_.Child("sensors").Children("sensor")) {
      LF_ASSIGN_OR_RETURN(const int id, element.WholeAttribute("id", 0, kMostMetashapeId));
      RigSensor sensor{element};
      LF_ASSIGN_OR_RETURN(sensor.master_from_cam, OffsetOf(element));
      sensors_.emplace(id, std::move(sensor));
    }
    return {};
  }

  Result<void> ReadComponents() {
    if (const XmlElement transform = element_.Child("transform"); transform.exists()) {
      LF_ASSIGN_OR_RETURN(of_chunk_, PlacementOf(transform));
    }
    const XmlElement components = element_.Child("components");
    if (components.Attribute("active_id")) {
      LF_ASSIGN_OR_RETURN(active_component_,
                          components.WholeAttribute("active_id", 0, kMostMetashapeId));
    }
    for (const XmlElement& component : components.Children("component")) {
      LF_ASSIGN_OR_RETURN(const int id, component.WholeAttribute("id", 0, kMostMetashapeId));
      std::optional<ChunkPlacement> placement;
      if (const XmlElement transform = component.Child("transform"); transform.exists()) {
        LF_ASSIGN_OR_RETURN(placement, PlacementOf(transform));
      }
      components_.emplace(id, placement);
    }
    return {};
  }

  // Adds the cameras in an element and in the groups in it. Groups are not nested.
  //   label  that of the group; empty outside of groups
  void AddCameras(const XmlElement& element, std::string_view label) {
    for (const XmlElement& camera : element.Children("camera")) {
      if (const auto id = camera.WholeAttribute("id", 0, kMostMetashapeId)) {
        by_id_.emplace(*id, cameras_.size());
        if (!label.empty()) group_of_.emplace(*id, label);
      }
      cameras_.push_back(camera);
    }
    if (element.name() == "group") return;
    for (const XmlElement& group : element.Children("group"))
      AddCameras(group, group.Attribute("label").value_or(""));
  }

  Result<RigSensor*> SensorOf(const XmlElement& camera) {
    LF_ASSIGN_OR_RETURN(const int id, camera.WholeAttribute("sensor_id", 0, kMostMetashapeId));
    const auto found = sensors_.find(id);
    if (found == sensors_.end())
      return camera.Fault(fmt::format("has the sensor {}, which is not in the file", id));
    return &found->second;
  }

  XmlElement element_;
  std::map<int, RigSensor> sensors_;
  std::map<int, std::optional<ChunkPlacement>> components_;
  std::optional<ChunkPlacement> of_chunk_;
  int active_component_ = 0;
  std::vector<XmlElement> cameras_;
  std::map<int, size_t> by_id_;          // indices into cameras_
  std::map<int, std::string> group_of_;  // labels of groups, by the ids of cameras
};

// Cameras that are left out, as a warning counts them.
struct LeftOutCameras {
  size_t disabled = 0, not_aligned = 0, elsewhere = 0;

  void Warn(const fs::path& file, size_t total) const {
    std::vector<std::string> parts;
    if (disabled > 0) parts.push_back(fmt::format("{} disabled", disabled));
    if (not_aligned > 0) parts.push_back(fmt::format("{} not aligned", not_aligned));
    if (elsewhere > 0)
      parts.push_back(
          fmt::format("{} in components that are not placed relative to the others", elsewhere));
    if (parts.empty()) return;
    LogWarning("{}: {} of {} cameras are left out: {}", file.string(),
               disabled + not_aligned + elsewhere, total, fmt::join(parts, ", "));
  }
};

// Says in which unit and coordinate system the cameras stand.
void TellUnit(const fs::path& file, const XmlElement& chunk, bool is_placed) {
  if (!is_placed) {
    LogInfo("{}: positions are in the unit of the chunk, whose length is not known", file.string());
    return;
  }
  const std::string_view reference = chunk.Child("reference").Text();
  const size_t begin = std::min(reference.find('"'), reference.size());
  const std::string_view name = reference.substr(begin, reference.find('"', begin + 1) - begin + 1);
  const bool is_local = reference.empty() || reference.starts_with("LOCAL_CS");
  LogInfo("{}: positions are in {}{}", file.string(),
          is_local ? "the unit of the chunk's coordinate system, metres as a rule"
                   : "metres, in geocentric coordinates",
          name.empty() ? "" : fmt::format(" ({})", name.substr(0, 80)));
}

Result<void> CheckDistinct(std::vector<std::string> names, const fs::path& file) {
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice == names.end()) return {};
  return InputError(
      fmt::format("{}: several cameras have the image \"{}\", because their labels are the same, "
                  "and no folders have the names of their groups or sensors: give each camera a "
                  "label of its own in Metashape, and export them again",
                  file.string(), *twice));
}

bool IsDisabled(const XmlElement& camera) {
  const std::string_view enabled = camera.Attribute("enabled").value_or("true");
  return enabled == "false" || enabled == "0";
}

Result<XmlElement> ChunkIn(const XmlElement& root) {
  if (root.name() == "chunk") return root;
  const std::vector<XmlElement> chunks = root.Children("chunk");
  if (chunks.size() == 1) return chunks[0];
  return root.Fault(fmt::format(
      "holds {} chunks: expected the cameras of one chunk, as Metashape writes them by File > "
      "Export > Export Cameras (Agisoft XML)",
      chunks.size()));
}

}  // namespace

Result<ExportedCameras> ParseMetashape(std::string_view text, const fs::path& file) {
  LF_ASSIGN_OR_RETURN(const XmlFile xml, XmlFile::Parse(text, file));
  LF_ASSIGN_OR_RETURN(const XmlElement element, ChunkIn(xml.Root()));
  LF_ASSIGN_OR_RETURN(MetashapeChunk chunk, MetashapeChunk::Of(element));
  struct Posed {
    XmlElement camera;
    RigidTransform chunk_from_cam;
    MetashapeChunk::Part part;
  };
  std::vector<Posed> posed;
  std::map<int, size_t> counts;  // cameras of each part, by Part::component
  LeftOutCameras left_out;
  for (const XmlElement& camera : chunk.cameras()) {
    if (IsDisabled(camera)) {
      ++left_out.disabled;
      continue;
    }
    LF_ASSIGN_OR_RETURN(const auto pose, chunk.PoseOfCamera(camera));
    if (!pose) {
      ++left_out.not_aligned;
      continue;
    }
    LF_ASSIGN_OR_RETURN(const MetashapeChunk::Part part, chunk.PartOf(camera));
    ++counts[part.component];
    posed.push_back({camera, *pose, part});
  }
  const auto most = std::max_element(
      counts.begin(), counts.end(),
      [](const auto& one, const auto& other) { return one.second < other.second; });
  std::map<std::string_view, int> labels;
  for (const Posed& one : posed)
    if (one.part.component == most->first) ++labels[one.camera.Attribute("label").value_or("")];
  ExportedCameras cameras;
  cameras.folder = file.parent_path();
  for (const Posed& one : posed) {
    if (one.part.component != most->first) {
      ++left_out.elsewhere;
      continue;
    }
    ExportedImage image;
    image.name = one.camera.Attribute("label").value_or("");
    if (labels.at(image.name) > 1) {
      LF_ASSIGN_OR_RETURN(image.name, chunk.NameInFolder(one.camera));
    }
    LF_ASSIGN_OR_RETURN(image.intrinsics, chunk.IntrinsicsOfCamera(one.camera));
    image.cam_from_world =
        CamFromWorld(one.chunk_from_cam, one.part.placement.value_or(ChunkPlacement()));
    cameras.images.push_back(std::move(image));
  }
  left_out.Warn(file, chunk.cameras().size());
  if (!cameras.images.empty()) TellUnit(file, element, most->first == MetashapeChunk::kPlaced);
  return cameras;
}

Result<LightField> ReadMetashape(const fs::path& file, const ExportOptions& options) {
  LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(file, kMostXmlBytes));
  LF_ASSIGN_OR_RETURN(ExportedCameras cameras, ParseMetashape(text, file));
  std::vector<std::string> names;
  for (const ExportedImage& image : cameras.images) names.push_back(image.name);
  LF_RETURN_IF_ERROR(CheckDistinct(std::move(names), file));
  LF_ASSIGN_OR_RETURN(LightField light_field, FinishExport(std::move(cameras), file, options));
  LF_RETURN_IF_ERROR(CheckDistinct(light_field.image_names, file));
  return light_field;
}

}  // namespace lf
