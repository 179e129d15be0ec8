// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/render_packages.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "lf/core/log.h"
#include "lf/film/develop/video.h"
#include "lf/light_field/model/image_files.h"
#include "lf/light_field/model/reduction.h"
#include "lf/render/package/package_file.h"
#include "lf/render/pipeline/check_outputs.h"
#include "lf/render/pipeline/frame_output.h"
#include "lf/render/state/run_inputs.h"
#include "lf/render/state/run_state.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kLookedAt = 16;  // approximate number of image files to check

// The properties that must be equal in all packages of one film.
struct Film {
  LightFieldIdentity light_field;
  std::string cameras;  // hash of the render cameras
  PackageChoices choices;

  explicit Film(const Package& package)
      : light_field(package.whole),
        cameras(HashOfCameras(package.path)),
        choices(package.choices) {}
  // Returns the first difference in words; empty if there is none.
  std::string DifferenceTo(const Film& other) const {
    if (light_field != other.light_field) return "another light field";
    if (cameras != other.cameras) return "another camera path";
    const PackageChoices &a = choices, &b = other.choices;
    if (a.order != b.order || a.seed != b.seed) return "another order of the LF images";
    if (a.max_image_count != b.max_image_count) return "another {max_images}";
    if (a.max_angle_rad != b.max_angle_rad) return "another {max_angle_deg}";
    return "";
  }
};

// Checks that the packed store has the pixels that the package needs, because the store may have
// been made for other packages. An LF image that was broken when the store was made (no bytes) is
// accepted here: it is skipped when it is loaded, like a broken file.
Result<void> CheckCodes(const fs::path& path, const Package& package) {
  const LightField& light_field = package.light_field;
  const auto codes = FindCodes(light_field.folder, light_field);
  if (!codes)
    return InputError(
        fmt::format("{}: its light field is not at {} ({}): give it with {{lightfield}}",
                    path.string(), light_field.folder.string(), codes.error().message));
  size_t needed = 0, missing = 0;
  std::string first;
  for (size_t i = 0; i < package.images.size(); ++i) {
    if (package.images[i].frame_count == 0) continue;
    ++needed;
    if ((*codes)[i].Keeps(package.images[i].rect)) continue;
    if (missing++ == 0) first = light_field.image_names[i];
  }
  if (missing == 0) return {};
  return InputError(fmt::format(
      "{}: for {} of the {} LF images that this package needs, the packed store {} lacks the image "
      "or some of its pixels; the first: {}; make the store again with lfcompressor, from all "
      "packages that are rendered",
      path.string(), missing, needed, light_field.folder.string(), first));
}

// Checks about kLookedAt image files, spread over the package. At least one of them must exist with
// its recorded size; missing or changed files beside it are allowed.
Result<void> CheckImageFiles(const fs::path& path, const Package& package) {
  std::vector<size_t> recorded;
  for (size_t i = 0; i < package.images.size(); ++i)
    if (package.images[i].file_bytes > 0) recorded.push_back(i);
  const size_t step = std::max<size_t>(1, recorded.size() / kLookedAt);
  std::optional<Error> first;
  for (size_t i = 0; i < recorded.size(); i += step) {
    const LfImageId id{static_cast<uint32_t>(recorded[i])};
    const fs::path file = ImageFileOf(package.light_field, id);
    std::error_code error;
    const uint64_t bytes = fs::file_size(file, error);
    if (!error && bytes == package.images[id.value].file_bytes) return {};
    if (first) continue;
    first =
        error ? InputError(fmt::format(
                    "{}: its LF images are not at {} ({}: {}): give their light field with "
                    "{{lightfield}}, and with {{images}} if the LF images lie elsewhere",
                    path.string(), package.light_field.folder.string(), file.string(),
                    error.message()))
              : InputError(fmt::format(
                    "{}: was made from another light field than the one at {}: {} has {} bytes, "
                    "but had {} then; give the package's light field with {{lightfield}}, and with "
                    "{{images}} if the LF images lie elsewhere, or make the package again",
                    path.string(), package.light_field.folder.string(), file.string(), bytes,
                    package.images[id.value].file_bytes));
  }
  if (first) return *first;
  return {};
}

RenderReport Joined(RenderReport all, const RenderReport& part) {
  if (all.frames.empty() && all.version.empty()) return part;
  all.frames.insert(all.frames.end(), part.frames.begin(), part.frames.end());
  all.AddSkipped(part.skipped);
  all.selected_image_count = std::max(all.selected_image_count, part.selected_image_count);
  all.selected_virtual_count = std::max(all.selected_virtual_count, part.selected_virtual_count);
  all.pass_count += part.pass_count;
  all.total_s += part.total_s;
  all.load_cpu_s += part.load_cpu_s;
  all.load_wall_s += part.load_wall_s;
  all.collect_cpu_s += part.collect_cpu_s;
  if (part.rebinning) all.AddRebinning(*part.rebinning);
  all.peak_memory_bytes = std::max(all.peak_memory_bytes, part.peak_memory_bytes);
  return all;
}

// Warns if packages of the film are missing, so that the user does not find out by watching the
// film. Does not warn for a single package, which is one task of a job.
void TellOfOthers(size_t given, size_t count) {
  if (given > 1 && given < count)
    LogWarning(
        "only {} of the film's {} packages are given; the frames of the others are not rendered",
        given, count);
}

// Checks the files that all packages write together, and the video. Render() checks the files of
// each package.
Result<void> CheckFilmOutputs(const PackagedFilm& film, const std::vector<PackagePart>& parts,
                              const RenderOptions& options) {
  std::vector<FrameId> frames;
  std::vector<std::string> names;
  for (const PackagePart& part : parts) {
    frames.insert(frames.end(), part.frames.begin(), part.frames.end());
    names.push_back(NameOfState(part.path.stem().string(), options.film.shard));
  }
  const FolderOptions& to = options.folder;
  LF_ASSIGN_OR_RETURN(const OutputFiles outputs,
                      MakeFilmOutputs(OutputsOfFilm(to.output_folder, frames, to.format, names),
                                      to.output_folder, to.video));
  return outputs.CheckReplacesNone(film.paths);
}

// Records size and modification time of the file. If the size cannot be read, file_bytes is 0, and
// OpenAgain() checks the package again.
void Stamp(PackagePart* part) {
  std::error_code error;
  part->file_bytes = fs::file_size(part->path, error);
  if (error) part->file_bytes = 0;
  part->file_time = fs::last_write_time(part->path, error);
}

void MoveTo(const std::optional<LightFieldPlace>& place, Package* package) {
  if (place) package->light_field.folder = place->folder;
}

// Reads a package again. All checks are repeated only if the file has changed since OpenPackages().
Result<Package> OpenAgain(const PackagePart& part, PackagedFilm* film) {
  PackagePart now;
  now.path = part.path;
  Stamp(&now);
  const bool is_same =
      now.file_bytes == part.file_bytes && now.file_bytes > 0 && now.file_time == part.file_time;
  if (!is_same) return OpenPackage(part.path, film->place);
  if (part.path == film->paths.front()) return std::move(film->first);
  LF_ASSIGN_OR_RETURN(Package package, ReadPackage(part.path, {.check_seal = false}));
  MoveTo(film->place, &package);
  return package;
}

}  // namespace

Result<LightFieldPlace> PlaceOf(const std::string& name, const LightField& light_field) {
  LF_RETURN_IF_ERROR(CheckNotReduced(light_field, "a package"));
  LightFieldPlace place{name, IdentityOf(light_field), std::nullopt, light_field.folder};
  if (HoldsPackedStore(light_field)) {
    LF_ASSIGN_OR_RETURN(place.whole, ReadWholeIdentity(light_field.folder));
  }
  return place;
}

Result<Package> OpenPackage(const fs::path& path, const std::optional<LightFieldPlace>& place) {
  LF_ASSIGN_OR_RETURN(Package package, ReadPackage(path));
  if (place) {
    if (place->identity != package.whole && place->whole != package.whole)
      return InputError(fmt::format(
          "{}: was made from another light field than {}: the package's light field has {} LF "
          "images and the calibration checksum {}, but this one has {} and {}; give the light "
          "field that the package was made from",
          path.string(), place->name, package.whole.image_count, package.whole.calibration,
          place->identity.image_count, place->identity.calibration));
  }
  MoveTo(place, &package);
  const auto check = HoldsPackedStore(package.light_field) ? CheckCodes : CheckImageFiles;
  LF_RETURN_IF_ERROR(check(path, package));
  LogDebug("{}: read and checked, {} frames, {} LF cameras", path.string(), package.frames.size(),
           package.light_field.size());
  return package;
}

Result<PackagedFilm> OpenPackages(std::vector<fs::path> paths,
                                  std::optional<LightFieldPlace> place) {
  PackagedFilm film{std::move(paths), std::move(place), {}, 1, {}};
  std::optional<Film> of_first;
  std::map<FrameId, fs::path> owners;
  std::map<std::string, fs::path> names;
  for (const fs::path& path : film.paths) {
    PackagePart part;
    part.path = path;
    Stamp(&part);
    LF_ASSIGN_OR_RETURN(Package package, OpenPackage(path, film.place));
    const Film other(package);
    if (!of_first) of_first = other;
    if (const std::string difference = of_first->DifferenceTo(other); !difference.empty())
      return InputError(fmt::format(
          "{}: was made for {} than {}: render these packages separately, into different "
          "folders",
          path.string(), difference, film.paths.front().string()));
    if (const auto [named, is_new] = names.emplace(package.name, path); !is_new)
      return UsageError(fmt::format(
          "{} and {} have the same name, so that the files of both in the output folder would "
          "be called {}: rename one package",
          named->second.string(), path.string(), package.name));
    for (const PackageFrame& frame : package.frames) {
      if (const auto [owner, is_new] = owners.emplace(frame.id, path); !is_new)
        return UsageError(fmt::format("{} and {} both contain frame {}: give only one of them",
                                      owner->second.string(), path.string(), frame.id.value));
      part.frames.push_back(frame.id);
      part.ray_count += frame.ray_count;
    }
    part.image_count = static_cast<size_t>(
        std::count_if(package.images.begin(), package.images.end(),
                      [](const PackageImage& image) { return image.frame_count > 0; }));
    if (film.parts.empty()) {
      film.film_count = package.count;
      film.first = std::move(package);
    }
    film.parts.push_back(std::move(part));
  }
  return film;
}

Result<std::vector<PackagePart>> PartsWith(const PackagedFilm& film,
                                           const std::vector<FrameId>& wanted) {
  std::vector<PackagePart> parts;
  size_t found_count = 0;
  for (const PackagePart& whole : film.parts) {
    PackagePart part = whole;
    if (!wanted.empty())
      std::erase_if(part.frames, [&](FrameId frame) {
        return !std::binary_search(wanted.begin(), wanted.end(), frame);
      });
    part.is_whole = part.frames.size() == whole.frames.size();
    part.ray_count =
        whole.ray_count * part.frames.size() / std::max<size_t>(1, whole.frames.size());
    found_count += part.frames.size();
    if (!part.frames.empty()) parts.push_back(std::move(part));
  }
  if (!wanted.empty() && found_count < wanted.size())
    for (const FrameId frame : wanted)
      if (std::none_of(parts.begin(), parts.end(), [frame](const PackagePart& part) {
            return std::binary_search(part.frames.begin(), part.frames.end(), frame);
          }))
        return UsageError(fmt::format(
            "{{frames}}: frame {} is not in any of the given packages: also give its package, or "
            "leave the frame out",
            frame.value));
  TellOfOthers(film.paths.size(), film.film_count);
  return parts;
}

// A single package gets a contact sheet with its own name, because other packages are likely to be
// rendered into the same folder.
std::string ContactSheetName(const std::vector<fs::path>& paths) {
  return paths.size() == 1 ? fmt::format("contact_sheet-{}.png", paths.front().stem().string())
                           : kContactSheet;
}

Result<RenderReport> RenderPackages(PackagedFilm film, const RenderOptions& options,
                                    ThreadPool& pool,
                                    const std::function<void(const RenderProgress&)>& progress) {
  LF_ASSIGN_OR_RETURN(const std::vector<PackagePart> parts, PartsWith(film, options.frames));
  LF_RETURN_IF_ERROR(CheckFilmOutputs(film, parts, options));
  if (options.folder.video) {
    LF_RETURN_IF_ERROR(CheckVideoTool());
    LF_RETURN_IF_ERROR(CheckVideoTarget(*options.folder.video));
  }
  RenderProgress before;  // progress of the packages that are done
  uint64_t rays_after = 0;
  size_t images_after = 0;
  for (const PackagePart& part : parts) {
    before.frame_total += part.frames.size();
    rays_after += part.ray_count;
    images_after += part.image_count;
  }
  std::vector<FrameId> frames;
  RenderReport report;
  CameraPath path;  // camera path of the film, the same in all packages
  for (const PackagePart& part : parts) {
    LF_ASSIGN_OR_RETURN(Package package, OpenAgain(part, &film));
    RenderOptions of_part = options;
    of_part.frames = part.frames;
    of_part.folder.contact_sheet = false;
    of_part.folder.video.reset();
    const std::string name = package.name;
    path = package.path;
    rays_after -= part.ray_count;
    images_after -= part.image_count;
    RenderProgress now;
    LF_ASSIGN_OR_RETURN(
        const RenderReport done,
        Render(std::move(package), of_part, pool, [&](const RenderProgress& of_package) {
          now = of_package;
          now.frame_count += before.frame_count;
          now.frame_total = before.frame_total;
          now.ray_count += before.ray_count;
          now.ray_total += before.ray_count + rays_after;
          now.image_count += before.image_count;
          now.image_total += before.image_count + images_after;
          if (progress) progress(now);
        }));
    before.frame_count += part.frames.size();
    before.ray_count = now.ray_count;
    before.image_count = now.image_count;
    report = Joined(std::move(report), done);
    report.packages.push_back(
        {name, done.selected_image_count, done.skipped.size(), done.selected_virtual_count});
    frames.insert(frames.end(), part.frames.begin(), part.frames.end());
  }
  std::sort(frames.begin(), frames.end());
  std::sort(report.frames.begin(), report.frames.end(),
            [](const FrameReport& a, const FrameReport& b) { return a.frame < b.frame; });
  const FilmFiles files = FilesOfFilm(path, options);
  if (options.folder.contact_sheet && !options.film.shard)
    LF_RETURN_IF_ERROR(files.WriteContactSheet(frames, static_cast<size_t>(pool.thread_count()),
                                               pool, ContactSheetName(film.paths)));
  if (options.folder.video) LF_RETURN_IF_ERROR(files.WriteVideo(frames, *options.folder.video));
  // Black frames are an error only if all packages are given: a missing package may have rays.
  if (report.IsBlack() && !options.film.shard && film.paths.size() == film.film_count)
    return InputError(fmt::format(
        "{}: all frames are black, because no LF image has a ray for them: check in lfvisualizer "
        "that the camera path is within the capture, and check the masks of the LF images",
        options.folder.output_folder.string()));
  return report;
}

}  // namespace lf
