// SPDX-License-Identifier: Apache-2.0
#include "python/src/cameras.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/work.h"

#include "lf/camera/fit_surface.h"
#include "lf/camera/path/path_yaml.h"
#include "lf/camera/path/path_yaml_write.h"
#include "lf/camera/render_camera.h"
#include "lf/core/check.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/resample_path.h"
#include "lf/import/paths/transmission_file.h"
#include "lf/import/paths/write_path.h"

namespace lf::python {
namespace {

namespace py = pybind11;

// Calls visit(number) for each number of the camera, always in the same order; visit may change it.
// Pickle keeps these numbers. The lens of a render camera has no distortion.
template <class Visit>
void VisitNumbers(RenderCamera& c, const Visit& visit) {
  Intrinsics& k = c.pinhole.intrinsics;
  const auto whole = [&](int& value) {
    double number = value;
    visit(number);
    value = static_cast<int>(number);
  };
  for (double* number : {&k.fx_px, &k.fy_px, &k.cx_px, &k.cy_px, &k.skew_px}) visit(*number);
  whole(k.width_px);
  whole(k.height_px);
  RigidTransform& pose = c.pinhole.cam_from_world;
  for (int i = 0; i < 9; ++i) visit(pose.rotation.data()[i]);
  for (int i = 0; i < 3; ++i) visit(pose.translation[i]);
  visit(c.aperture.radius_w);
  whole(c.aperture.blades);
  visit(c.aperture.rotation_rad);
  for (int i = 0; i < 3; ++i) visit(c.focus_plane.normal[i]);
  for (double* number :
       {&c.focus_plane.offset_w, &c.time_s, &c.focal_length_w, &c.sensor_width_w,
        &c.focus_distance_w, &c.focus_tilt.horizontal_rad, &c.focus_tilt.vertical_rad, &c.unit_m})
    visit(*number);
  visit(c.aperture.ratio);
  visit(c.aperture.roundness);
  visit(c.hood.distance_w);
  visit(c.hood.radius_w);
}

py::tuple NumbersOf(const RenderCamera& camera) {
  RenderCamera copy = camera;
  py::list numbers;
  VisitNumbers(copy, [&](double& number) { numbers.append(number); });
  return py::tuple(numbers);
}

// Returns Transmission::Text(), or "" if the lens has none.
std::string TransmissionText(const RenderCamera& camera) {
  return camera.transmission ? camera.transmission->Text() : "";
}

// Returns FocalSurface::Bytes(), or nothing if the camera is in focus on a plane.
py::bytes SurfaceBytes(const RenderCamera& camera) {
  return camera.surface ? py::bytes(camera.surface->Bytes()) : py::bytes();
}

RenderCamera CameraOf(const py::tuple& numbers, const std::string& transmission,
                      const py::bytes& surface) {
  RenderCamera camera;
  if (!transmission.empty())
    camera.transmission =
        std::make_shared<const Transmission>(Take(Transmission::FromText(transmission)));
  size_t next = 0;
  VisitNumbers(camera, [&](double& number) {
    if (next >= numbers.size()) throw py::value_error("a pickled camera lacks numbers");
    number = numbers[next++].cast<double>();
  });
  const auto bytes = surface.cast<std::string>();
  const Intrinsics& plate = camera.pinhole.intrinsics;
  if (!bytes.empty())
    camera.surface = std::make_shared<const FocalSurface>(
        Take(FocalSurface::FromBytes(bytes, plate.width_px, plate.height_px)));
  return camera;
}

// Returns the camera in focus on a surface. An element without a depth takes that of the nearest
// element that has one.
//   depths  [height][width] along the optical axis, in world units; unknown: 0, NaN or infinite
RenderCamera WithSurface(RenderCamera camera, const py::array_t<double, py::array::c_style>& depths,
                         double blur_px, double camera_distance_w) {
  const Intrinsics& plate = camera.pinhole.intrinsics;
  LF_CHECK(depths.shape(0) == plate.height_px && depths.shape(1) == plate.width_px);
  Image<float> inverse(plate.width_px, plate.height_px);
  std::transform(depths.data(), depths.data() + depths.size(), inverse.pixels().begin(),
                 [](double depth_w) { return static_cast<float>(1 / depth_w); });
  return CallWithoutGil([&] {
    if (FillUnknown(&inverse) == inverse.pixels().size())
      Take(Result<void>(UsageError(
          "depths: expected finite numbers above 0, in world units: no element has a depth")));
    SetSurface(inverse, blur_px, camera_distance_w, &camera);
    return camera;
  });
}

// Returns the depths [height][width] of the camera's surface; none if it is in focus on a plane.
std::optional<py::array_t<float>> SurfaceDepths(const RenderCamera& camera) {
  if (!camera.surface) return std::nullopt;
  const Intrinsics& plate = camera.pinhole.intrinsics;
  Image<float> depths(plate.width_px, plate.height_px);
  for (const FocalPiece& piece : camera.surface->pieces())
    for (int y = piece.elements.y_begin; y < piece.elements.y_end; ++y)
      for (int x = piece.elements.x_begin; x < piece.elements.x_end; ++x)
        depths.at(x, y) = static_cast<float>(1 / piece.At(x + 0.5, y + 0.5));
  return ArrayOf(std::move(depths), true);
}

// Returns what two equal cameras share: all but the time, which belongs to the path.
py::tuple ValuesToCompare(RenderCamera camera) {
  camera.time_s = 0;
  return py::make_tuple(NumbersOf(camera), TransmissionText(camera), SurfaceBytes(camera));
}

// Returns the text of a picture [height][width], 0 (dark) to 255.
std::string TextOfTransmission(const py::array_t<uint8_t, py::array::c_style>& picture) {
  Image<uint8_t> shares(static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)));
  std::copy_n(picture.data(), picture.size(), shares.pixels().begin());
  return Take(Transmission::Of(shares)).Text();
}

py::tuple TupleOf(const CameraPath& path) {
  ShutterWords shutter;
  if (path.shutter.exists())
    shutter.emplace(path.shutter.angle_deg, path.shutter.samples, path.instants);
  return py::make_tuple(path.cameras, path.fps, path.first_frame, shutter, path.views);
}

// Returns the instants of a shutter, which are interpolated between the cameras of the frames.
std::vector<RenderCamera> InstantsOf(std::vector<RenderCamera> cameras, double fps,
                                     double angle_deg, int samples) {
  for (const RenderCamera& camera : cameras)
    if (camera.surface)
      Take(Result<void>(UsageError(
          "shutter: a camera has a focal surface, whose depths are seen from one moment only: use "
          "cameras without surfaces, or no shutter")));
  CameraPath path = PathOf(std::move(cameras), fps, 1, 1, {});
  Take(AddShutter({angle_deg, samples}, &path));
  return path.instants;
}

py::tuple ParsePath(const std::string& text, const std::string& name,
                    std::optional<double> unit_m) {
  return TupleOf(Take(ParsePathYaml(text, name, unit_m, PicturesBeside(name))));
}

py::tuple ReadPath(const std::string& file, std::optional<double> unit_m) {
  CameraPath path = CallWithoutGil([&] {
    return Take(
        OpenPath(file, {.light_field_unit_m = unit_m, .surface = PathOptions::Surface::kName}));
  });
  if (path.focal_surface)
    Take(Result<void>(InputError(fmt::format(
        "{}: focus.surface: a path that is loaded here is in focus on planes: remove 'focus' from "
        "it, and give the depths to camera.with_surface()",
        file))));
  return TupleOf(path);
}

// Writes a path file in a format, or in the one of the file's extension. Returns what other
// programs do not find in the file.
std::vector<std::string> SavePath(const std::string& file, const std::vector<RenderCamera>& cameras,
                                  double fps, uint32_t first_frame, const ShutterWords& shutter,
                                  int views, const std::optional<std::string>& name) {
  return CallWithoutGil([&]() -> std::vector<std::string> {
    for (const RenderCamera& camera : cameras)
      if (camera.surface)
        Take(Result<void>(UsageError(fmt::format(
            "{}: a path file names a picture of depths (focus.surface), and cannot hold the focal "
            "surface of a camera: write the depths into a file and name it in the path, or save "
            "camera.with_surface(None)",
            file))));
    const std::optional<PathFormat> format = name ? PathFormatOf(*name) : PathFormatOfFile(file);
    if (!format)
      Take(Result<void>(UsageError(fmt::format(
          "{}: expected a name that ends in .yaml, .json, .chan or .usda, or the format \"yaml\", "
          "\"nerfstudio\", \"instant-ngp\", \"chan\" or \"usda\"{}",
          file, name ? fmt::format(", found \"{}\"", *name) : ""))));
    Take(CheckReplacesPath(file));
    CameraPath path = PathOf(cameras, fps, first_frame, cameras.front().unit_m, shutter);
    path.views = views;
    // Each format states or computes the times itself.
    path.cameras = cameras;
    if (*format == PathFormat::kYaml) {
      const PathYaml yaml = Take(PathYamlOf(path));
      if (!yaml.lost.empty())
        Take(Result<void>(
            UsageError(fmt::format("{}: YAML has no place for {}; save a .json instead", file,
                                   fmt::join(yaml.lost, "; for ")))));
    }
    return Take(WritePath(path, file, *format, {}));
  });
}

}  // namespace

CameraPath PathOf(std::vector<RenderCamera> cameras, double fps, uint32_t first_frame,
                  double unit_m, ShutterWords shutter) {
  CameraPath path;
  path.fps = fps;
  path.first_frame = first_frame;
  path.unit_m = unit_m;
  path.cameras = std::move(cameras);
  for (size_t i = 0; i < path.cameras.size(); ++i)
    path.cameras[i].time_s = static_cast<double>(i) / fps;
  if (!shutter) return path;
  auto& [angle_deg, samples, instants] = *shutter;
  path.shutter = {angle_deg, samples};
  path.instants = std::move(instants);
  const auto count = static_cast<size_t>(samples);
  LF_CHECK(path.instants.size() == path.cameras.size() * count);
  for (size_t i = 0; i < path.instants.size(); ++i)
    path.instants[i].time_s = (static_cast<double>(i / count) +
                               InstantOffset(path.shutter, static_cast<int>(i % count))) /
                              fps;
  return path;
}

void AddCameras(py::module_& module) {
  py::class_<RenderCamera>(module, "RenderCamera")
      .def_property_readonly("resolution",
                             [](const RenderCamera& c) {
                               return std::pair(c.pinhole.intrinsics.width_px,
                                                c.pinhole.intrinsics.height_px);
                             })
      .def_property_readonly("K",
                             [](const RenderCamera& c) { return c.pinhole.intrinsics.Matrix(); })
      .def_property_readonly("cam_from_world",
                             [](const RenderCamera& c) {
                               Eigen::Matrix<double, 3, 4> matrix;
                               matrix << c.pinhole.cam_from_world.rotation,
                                   c.pinhole.cam_from_world.translation;
                               return matrix;
                             })
      .def_property_readonly("position",
                             [](const RenderCamera& c) { return c.pinhole.CentreWorld(); })
      .def_property_readonly("aperture_diameter",
                             [](const RenderCamera& c) { return 2 * c.aperture.radius_w; })
      .def_property_readonly("blades", [](const RenderCamera& c) { return c.aperture.blades; })
      .def_property_readonly(
          "blade_rotation_deg",
          [](const RenderCamera& c) { return DegreesFromRadians(c.aperture.rotation_rad); })
      .def_property_readonly("blade_roundness",
                             [](const RenderCamera& c) { return c.aperture.roundness; })
      .def_property_readonly("ratio", [](const RenderCamera& c) { return c.aperture.ratio; })
      .def_property_readonly(
          "hood",
          [](const RenderCamera& c) { return std::pair(c.hood.distance_w, 2 * c.hood.radius_w); })
      .def_property_readonly("transmission", &TransmissionText)
      .def_property_readonly("shift", &ShiftOf)
      .def_property_readonly("focus_distance",
                             [](const RenderCamera& c) { return c.focus_distance_w; })
      .def_property_readonly("focus_plane",
                             [](const RenderCamera& c) {
                               return std::pair(c.focus_plane.normal, c.focus_plane.offset_w);
                             })
      .def_property_readonly("tilt_deg",
                             [](const RenderCamera& c) {
                               return std::pair(DegreesFromRadians(c.focus_tilt.horizontal_rad),
                                                DegreesFromRadians(c.focus_tilt.vertical_rad));
                             })
      .def_property_readonly("focal_length", [](const RenderCamera& c) { return c.focal_length_w; })
      .def_property_readonly("sensor_width", [](const RenderCamera& c) { return c.sensor_width_w; })
      .def_property_readonly("unit_m", [](const RenderCamera& c) { return c.unit_m; })
      .def("__eq__",
           [](const RenderCamera& a, const RenderCamera& b) {
             return ValuesToCompare(a).equal(ValuesToCompare(b));
           })
      .def("__hash__", [](const RenderCamera& c) { return py::hash(ValuesToCompare(c)); })
      .def("numbers", &NumbersOf)
      .def_property_readonly("surface", &SurfaceBytes)
      .def("surface_depths", &SurfaceDepths)
      .def("with_surface", &WithSurface)
      .def_static("of_numbers", &CameraOf)
      .def(py::pickle(
          [](const RenderCamera& c) {
            return py::make_tuple(NumbersOf(c), TransmissionText(c), SurfaceBytes(c));
          },
          [](const py::tuple& state) {
            return CameraOf(state[0].cast<py::tuple>(), state[1].cast<std::string>(),
                            state[2].cast<py::bytes>());
          }));
  module.def("transmission_of_array", &TextOfTransmission);
  module.def("transmission_of_text", [](const std::string& text) {
    return CallWithoutGil([&] { return Take(Transmission::FromText(text)).Text(); });
  });
  module.def("transmission_of_file", [](const std::string& file) {
    return CallWithoutGil([&] { return Take(ReadTransmissionFile(file)).Text(); });
  });
  module.def("parse_path", &ParsePath);
  module.def("read_path", &ReadPath);
  module.def("save_path", &SavePath);
  module.def("instants", &InstantsOf);
}

}  // namespace lf::python
