// SPDX-License-Identifier: Apache-2.0
#include "python/src/light_field.h"

#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "python/src/arrays.h"
#include "python/src/errors.h"
#include "python/src/gil.h"
#include "python/src/work.h"

#include "lf/camera/distortion_name.h"
#include "lf/camera/ray_through.h"
#include "lf/focus/example_path.h"
#include "lf/import/formats/light_field_words.h"
#include "lf/import/formats/picture_grid.h"
#include "lf/import/paths/focal_surface_file.h"
#include "lf/light_field/model/capture_geometry.h"
#include "lf/light_field/model/keep_images.h"
#include "lf/light_field/model/lf_light.h"
#include "lf/live/shrink.h"
#include "lf/pixels/files/image_file.h"
#include "lf/storage/load/open_store.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf::python {
namespace {

namespace py = pybind11;

// Memory for reference images of predicted LF images, of LF images that a script reads one by one.
constexpr uint64_t kReferenceBytes = uint64_t{256} << 20;

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::shared_ptr<OpenedField> Open(
    const std::string& path, double focal_px, double fov_deg, const std::string& images,
    const std::string& image_scale, const std::string& image_alpha, const std::string& background,
    const std::optional<std::array<double, 2>>& pitch, std::optional<double> plane_distance,
    const std::optional<std::array<int, 2>>& grid, const std::string& layout,
    const std::array<bool, 3>& flips, const std::vector<double>& times, double recorded_fps,
    const std::string& frame_cache, const std::string& store_cache, int reduce) {
  LightFieldWords words;
  if (times.size() == 1) words.time = times[0];
  if (recorded_fps > 0) words.recorded_fps = recorded_fps;
  words.frame_cache = frame_cache;
  words.store_cache = store_cache;
  words.reduce = reduce;
  words.focal_px = focal_px;
  words.fov_deg = fov_deg;
  words.images = images;
  words.image_scale = image_scale;
  words.image_alpha = image_alpha;
  words.background = background;
  return CallOrAbandon([=] {
    auto field = std::make_shared<OpenedField>();
    OpenOptions options = Take(words.Options());
    if (pitch) options.pitch_w = Vec2((*pitch)[0], (*pitch)[1]);
    options.plane_distance_w = plane_distance;
    options.flip_x = flips[0];
    options.flip_y = flips[1];
    options.grid = grid;
    options.layout = PictureLayoutOf(layout);
    options.is_serpentine = flips[2];
    if (times.size() > 1) options.path_times = times;
    field->light_field = Take(OpenLightField(path, options));
    field->store = Take(OpenStore(field->light_field, Mosaics::kToRgb));
    field->store->LimitReferences(kReferenceBytes);
    field->options = words.WordsToKeep();
    return field;
  });
}

// Bytes from one LF camera to the next.
constexpr py::ssize_t kCamera = sizeof(LfCamera);
constexpr py::ssize_t kDouble = sizeof(double);

py::ssize_t CountOf(const OpenedField& field) {
  return static_cast<py::ssize_t>(field.light_field.size());
}

// Returns a view [n][3][4] of the matrices [R|t] in the LF cameras, where each is stored column by
// column.
py::array CamFromWorld(const py::object& self) {
  const auto& field = self.cast<const OpenedField&>();
  static_assert(sizeof(RigidTransform) == 12 * sizeof(double) && !Mat3::IsRowMajor);
  const auto* const first =
      reinterpret_cast<const double*>(&field.light_field.cameras.data()->cam_from_world);
  return ReadOnlyView(first, {CountOf(field), 3, 4}, {kCamera, kDouble, 3 * kDouble}, self);
}

py::array IntrinsicsIndex(const py::object& self) {
  const auto& field = self.cast<const OpenedField&>();
  return ReadOnlyView(&field.light_field.cameras.data()->intrinsics_index, {CountOf(field)},
                      {kCamera}, self);
}

py::array Gains(const py::object& self) {
  const auto& field = self.cast<const OpenedField&>();
  return ReadOnlyView(field.light_field.cameras.data()->gain.of_channels.data(),
                      {CountOf(field), 3}, {kCamera, sizeof(float)}, self);
}

py::array IsVirtual(const py::object& self) {
  const auto& field = self.cast<const OpenedField&>();
  return ReadOnlyView(&field.light_field.cameras.data()->is_virtual, {CountOf(field)}, {kCamera},
                      self);
}

py::array Centres(const OpenedField& field) {
  Numbers centres({CountOf(field), py::ssize_t{3}});
  double* out = centres.mutable_data();
  for (const LfCamera& camera : field.light_field.cameras) {
    const Vec3 centre = camera.cam_from_world.Inverse().translation;
    for (int axis = 0; axis < 3; ++axis) *out++ = centre[axis];
  }
  return centres;
}

py::list IntrinsicsOf(const OpenedField& field) {
  py::list all;
  for (const Intrinsics& k : field.light_field.intrinsics)
    all.append(py::make_tuple(k.Matrix(), k.width_px, k.height_px, lf::NameOf(k.distortion.model),
                              k.distortion.parameters));
  return all;
}

LfImageId IdOf(const OpenedField& field, py::ssize_t i) {
  if (i < 0 || i >= CountOf(field))
    throw py::index_error(fmt::format("LF image {}: the light field has {} LF images, from 0 to {}",
                                      i, CountOf(field), CountOf(field) - 1));
  return LfImageId{static_cast<uint32_t>(i)};
}

// Throws a Failure (kUsage) unless the array has `columns` columns.
void CheckShape(const Numbers& points, int columns, const char* name) {
  if (points.ndim() != 2 || points.shape(1) != columns)
    throw Failure(UsageError(fmt::format("{}: expected an array of shape (n, {}), found {}", name,
                                         columns, std::string(py::str(points.attr("shape"))))));
}

Numbers ProjectPoints(const OpenedField& field, py::ssize_t i, const Numbers& points) {
  CheckShape(points, 3, "points");
  const PinholeCamera camera = field.light_field.Camera(IdOf(field, i));
  const DistortionMap map(camera.intrinsics.distortion);
  const Intrinsics& k = camera.intrinsics;
  Numbers positions({points.shape(0), py::ssize_t{2}});
  for (py::ssize_t row = 0; row < points.shape(0); ++row) {
    const Vec3 point(points.at(row, 0), points.at(row, 1), points.at(row, 2));
    const std::optional<Vec2> at = map.Distort(camera.cam_from_world * point);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    positions.mutable_at(row, 0) = at ? k.fx_px * at->x() + k.skew_px * at->y() + k.cx_px : nan;
    positions.mutable_at(row, 1) = at ? k.fy_px * at->y() + k.cy_px : nan;
  }
  return positions;
}

// Returns the directions, in world axes and of length 1, of the rays that arrive at pixel
// positions; NaN where none arrives.
Numbers RayDirections(const OpenedField& field, py::ssize_t i, const Numbers& pixels) {
  CheckShape(pixels, 2, "pixels");
  const PinholeCamera camera = field.light_field.Camera(IdOf(field, i));
  const DistortionMap map(camera.intrinsics.distortion);
  const Mat3 inverse = camera.intrinsics.InverseMatrix();
  const Mat3 world_from_cam = camera.cam_from_world.rotation.transpose();
  Numbers directions({pixels.shape(0), py::ssize_t{3}});
  for (py::ssize_t row = 0; row < pixels.shape(0); ++row) {
    const Vec3 distorted = inverse * Vec3(pixels.at(row, 0), pixels.at(row, 1), 1);
    const std::optional<Vec3> direction = map.Undistort(Vec2(distorted.x(), distorted.y()));
    const Vec3 world = direction ? Vec3(world_from_cam * direction->normalized())
                                 : Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    for (int axis = 0; axis < 3; ++axis) directions.mutable_at(row, axis) = world[axis];
  }
  return directions;
}

py::array LoadImage(const std::shared_ptr<OpenedField>& field, py::ssize_t i,
                    const std::optional<std::array<int, 4>>& part, float masked) {
  const LfImageId id = IdOf(*field, i);
  const Intrinsics& k = field->light_field.Camera(id).intrinsics;
  const PixelRect whole{0, 0, k.width_px, k.height_px};
  const PixelRect rect = part ? PixelRect{(*part)[0], (*part)[1], (*part)[2], (*part)[3]} : whole;
  if (rect.empty() || Intersection(rect, whole) != rect)
    throw Failure(UsageError(fmt::format(
        "rect ({}, {}, {}, {}): expected x_begin, y_begin, x_end, y_end within the {} x {} pixels "
        "of LF image {}, with at least one pixel",
        rect.x_begin, rect.y_begin, rect.x_end, rect.y_end, k.width_px, k.height_px, i)));
  return ArrayOf(CallOrAbandon([field, id, rect, masked] {
    const LfPixels loaded = Take(LoadWithoutThrowing(
        *field->store, id, rect, field->light_field.image_names[id.value], LfPixels()));
    Image<float> light = LightOf(loaded, field->light_field.encoding, masked);
    if (loaded.rect == rect) return light;
    // A store may load more than it was asked for.
    Image<float> cut(rect.width(), rect.height(), 3);
    for (int y = 0; y < cut.height(); ++y)
      std::copy_n(light.row(y + rect.y_begin - loaded.rect.y_begin) +
                      static_cast<ptrdiff_t>(rect.x_begin - loaded.rect.x_begin) * 3,
                  static_cast<ptrdiff_t>(rect.width()) * 3, cut.row(y));
    return cut;
  }));
}

// Returns an LF image [height][width][3] in linear light, reduced to a width of at most
// `width_px`, or as near to it as squares of whole pixels allow. For a quick look: its light is
// about the mean of the pixels.
py::array Thumbnail(const OpenedField& field, py::ssize_t i, int width_px) {
  const LfImageId id = IdOf(field, i);
  const Intrinsics& k = field.light_field.Camera(id).intrinsics;
  Image<float> small = CallWithoutGil([&] {
    const int square = std::max(1, (k.width_px + width_px - 1) / width_px);
    LfPixels pixels;
    int divisor = 1;
    while (divisor < 8 && 2 * divisor <= square) divisor *= 2;
    divisor = Take(LoadReducedWithoutThrowing(*field.store, id, divisor, k,
                                              field.light_field.image_names[id.value], &pixels));
    LfPixels shrunken;
    Shrink(pixels, std::max(1, square / divisor), &shrunken);
    return LightOf(shrunken, field.light_field.encoding, 0);
  });
  return ArrayOf(std::move(small));
}

// Returns the values of an image file as it stores them, [height][width][channels].
py::array ReadFile(const std::string& path) {
  StoredImage image = CallOrAbandon([path] { return Take(ReadImage(path)); });
  return std::visit([](auto& stored) -> py::array { return ArrayOf(std::move(stored)); }, image);
}

std::string ImageFileOf(const OpenedField& field, py::ssize_t i) {
  const LfImageId id = IdOf(field, i);
  if (HoldsPackedStore(field.light_field))
    throw Failure(UsageError(
        fmt::format("LF image {}: has no file with stored values, because {} is a packed store", i,
                    field.light_field.folder.string())));
  return field.light_field.ImagePath(id).string();
}

// A store that loads nothing any more once it is interrupted, so that work on many LF images ends
// soon: kOutput is the only error after which such work tries no other LF image.
class InterruptibleStore : public LfImageStore {
 public:
  InterruptibleStore(std::unique_ptr<LfImageStore> store, const std::atomic<bool>& interrupted)
      : store_(std::move(store)), interrupted_(interrupted) {}
  Result<void> Load(LfImageId id, const PixelRect& rect, LfPixels* pixels) const override {
    if (interrupted_) return OutputError("interrupted");
    return store_->Load(id, rect, pixels);
  }
  Result<int> LoadReduced(LfImageId id, int divisor, const Intrinsics& k,
                          LfPixels* pixels) const override {
    if (interrupted_) return OutputError("interrupted");
    return store_->LoadReduced(id, divisor, k, pixels);
  }
  bool IsThere(LfImageId id) const override { return store_->IsThere(id); }
  uint64_t StoredBytes(LfImageId id) const override { return store_->StoredBytes(id); }
  void Announce(LfImageId id) const override { store_->Announce(id); }

 private:
  std::unique_ptr<LfImageStore> store_;
  const std::atomic<bool>& interrupted_;
};

// Returns the text of a first camera path, and why its focus may be wrong ("" if it is sure).
py::tuple ExampleOf(const OpenedField& field, const std::string& path, const std::string& move,
                    std::optional<py::ssize_t> camera, std::optional<double> focus_distance_w) {
  const std::optional<ExampleMove> known = ParseExampleMove(move);
  if (!known)
    throw Failure(UsageError(fmt::format(
        "move=\"{}\": expected auto, static, along, orbit, dolly or focus-pull", move)));
  const std::optional<LfImageId> start =
      camera ? std::optional(IdOf(field, *camera)) : std::nullopt;
  ThreadPool& pool = PoolOf(0);
  WorkSignals signals;
  const ExamplePath example = CallWithoutGil(
      [&] {
        // Focus and aperture are chosen for what was recorded.
        const LightField recorded = RecordedPart(field.light_field);
        const InterruptibleStore store(Take(OpenStore(recorded, Mosaics::kToRgb)),
                                       signals.interrupted);
        ExampleOptions options;
        options.move = *known;
        options.camera = start ? *start : Take(FirstCamera(recorded, store));
        options.focus_distance_w = focus_distance_w;
        options.points_world = [&] { return PointsSeenBy(path, recorded, options.camera); };
        return Take(MakeExamplePath(recorded, store, options, pool));
      },
      &signals);
  return py::make_tuple(example.yaml, example.doubt);
}

}  // namespace

void AddLightField(py::module_& module) {
  py::class_<OpenedField, std::shared_ptr<OpenedField>>(module, "LightField")
      .def("__len__", [](const OpenedField& field) { return field.light_field.size(); })
      .def_property_readonly("unit_m", [](const OpenedField& f) { return f.light_field.unit_m; })
      .def_property_readonly("depth_range",
                             [](const OpenedField& f) {
                               const auto& range = f.light_field.depth_range;
                               return range ? std::optional(std::pair(range->near_w, range->far_w))
                                            : std::nullopt;
                             })
      .def_property_readonly(
          "folder", [](const OpenedField& f) { return TextOf(f.light_field.folder.string()); })
      .def_property_readonly("names",
                             [](const OpenedField& f) {
                               py::list names;
                               for (const std::string& name : f.light_field.image_names)
                                 names.append(TextOf(name));
                               return names;
                             })
      .def_property_readonly("cam_from_world", &CamFromWorld)
      .def_property_readonly("intrinsics_index", &IntrinsicsIndex)
      .def_property_readonly("gains", &Gains)
      .def_property_readonly("is_virtual", &IsVirtual)
      .def_property_readonly("times", [](const OpenedField& f) { return f.light_field.times; })
      .def("centres", &Centres)
      .def("intrinsics", &IntrinsicsOf)
      .def("middle", [](const OpenedField& f) { return MiddleCamera(f.light_field).value; })
      .def("mean_up", [](const OpenedField& f) { return MeanUpWorld(f.light_field); })
      .def("spacing", [](const OpenedField& f) { return MedianSpacing(f.light_field); })
      .def("nearest_distance",
           [](const OpenedField& f) { return NearestCameraDistance(f.light_field); })
      .def("project", &ProjectPoints)
      .def("ray_directions", &RayDirections)
      .def("image", &LoadImage)
      .def("thumbnail", &Thumbnail)
      .def("image_file",
           [](const OpenedField& f, py::ssize_t i) { return TextOf(ImageFileOf(f, i)); })
      .def("example", &ExampleOf);
  module.def("open_light_field", &Open);
  module.def("read_image", &ReadFile);
}

}  // namespace lf::python
