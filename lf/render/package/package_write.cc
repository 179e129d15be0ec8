// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <vector>

#include "lf/core/check.h"
#include "lf/core/file.h"
#include "lf/render/package/package_file.h"
#include "lf/render/package/package_format.h"
#include "lf/storage/remote/store_url.h"
#include "lf/storage/sqlite/seal.h"
#include "lf/storage/tables/calibration_tables.h"
#include "lf/storage/tables/stored_numbers.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

class Writer {
 public:
  Writer(Database database, const Package& package)
      : database_(std::move(database)), package_(package), light_field_(package.light_field) {}

  Result<void> Write(const fs::path& final_path, const PackageNotes& notes) {
    LF_RETURN_IF_ERROR(database_.Execute(kSettingsTable));
    LF_RETURN_IF_ERROR(database_.Execute(kIntrinsicsTable));
    LF_RETURN_IF_ERROR(database_.Execute(kPackageTables));
    LF_RETURN_IF_ERROR(database_.Execute("begin"));
    LF_RETURN_IF_ERROR(WriteSettings(SettingsOf(final_path, notes), &database_));
    LF_RETURN_IF_ERROR(WriteIntrinsics(light_field_.intrinsics, &database_));
    LF_RETURN_IF_ERROR(WriteImages());
    if (package_.whole_virtual_count > 0) LF_RETURN_IF_ERROR(WriteVirtual());
    LF_RETURN_IF_ERROR(WriteFrames());
    if (package_.path.shutter.exists()) LF_RETURN_IF_ERROR(WriteInstants());
    if (package_.path.cameras.front().surface) LF_RETURN_IF_ERROR(WriteSurfaces());
    return database_.Execute("commit");
  }

 private:
  SettingList SettingsOf(const fs::path& final_path, const PackageNotes& notes) const {
    // An empty path means the working folder.
    const auto absolute = [](const fs::path& path) {
      return fs::absolute(path.empty() ? "." : path).lexically_normal();
    };
    const auto from_package = [&](const fs::path& path) {
      return path.lexically_relative(absolute(final_path).parent_path()).string();
    };
    const fs::path folder = absolute(light_field_.folder);
    const PackageChoices& choices = package_.choices;
    SettingList settings = {{"written_by", "lfrendertools " + notes.version},
                            {"package", fmt::format("{} of {}", package_.number, package_.count)},
                            {"light_field", notes.light_field},
                            {"light_field.images", fmt::format("{}", package_.whole.image_count)},
                            {"light_field.names", package_.whole.names},
                            {"light_field.calibration", package_.whole.calibration},
                            {"folder", folder.string()},
                            {"folder_from_package", from_package(folder)}};
    if (!notes.light_field.empty()) {
      const bool is_url = IsUrl(notes.light_field);
      const fs::path source = is_url ? fs::path(notes.light_field) : absolute(notes.light_field);
      settings.emplace_back("light_field.path", source.string());
      if (!is_url) settings.emplace_back("light_field.path_from_package", from_package(source));
      settings.emplace_back("light_field.options",
                            fmt::format("{}", fmt::join(notes.light_field_options, "\n")));
    }
    const SettingList pixels = SettingsOfPixels(light_field_);
    const SettingList of_choices = {
        {"order", NameOf(choices.order)},
        {"seed", fmt::format("{}", choices.seed)},
        {"ranks", fmt::format("{}", package_.ranks.end)},
        {"max_images", choices.max_image_count ? fmt::format("{}", *choices.max_image_count) : ""},
        {"max_angle_rad", choices.max_angle_rad ? fmt::format("{}", *choices.max_angle_rad) : ""},
        {"lens_neighbours", choices.has_neighbours ? "yes" : "no"},
        {"mode", NameOf(choices.mode)},
        {"fps", fmt::format("{}", package_.path.fps)},
        {"path_unit_m", fmt::format("{}", package_.path.unit_m)}};
    if (choices.interpolation != RayInterpolation::kAuto)
      settings.emplace_back("interpolation", NameOf(choices.interpolation));
    if (package_.path.first_frame != 1)
      settings.emplace_back("first_frame", fmt::format("{}", package_.path.first_frame));
    if (package_.whole_virtual_count > 0)
      settings.emplace_back("light_field.virtual", fmt::format("{}", package_.whole_virtual_count));
    if (const TransmissionPtr& of_film = package_.path.cameras.front().transmission)
      settings.emplace_back("transmission", of_film->Text());
    if (const Shutter& shutter = package_.path.shutter; shutter.exists()) {
      settings.emplace_back("shutter_angle_deg", fmt::format("{}", shutter.angle_deg));
      settings.emplace_back("shutter_samples", fmt::format("{}", shutter.samples));
    }
    settings.insert(settings.end(), pixels.begin(), pixels.end());
    settings.insert(settings.end(), of_choices.begin(), of_choices.end());
    return settings;
  }

  // Writes one row for each LF image, by ascending ranks, because SQLite then only appends rows.
  Result<void> WriteImages() {
    LF_CHECK(package_.images.size() == light_field_.size());
    LF_CHECK(light_field_.size() - RecordedCount(light_field_) <= package_.whole_virtual_count);
    LF_ASSIGN_OR_RETURN(Statement image,
                        database_.Prepare("insert into lf_images values "
                                          "(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"));
    std::vector<uint32_t> order(light_field_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [this](uint32_t a, uint32_t b) {
      return package_.ranks.of_images[a] < package_.ranks.of_images[b];
    });
    for (const uint32_t i : order) {
      const int64_t rank = package_.ranks.of_images[i];
      LF_RETURN_IF_ERROR(WriteImage(&image, i, rank));
    }
    return {};
  }

  // Makes and writes the table that only packages of light fields with virtual LF images have, so
  // that the bytes of all other packages stay the same.
  Result<void> WriteVirtual() {
    LF_RETURN_IF_ERROR(database_.Execute(kVirtualTable));
    LF_ASSIGN_OR_RETURN(Statement insert,
                        database_.Prepare("insert into virtual_images values (?)"));
    for (size_t i = 0; i < light_field_.size(); ++i)
      if (light_field_.cameras[i].is_virtual)
        LF_RETURN_IF_ERROR(insert.Bind(0, int64_t{package_.images[i].id}).Run());
    return {};
  }

  Result<void> WriteImage(Statement* insert, uint32_t i, int64_t rank) {
    const PackageImage& image = package_.images[i];
    insert->Bind(0, rank).Bind(1, int64_t{image.id});
    insert->Bind(2, std::string_view(light_field_.image_names[i]));
    insert->Bind(3, light_field_.mask_names.empty() ? std::string_view()
                                                    : std::string_view(light_field_.mask_names[i]));
    BindCamera(light_field_, LfImageId{i}, 4, insert);
    insert->Bind(10, static_cast<int64_t>(image.file_bytes));
    insert->Bind(11, int64_t{image.rect.x_begin}).Bind(12, int64_t{image.rect.y_begin});
    insert->Bind(13, int64_t{image.rect.x_end}).Bind(14, int64_t{image.rect.y_end});
    insert->Bind(15, int64_t{image.frame_count}).Bind(16, static_cast<int64_t>(image.ray_count));
    return insert->Run();
  }

  // Writes all frames of the film, and marks those that this package renders (is_rendered).
  Result<void> WriteFrames() {
    const CameraPath& path = package_.path;
    const auto differs = [&](const RenderCamera& camera) {
      return !AreEqual(camera.transmission, path.cameras.front().transmission);
    };
    if (std::any_of(path.cameras.begin(), path.cameras.end(), differs) ||
        std::any_of(path.instants.begin(), path.instants.end(), differs))
      return UsageError(
          "the frames have lenses with different transmissions, but a package holds one: "
          "render the film without packages, or divide the path");
    LF_ASSIGN_OR_RETURN(
        Statement insert,
        database_.Prepare("insert into frames values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)"));
    auto rendered = package_.frames.begin();
    for (const FrameId id : path.frames().All()) {
      const RenderCamera& camera = path.Camera(id);
      const Vec3 centre = camera.pinhole.CentreWorld();
      const auto numbers = NumbersOfCamera(camera);
      const bool is_rendered = rendered != package_.frames.end() && rendered->id == id;
      PackageFrame frame;
      if (is_rendered) frame = *rendered++;
      insert.Bind(0, int64_t{id.value}).Bind(1, camera.time_s);
      insert.Bind(2, centre.x()).Bind(3, centre.y()).Bind(4, centre.z());
      insert.Bind(5, 2 * camera.aperture.radius_w).Bind(6, camera.focus_distance_w);
      insert.BindBlob(7, BytesOf(std::span<const double>(numbers)));
      insert.Bind(8, int64_t{is_rendered}).Bind(9, static_cast<int64_t>(frame.image_count));
      insert.Bind(10, static_cast<int64_t>(frame.ray_count));
      const std::optional<double> distance_w = package_.CameraDistance(id);
      insert.Bind(11, distance_w ? *distance_w : -1.0);  // -1: not measured
      const std::vector<double> surroundings = SurroundingsOf(id);
      insert.BindBlob(12, BytesOf(std::span<const double>(surroundings)));
      LF_RETURN_IF_ERROR(insert.Run());
    }
    return {};
  }

  // Makes and writes the table that only packages of a path with a shutter have.
  Result<void> WriteInstants() {
    LF_RETURN_IF_ERROR(database_.Execute(kInstantsTable));
    LF_ASSIGN_OR_RETURN(Statement insert,
                        database_.Prepare("insert into instants values (?, ?, ?, ?, ?)"));
    for (const FrameId id : package_.path.frames().All()) {
      const std::span<const RenderCamera> instants = package_.path.Instants(id);
      const std::span<const double> distances_w = package_.InstantDistances(id);
      for (size_t k = 0; k < instants.size(); ++k) {
        const std::vector<double> numbers = NumbersOfCamera(instants[k]);
        insert.Bind(0, int64_t{id.value}).Bind(1, static_cast<int64_t>(k + 1));
        insert.Bind(2, instants[k].time_s);
        insert.BindBlob(3, BytesOf(std::span<const double>(numbers)));
        insert.Bind(4, distances_w.empty() ? -1.0 : distances_w[k]);  // -1: not measured
        LF_RETURN_IF_ERROR(insert.Run());
      }
    }
    return {};
  }

  // Makes and writes the table that only packages of a path with focal surfaces have.
  Result<void> WriteSurfaces() {
    LF_RETURN_IF_ERROR(database_.Execute(kSurfacesTable));
    LF_ASSIGN_OR_RETURN(Statement insert,
                        database_.Prepare("insert into focal_surfaces values (?, ?, ?)"));
    const CameraPath& path = package_.path;
    const auto write = [&](const RenderCamera& camera, size_t index,
                           size_t instant) -> Result<void> {
      LF_CHECK(camera.surface != nullptr);
      const std::string bytes = camera.surface->Bytes();
      insert.Bind(0, int64_t{path.frames().At(index).value}).Bind(1, static_cast<int64_t>(instant));
      insert.BindBlob(2, bytes);
      return insert.Run();
    };
    for (size_t i = 0; i < path.cameras.size(); ++i)
      LF_RETURN_IF_ERROR(write(path.cameras[i], i, 0));
    const auto samples = static_cast<size_t>(path.shutter.samples);
    for (size_t i = 0; i < path.instants.size(); ++i)
      LF_RETURN_IF_ERROR(write(path.instants[i], i / samples, i % samples + 1));
    return {};
  }

  // Returns the numbers that describe the surroundings of a frame; empty if they were not measured.
  std::vector<double> SurroundingsOf(FrameId frame) const {
    if (package_.surroundings.empty()) return {};
    const FrameSurroundings& around = package_.surroundings[package_.path.frames().IndexOf(frame)];
    const Vec3& middle = around.middle_world;
    std::vector<double> numbers = {around.camera_distance_w,
                                   around.pixel_rad,
                                   middle.x(),
                                   middle.y(),
                                   middle.z(),
                                   around.hole_w};
    if (around.recorded_distance_w) numbers.push_back(*around.recorded_distance_w);
    return numbers;
  }

  Database database_;
  const Package& package_;
  const LightField& light_field_;
};

}  // namespace

Result<void> WritePackage(const fs::path& path, const Package& package, const PackageNotes& notes) {
  return WriteAtomically(path, [&](const fs::path& temporary) -> Result<void> {
    return WritePackageAs(temporary, path, package, notes);
  });
}

Result<void> WritePackageAs(const fs::path& as, const fs::path& path, const Package& package,
                            const PackageNotes& notes) {
  {
    LF_ASSIGN_OR_RETURN(Database database, Database::Create(as, kPackageFormat));
    LF_RETURN_IF_ERROR(Writer(std::move(database), package).Write(path, notes));
  }
  return SealFile(as);
}

}  // namespace lf
