// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "lf/core/parse_number.h"
#include "lf/core/value_named.h"
#include "lf/light_field/model/brackets.h"
#include "lf/render/package/package_file.h"
#include "lf/render/package/package_format.h"
#include "lf/storage/remote/store_url.h"
#include "lf/storage/sqlite/seal.h"
#include "lf/storage/tables/calibration_tables.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr int64_t kMostFrames = 1'000'000;

bool IsRenderCamera(const RenderCamera& camera) {
  const int blades = camera.aperture.blades;
  return IsCamera(camera.pinhole.intrinsics) && IsPose(camera.pinhole.cam_from_world) &&
         IsWithin(camera.aperture.radius_w, 0, kMostNumber) &&
         (blades == 0 || (blades >= 3 && blades <= 1000)) && IsShape(camera) &&
         std::abs(camera.focus_plane.normal.norm() - 1) < 1e-6 && camera.unit_m > 0;
}

class Reader {
 public:
  Reader(Database database, const fs::path& path) : database_(std::move(database)), path_(path) {}

  Result<Package> Read() {
    package_.name = path_.stem().string();
    LF_RETURN_IF_ERROR(ReadSettings());
    LF_ASSIGN_OR_RETURN(package_.light_field.intrinsics, ReadIntrinsics(settings_, &database_));
    LF_RETURN_IF_ERROR(ReadImages());
    LF_RETURN_IF_ERROR(ReadFrames());
    LF_RETURN_IF_ERROR(ReadShutter());
    LF_RETURN_IF_ERROR(ReadSurfaces());
    return std::move(package_);
  }

 private:
  Error Damaged(const std::string& what) const { return settings_.Damaged(what); }

  Result<void> ReadSettings();
  Result<void> ReadNumber();
  Result<void> ReadChoices();
  Result<void> ReadImages();
  Result<void> ReadImage(const Statement& row);
  Result<void> ReadVirtual();
  Result<void> ReadFrames();
  Result<void> ReadShutter();
  Result<void> ReadInstants();
  Result<void> ReadSurfaces();
  Result<RenderCamera> CameraIn(const Statement& row, int column, const std::string& of) const;
  Result<void> ReadSurroundings(const std::vector<double>& numbers, int64_t frame);
  fs::path PathOf(const std::string& key) const;
  PackageSource Source() const;

  Database database_;
  const fs::path& path_;
  Settings settings_;
  TransmissionPtr transmission_;  // of the cameras of all frames and instants; null: there is none
  Package package_;
};

Result<void> Reader::ReadSettings() {
  LF_ASSIGN_OR_RETURN(settings_, Settings::Read(database_, kPackageFormat.name));
  package_.light_field.folder = PathOf("folder");
  package_.source = Source();
  LF_RETURN_IF_ERROR(ReadPixelSettings(settings_, &package_.light_field));
  LF_ASSIGN_OR_RETURN(const uint64_t whole_count, settings_.Whole("light_field.images"));
  package_.whole = {whole_count, settings_.Text("light_field.names"),
                    settings_.Text("light_field.calibration")};
  LF_ASSIGN_OR_RETURN(const double end, settings_.Number("ranks", 1, kMostImages));
  package_.ranks.end = static_cast<uint32_t>(end);
  LF_RETURN_IF_ERROR(ReadNumber());
  LF_ASSIGN_OR_RETURN(package_.path.fps, settings_.Number("fps", 1e-3, 1e6));
  LF_ASSIGN_OR_RETURN(package_.path.unit_m, settings_.Number("path_unit_m", 1e-9, 1e9));
  if (const std::string& first = settings_.Text("first_frame"); !first.empty()) {
    const std::optional<uint32_t> number = ParseFrameNumber(first);
    if (!number) return settings_.Wrong("first_frame", "the number of a frame");
    package_.path.first_frame = *number;
  }
  return ReadChoices();
}

// Reads the package's number from text such as "3 of 8".
Result<void> Reader::ReadNumber() {
  constexpr std::string_view kOf = " of ";
  const std::string text = settings_.Text("package");
  const size_t of = std::min(text.find(kOf), text.size());
  const auto number = ParseNumbers(text.substr(0, of));
  const auto count = ParseNumbers(text.substr(std::min(text.size(), of + kOf.size())));
  const auto is_count = [](double x) { return IsWithin(x, 1, kMostFrames) && x == std::floor(x); };
  const auto is_one = [&](const auto& list) {
    return list && list->size() == 1 && is_count(list->front());
  };
  if (!is_one(number) || !is_one(count)) return settings_.Wrong("package", "like 3 of 8");
  package_.number = static_cast<size_t>(number->front());
  package_.count = static_cast<size_t>(count->front());
  return {};
}

Result<void> Reader::ReadChoices() {
  PackageChoices& choices = package_.choices;
  const std::optional<ImageOrder> order = ImageOrderOf(settings_.Text("order"));
  if (!order) return settings_.Wrong("order", "spread, shuffle, round-robin, area or groups");
  choices.order = *order;
  LF_ASSIGN_OR_RETURN(choices.seed, settings_.Whole("seed"));
  if (!settings_.Text("max_images").empty()) {
    LF_ASSIGN_OR_RETURN(choices.max_image_count, settings_.Whole("max_images"));
    if (choices.max_image_count == 0) return settings_.Wrong("max_images", "1 or more");
  }
  if (!settings_.Text("max_angle_rad").empty()) {
    LF_ASSIGN_OR_RETURN(choices.max_angle_rad, settings_.Number("max_angle_rad", 0, kPi));
  }
  constexpr const char* kAnswers[] = {"no", "yes"};
  LF_ASSIGN_OR_RETURN(const int has_neighbours, settings_.Word("lens_neighbours", kAnswers));
  choices.has_neighbours = has_neighbours == 1;
  constexpr const char* kModes[] = {"collect", "rebin", "hybrid"};
  LF_ASSIGN_OR_RETURN(const int mode, settings_.Word("mode", kModes));
  choices.mode = *RenderModeOf(kModes[mode]);
  if (!Rebins(choices.mode)) return {};
  // Packages that were made before there were kept pixels do not have the key.
  const std::string interpolation = settings_.Text("interpolation");
  const auto found =
      ValueNamed(interpolation, {RayInterpolation::kPixels, RayInterpolation::kCells});
  if (!found && !interpolation.empty()) return settings_.Wrong("interpolation", "pixels or cells");
  choices.interpolation = found.value_or(RayInterpolation::kCells);
  return {};
}

// Returns the path that a file or folder, or the URL that a store, had when the package was made.
// If it no longer exists, returns the path with the same position relative to the package, if that
// exists.
fs::path Reader::PathOf(const std::string& key) const {
  const fs::path path = settings_.Text(key);
  if (IsUrl(path.string())) return path;
  std::error_code error;
  if (fs::exists(path, error)) return path;
  const fs::path from_here =
      (fs::absolute(path_).parent_path() / settings_.Text(key + "_from_package"))
          .lexically_normal();
  return fs::exists(from_here, error) ? from_here : path;
}

PackageSource Reader::Source() const {
  if (settings_.Text("light_field.path").empty()) return {PathOf("folder"), {}};
  PackageSource source{PathOf("light_field.path"), {}};
  std::istringstream options(settings_.Text("light_field.options"));
  for (std::string word; std::getline(options, word);) source.options.push_back(word);
  return source;
}

// Reads LF images by ascending ids. This is their order in the package that was written.
Result<void> Reader::ReadImages() {
  LF_RETURN_IF_ERROR(ForEachRow(
      database_,
      "select rank, id, name, mask, intrinsics, gain, pose, file_bytes, x_begin, y_begin, x_end, "
      "y_end, frames, rays from lf_images order by id",
      [this](const Statement& row) { return ReadImage(row); }));
  LF_RETURN_IF_ERROR(ReadVirtual());
  LightField& light_field = package_.light_field;
  if (std::all_of(light_field.mask_names.begin(), light_field.mask_names.end(),
                  [](const std::string& name) { return name.empty(); }))
    light_field.mask_names.clear();
  // The LF images of one pose (a bracket) see the same rays, so that the package has all of them or
  // none.
  if (light_field.encoding.masks_clipped) ApplyBrackets(&light_field);
  std::vector<uint32_t> ranks = package_.ranks.of_images;
  std::sort(ranks.begin(), ranks.end());
  if (std::adjacent_find(ranks.begin(), ranks.end()) != ranks.end())
    return Damaged("two LF images have the same rank in the order");
  return {};
}

// Marks the virtual LF images. Most packages have none, and lack the table.
Result<void> Reader::ReadVirtual() {
  LF_ASSIGN_OR_RETURN(const bool has_virtual, HasTable(&database_, "virtual_images"));
  if (!has_virtual) return {};
  LF_ASSIGN_OR_RETURN(const uint64_t count, settings_.Whole("light_field.virtual"));
  if (count > package_.whole.image_count)
    return settings_.Wrong("light_field.virtual", "at most the number of LF images");
  package_.whole_virtual_count = count;
  LF_RETURN_IF_ERROR(ForEachRow(
      database_, "select id from virtual_images", [this](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(0));
        const auto image = std::lower_bound(
            package_.images.begin(), package_.images.end(), id,
            [](const PackageImage& a, int64_t wanted) { return int64_t{a.id} < wanted; });
        if (image == package_.images.end() || int64_t{image->id} != id)
          return Damaged(fmt::format("LF image {} is virtual, but missing", id));
        const auto index = static_cast<size_t>(image - package_.images.begin());
        package_.light_field.cameras[index].is_virtual = true;
        return {};
      }));
  const LightField& light_field = package_.light_field;
  if (light_field.size() - RecordedCount(light_field) > count)
    return settings_.Wrong("light_field.virtual", "at least the number of virtual LF images");
  return {};
}

Result<void> Reader::ReadImage(const Statement& row) {
  LightField& light_field = package_.light_field;
  LF_ASSIGN_OR_RETURN(const int64_t rank, row.Integer(0, 0, package_.ranks.end - 1));
  PackageImage image;
  LF_ASSIGN_OR_RETURN(const int64_t id, row.Integer(1, 0, kMostImages));
  LF_ASSIGN_OR_RETURN(std::string name, row.Text(2));
  LF_ASSIGN_OR_RETURN(std::string mask, row.Text(3));
  LF_ASSIGN_OR_RETURN(const LfCamera camera,
                      ReadCamera(settings_, row, 4, name, light_field.intrinsics.size()));
  LF_ASSIGN_OR_RETURN(const int64_t file_bytes, row.Integer(7, 0, INT64_MAX));
  int64_t sides[4];
  for (int i = 0; i < 4; ++i) {
    LF_ASSIGN_OR_RETURN(sides[i], row.Integer(8 + i, 0, kMostSide_px));
  }
  LF_ASSIGN_OR_RETURN(const int64_t frames, row.Integer(12, 0, kMostFrames));
  LF_ASSIGN_OR_RETURN(const int64_t rays, row.Integer(13, 0, INT64_MAX));
  image.id = static_cast<uint32_t>(id);
  image.file_bytes = static_cast<uint64_t>(file_bytes);
  image.rect = {static_cast<int>(sides[0]), static_cast<int>(sides[1]), static_cast<int>(sides[2]),
                static_cast<int>(sides[3])};
  image.frame_count = static_cast<uint32_t>(frames);
  image.ray_count = static_cast<uint64_t>(rays);
  light_field.cameras.push_back(camera);
  light_field.image_names.push_back(std::move(name));
  light_field.mask_names.push_back(std::move(mask));
  package_.ranks.of_images.push_back(static_cast<uint32_t>(rank));
  package_.images.push_back(image);
  return {};
}

// Reads the surroundings of a frame. Either all frames of a film have them, or none.
Result<void> Reader::ReadSurroundings(const std::vector<double>& numbers, int64_t frame) {
  const size_t before = package_.path.frame_count() - 1;
  if (numbers.empty() && package_.surroundings.empty()) return {};
  const bool has_recorded = numbers.size() == kSurroundingsNumbers + 1;
  const bool are_sane = (numbers.size() == kSurroundingsNumbers || has_recorded) &&
                        std::all_of(numbers.begin(), numbers.end(),
                                    [](double x) { return std::abs(x) <= kMostNumber; }) &&
                        numbers[0] >= 0 && numbers[1] >= 0 && numbers[5] >= 0 &&
                        (numbers[0] == 0 || numbers[1] > 0) && numbers.back() >= 0;
  if (!are_sane || package_.surroundings.size() != before)
    return Damaged(fmt::format(
        "the values of the LF cameras around frame {} are missing or impossible", frame));
  package_.surroundings.push_back({numbers[0],
                                   numbers[1],
                                   {numbers[2], numbers[3], numbers[4]},
                                   numbers[5],
                                   has_recorded ? std::optional(numbers.back()) : std::nullopt});
  return {};
}

// Reads the camera in a column.
//   of  names the frame or instant in messages
Result<RenderCamera> Reader::CameraIn(const Statement& row, int column,
                                      const std::string& of) const {
  LF_ASSIGN_OR_RETURN(const std::string_view bytes, row.Blob(column));
  const std::vector<double> numbers = NumbersOf<double>(bytes);
  if (numbers.size() != kCameraNumbers && numbers.size() != kCameraNumbers + kShapeNumbers)
    return Damaged(fmt::format("the camera of {} has {} bytes, expected {} or {}", of, bytes.size(),
                               kCameraNumbers * sizeof(double),
                               (kCameraNumbers + kShapeNumbers) * sizeof(double)));
  const bool are_finite = std::all_of(numbers.begin(), numbers.end(),
                                      [](double x) { return std::abs(x) <= kMostNumber; }) &&
                          IsWithin(numbers[5], 1, kMostSide_px) &&
                          IsWithin(numbers[6], 1, kMostSide_px);
  RenderCamera camera = are_finite ? CameraOfNumbers(numbers) : RenderCamera();
  camera.transmission = transmission_;
  const Intrinsics& plate = camera.pinhole.intrinsics;
  const std::vector<RenderCamera>& film = package_.path.cameras;
  const bool has_size =
      film.empty() || (plate.width_px == film.front().pinhole.intrinsics.width_px &&
                       plate.height_px == film.front().pinhole.intrinsics.height_px);
  if (!are_finite || !IsRenderCamera(camera) || !has_size)
    return Damaged(fmt::format(
        "the camera of {} has impossible values, or another resolution than the first frame", of));
  return camera;
}

// Reads the shutter and its instants. A package has both or none of them.
Result<void> Reader::ReadShutter() {
  LF_ASSIGN_OR_RETURN(const bool has_instants, HasTable(&database_, "instants"));
  if (settings_.Text("shutter_samples").empty() != !has_instants)
    return Damaged("it has only one of the shutter and the cameras of its instants");
  if (!has_instants) return {};
  Shutter& shutter = package_.path.shutter;
  LF_ASSIGN_OR_RETURN(shutter.angle_deg, settings_.Number("shutter_angle_deg", 0, 360));
  LF_ASSIGN_OR_RETURN(const double samples,
                      settings_.Number("shutter_samples", 2, kMostShutterSamples));
  if (samples != std::floor(samples)) return settings_.Wrong("shutter_samples", "a whole number");
  shutter.samples = static_cast<int>(samples);
  return ReadInstants();
}

Result<void> Reader::ReadInstants() {
  CameraPath& film = package_.path;
  const auto samples = static_cast<int64_t>(film.shutter.samples);
  LF_RETURN_IF_ERROR(ForEachRow(
      database_, "select frame, instant, camera, camera_distance from instants order by rowid",
      [&](const Statement& row) -> Result<void> {
        const auto index = static_cast<int64_t>(film.instants.size());
        const int64_t frame = film.first_frame + index / samples, instant = index % samples + 1;
        LF_ASSIGN_OR_RETURN(const int64_t row_frame, row.Integer(0));
        LF_ASSIGN_OR_RETURN(const int64_t row_instant, row.Integer(1));
        const std::string of = fmt::format("instant {} of frame {}", instant, frame);
        if (row_frame != frame || row_instant != instant ||
            index / samples >= static_cast<int64_t>(film.frame_count()))
          return Damaged(
              fmt::format("expected {}, found instant {} of frame {}", of, row_instant, row_frame));
        LF_ASSIGN_OR_RETURN(const RenderCamera camera, CameraIn(row, 2, of));
        film.instants.push_back(camera);
        LF_ASSIGN_OR_RETURN(const double distance_w, row.Real(3));
        if (!(distance_w <= kMostNumber) || !(distance_w >= 0 || distance_w == -1))
          return Damaged(fmt::format("the distance between LF cameras at {} is impossible", of));
        package_.instant_distances_w.push_back(distance_w);
        return {};
      }));
  if (film.instants.size() != film.frame_count() * static_cast<size_t>(samples))
    return Damaged(fmt::format("it has the cameras of {} instants, expected {}",
                               film.instants.size(),
                               film.frame_count() * static_cast<size_t>(samples)));
  const std::vector<double>& distances_w = package_.instant_distances_w;
  const auto is_measured = [](double distance_w) { return distance_w >= 0; };
  for (const PackageFrame& frame : package_.frames) {
    const auto first =
        distances_w.begin() +
        static_cast<ptrdiff_t>(film.frames().IndexOf(frame.id) * static_cast<size_t>(samples));
    const auto count = std::count_if(first, first + samples, is_measured);
    if (count != (package_.choices.has_neighbours ? samples : 0))
      return Damaged(fmt::format(
          "the distances between LF cameras at the instants of frame {} are missing or impossible",
          frame.id.value));
  }
  return {};
}

// Reads the focal surfaces of all frames and instants. A package has all or none of them.
Result<void> Reader::ReadSurfaces() {
  LF_ASSIGN_OR_RETURN(const bool has_surfaces, HasTable(&database_, "focal_surfaces"));
  if (!has_surfaces) return {};
  CameraPath& film = package_.path;
  const auto samples = static_cast<size_t>(film.shutter.samples);
  size_t count = 0;
  LF_RETURN_IF_ERROR(ForEachRow(
      database_, "select frame, instant, pieces from focal_surfaces order by rowid",
      [&](const Statement& row) -> Result<void> {
        const size_t i = count++, k = i - std::min(i, film.cameras.size());
        if (i >= film.cameras.size() + film.instants.size())
          return Damaged("it has more focal surfaces than cameras");
        const bool is_frame = i < film.cameras.size();
        LF_ASSIGN_OR_RETURN(const int64_t frame, row.Integer(0));
        LF_ASSIGN_OR_RETURN(const int64_t instant, row.Integer(1));
        if (frame != static_cast<int64_t>(film.first_frame + (is_frame ? i : k / samples)) ||
            instant != static_cast<int64_t>(is_frame ? 0 : k % samples + 1))
          return Damaged("its focal surfaces are not in the order of frames and instants");
        LF_ASSIGN_OR_RETURN(const std::string_view pieces, row.Blob(2));
        RenderCamera& camera = is_frame ? film.cameras[i] : film.instants[k];
        const Intrinsics& plate = camera.pinhole.intrinsics;
        Result<FocalSurface> surface =
            FocalSurface::FromBytes(pieces, plate.width_px, plate.height_px);
        if (!surface) return Damaged(fmt::format("frame {}: {}", frame, surface.error().message));
        camera.surface = std::make_shared<const FocalSurface>(*std::move(surface));
        return {};
      }));
  if (count != film.cameras.size() + film.instants.size())
    return Damaged(fmt::format("it has {} focal surfaces, expected {}", count,
                               film.cameras.size() + film.instants.size()));
  return {};
}

Result<void> Reader::ReadFrames() {
  CameraPath& film = package_.path;
  if (const std::string& places = settings_.Text("transmission"); !places.empty()) {
    const Result<Transmission> read = Transmission::FromText(places);
    if (!read) return settings_.Wrong("transmission", read.error().message);
    transmission_ = std::make_shared<const Transmission>(*read);
  }
  LF_RETURN_IF_ERROR(ForEachRow(
      database_,
      "select frame, camera, is_rendered, lf_images, rays, surroundings from frames "
      "order by frame",
      [&](const Statement& row) -> Result<void> {
        LF_ASSIGN_OR_RETURN(const int64_t number, row.Integer(0, 0, kLargestFrameNumber));
        const size_t expected = film.first_frame + film.frame_count();
        if (number != static_cast<int64_t>(expected))
          return Damaged(fmt::format("frame {} is missing", expected));
        if (film.frame_count() == kMostFrames)
          return Damaged(fmt::format("it has more than {} frames", kMostFrames));
        LF_ASSIGN_OR_RETURN(const RenderCamera camera,
                            CameraIn(row, 1, fmt::format("frame {}", number)));
        film.cameras.push_back(camera);
        LF_ASSIGN_OR_RETURN(const int64_t is_rendered, row.Integer(2, 0, 1));
        LF_ASSIGN_OR_RETURN(const int64_t images, row.Integer(3, 0, kMostImages));
        LF_ASSIGN_OR_RETURN(const int64_t rays, row.Integer(4, 0, INT64_MAX));
        LF_ASSIGN_OR_RETURN(const std::string_view surroundings, row.Blob(5));
        // LF_RETURN_IF_ERROR cannot be used here, because this lambda is an argument of
        // that macro.
        const auto read = ReadSurroundings(NumbersOf<double>(surroundings), number);
        if (!read || is_rendered == 0) return read;
        PackageFrame frame;
        frame.id = FrameId{static_cast<uint32_t>(number)};
        frame.image_count = static_cast<uint64_t>(images);
        frame.ray_count = static_cast<uint64_t>(rays);
        package_.frames.push_back(frame);
        return {};
      }));
  if (package_.frames.empty()) return Damaged("it has no frame to render");
  const bool has_all = package_.surroundings.size() == film.frame_count();
  if (package_.choices.has_neighbours ? !has_all : !package_.surroundings.empty())
    return Damaged("it does not describe the LF cameras around its frames");
  return {};
}

}  // namespace

bool IsPackageName(const fs::path& path) { return path.extension() == ".lfp"; }

Result<Package> ReadPackage(const fs::path& path, const ReadPackageOptions& options) {
  const std::string tables = std::string(kSettingsTable) + kIntrinsicsTable + kPackageTables;
  std::vector<std::string> allowed;
  for (const char* const of_virtual : {"", kVirtualTable})
    for (const char* const of_instants : {"", kInstantsTable})
      for (const char* const of_surfaces : {"", kSurfacesTable})
        allowed.push_back(tables + of_virtual + of_instants + of_surfaces);
  LF_ASSIGN_OR_RETURN(Database database, Database::Open(path, kPackageFormat, allowed));
  if (options.check_seal) LF_RETURN_IF_ERROR(CheckSeal(path, kPackageFormat.name));
  return Reader(std::move(database), path).Read();
}

}  // namespace lf
