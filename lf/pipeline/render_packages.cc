#include "lf/pipeline/render_packages.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "lf/core/log.h"
#include "lf/package/package_file.h"
#include "lf/packed/packed_store_file.h"
#include "lf/pipeline/frame_output.h"
#include "lf/record/run_inputs.h"
#include "lf/sequence/video.h"

namespace lf {
namespace fs = std::filesystem;
namespace {

constexpr size_t kLookedAt = 16;  // image files, spread over the package

// What all packages of one film have in common.
struct Film {
  LightFieldIdentity light_field;
  std::string cameras;  // their hash
  PackageChoices choices;

  explicit Film(const Package& package)
      : light_field(package.whole),
        cameras(HashOfCameras(package.path)),
        choices(package.choices) {}
  // What differs; empty if nothing does.
  std::string DifferenceTo(const Film& other) const {
    if (light_field != other.light_field) return "another light field";
    if (cameras != other.cameras) return "another camera path";
    const PackageChoices &a = choices, &b = other.choices;
    if (a.order != b.order || a.seed != b.seed) return "another order of the LF images";
    if (a.max_image_count != b.max_image_count) return "another --max-images";
    if (a.max_angle_rad != b.max_angle_rad) return "another --max-angle";
    return "";
  }
};

// The packed store may be of other packages. What it could not read itself is skipped when it is
// loaded, as a broken file is.
Result<void> CheckCodes(const fs::path& path, const Package& package) {
  const LightField& light_field = package.light_field;
  const auto codes = FindCodes(light_field.folder, light_field.image_names);
  if (!codes)
    return InputError(
        fmt::format("{}: its LF images are not at {} ({}): --lightfield says where they are",
                    path.string(), light_field.folder.string(), codes.error().message));
  size_t needed = 0, missing = 0;
  std::string first;
  for (size_t i = 0; i < package.images.size(); ++i) {
    if (package.images[i].frame_count == 0) continue;
    ++needed;
    const PixelRect& rect = package.images[i].rect;
    const PackedCode& code = (*codes)[i];
    if (code.is_listed() && (code.bytes == 0 || Intersection(code.rect, rect) == rect)) continue;
    if (missing++ == 0) first = light_field.image_names[i];
  }
  if (missing == 0) return {};
  return InputError(
      fmt::format("{}: {} of its {} LF images are not in the packed store {}, or not all of their "
                  "pixels, the first: {}; compress this package, too",
                  path.string(), missing, needed, light_field.folder.string(), first));
}

// A broken file or two may be; but not all of them are.
Result<void> CheckImageFiles(const fs::path& path, const Package& package) {
  std::vector<size_t> recorded;
  for (size_t i = 0; i < package.images.size(); ++i)
    if (package.images[i].file_bytes > 0) recorded.push_back(i);
  const size_t step = std::max<size_t>(1, recorded.size() / kLookedAt);
  std::optional<Error> first;
  for (size_t i = 0; i < recorded.size(); i += step) {
    const LfImageId id{static_cast<uint32_t>(recorded[i])};
    const fs::path file = package.light_field.ImagePath(id);
    std::error_code error;
    const uint64_t bytes = fs::file_size(file, error);
    if (!error && bytes == package.images[id.value].file_bytes) return {};
    if (first) continue;
    first = error
                ? InputError(fmt::format(
                      "{}: its LF images are not at {} ({}: {}): --lightfield says where they are",
                      path.string(), package.light_field.folder.string(), file.string(),
                      error.message()))
                : InputError(fmt::format(
                      "{}: was made from another light field than is at {}: {} has {} bytes, and "
                      "had {}; make the package again, or say with --lightfield where its own is",
                      path.string(), package.light_field.folder.string(), file.string(), bytes,
                      package.images[id.value].file_bytes));
  }
  if (first) return *first;
  return {};
}

RenderReport Joined(RenderReport all, const RenderReport& part) {
  if (all.frames.empty() && all.version.empty()) return part;
  all.frames.insert(all.frames.end(), part.frames.begin(), part.frames.end());
  for (const SkippedImage& skipped : part.skipped)
    if (std::none_of(all.skipped.begin(), all.skipped.end(),
                     [&](const SkippedImage& known) { return known.name == skipped.name; }))
      all.skipped.push_back(skipped);
  all.selected_image_count = std::max(all.selected_image_count, part.selected_image_count);
  all.pass_count += part.pass_count;
  all.total_s += part.total_s;
  all.load_cpu_s += part.load_cpu_s;
  all.load_wall_s += part.load_wall_s;
  all.collect_cpu_s += part.collect_cpu_s;
  all.peak_memory_bytes = std::max(all.peak_memory_bytes, part.peak_memory_bytes);
  return all;
}

// Frames that are missing from a film should not be found out by watching it. One package alone is
// a job of many.
void TellOfOthers(size_t given, size_t count) {
  if (given > 1 && given < count)
    LogWarning("{} of the film's {} packages are given: the frames of the others are not rendered",
               given, count);
}

}  // namespace

Result<LightFieldPlace> PlaceOf(const std::string& name, const LightField& light_field) {
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
          "{}: was made from another light field than {}: {} LF images of calibration {}, there "
          "are "
          "{} of {}",
          path.string(), place->name, package.whole.image_count, package.whole.calibration,
          place->identity.image_count, place->identity.calibration));
    package.light_field.folder = place->folder;
  }
  const auto check = HoldsPackedStore(package.light_field) ? CheckCodes : CheckImageFiles;
  LF_RETURN_IF_ERROR(check(path, package));
  return package;
}

Result<std::vector<PackagePart>> LookAtPackages(const std::vector<fs::path>& paths,
                                                const std::optional<LightFieldPlace>& place,
                                                const std::vector<FrameId>& wanted) {
  std::vector<PackagePart> parts;
  std::optional<Film> film;
  std::map<FrameId, fs::path> owners;
  std::map<std::string, fs::path> names;
  for (const fs::path& path : paths) {
    LF_ASSIGN_OR_RETURN(const Package package, OpenPackage(path, place));
    const Film other(package);
    if (!film) film = other;
    if (const std::string difference = film->DifferenceTo(other); !difference.empty())
      return InputError(fmt::format("{}: is of {} than {}: render them into folders of their own",
                                    path.string(), difference, paths.front().string()));
    if (const auto [named, is_new] = names.emplace(package.name, path); !is_new)
      return UsageError(
          fmt::format("{} and {} have one name: reports and states of both would be "
                      "called {}",
                      named->second.string(), path.string(), package.name));
    PackagePart part{path, {}, true, 0, package.count};
    for (const PackageFrame& frame : package.frames) {
      if (const auto [owner, is_new] = owners.emplace(frame.id, path); !is_new)
        return UsageError(fmt::format("{} and {} both have frame {}: give one of them",
                                      owner->second.string(), path.string(), frame.id.value));
      if (!wanted.empty() && !std::binary_search(wanted.begin(), wanted.end(), frame.id)) {
        part.is_whole = false;
        continue;
      }
      part.frames.push_back(frame.id);
      part.ray_count += frame.ray_count;
    }
    if (!part.frames.empty()) parts.push_back(std::move(part));
  }
  for (const FrameId frame : wanted)
    if (!owners.contains(frame))
      return UsageError(fmt::format("--frames: frame {} is in none of the packages", frame.value));
  TellOfOthers(paths.size(), parts.front().film_count);
  return parts;
}

// One package alone is likely to be rendered beside others.
std::string ContactSheetName(const std::vector<fs::path>& paths) {
  return paths.size() == 1 ? fmt::format("contact_sheet-{}.png", paths.front().stem().string())
                           : kContactSheet;
}

Result<RenderReport> RenderPackages(const std::vector<fs::path>& paths,
                                    const std::optional<LightFieldPlace>& place,
                                    const RenderOptions& options, ThreadPool& pool,
                                    const std::function<void(const RenderProgress&)>& progress) {
  LF_ASSIGN_OR_RETURN(const std::vector<PackagePart> parts,
                      LookAtPackages(paths, place, options.frames));
  if (options.video) {
    LF_RETURN_IF_ERROR(CheckVideoTool());
    LF_RETURN_IF_ERROR(CheckVideoTarget(*options.video));
  }
  RenderProgress before;  // of packages that are done
  uint64_t rays_after = 0;
  for (const PackagePart& part : parts) {
    before.frame_total += part.frames.size();
    rays_after += part.ray_count;
  }
  std::vector<FrameId> frames;
  RenderReport report;
  std::optional<Package> last;
  for (const PackagePart& part : parts) {
    LF_ASSIGN_OR_RETURN(Package package, OpenPackage(part.path, place));
    if (options.reading.estimator == Estimator::kBilinear)
      MakeRoomForUndershoot(&package.light_field.encoding);
    RenderOptions of_part = options;
    of_part.frames = part.frames;
    of_part.contact_sheet = false;
    of_part.video.reset();
    if (!of_part.max_image_count) of_part.max_image_count = package.choices.max_image_count;
    rays_after -= part.ray_count;
    RenderProgress now;
    LF_ASSIGN_OR_RETURN(const RenderReport done,
                        Render(package, of_part, pool, [&](const RenderProgress& of_package) {
                          now = of_package;
                          now.frame_count += before.frame_count;
                          now.frame_total = before.frame_total;
                          now.ray_count += before.ray_count;
                          now.ray_total += before.ray_count + rays_after;
                          if (progress) progress(now);
                        }));
    before.frame_count += part.frames.size();
    before.ray_count = now.ray_count;
    report = Joined(std::move(report), done);
    frames.insert(frames.end(), part.frames.begin(), part.frames.end());
    last = std::move(package);
  }
  std::sort(frames.begin(), frames.end());
  std::sort(report.frames.begin(), report.frames.end(),
            [](const FrameReport& a, const FrameReport& b) { return a.frame < b.frame; });
  const FilmFiles film = FilesOfFilm(last->path, options);
  if (options.contact_sheet && !options.shard)
    LF_RETURN_IF_ERROR(film.WriteContactSheet(frames, static_cast<size_t>(pool.thread_count()),
                                              pool, ContactSheetName(paths)));
  if (options.video) LF_RETURN_IF_ERROR(film.WriteVideo(frames, *options.video));
  // A section may be black.
  if (report.AcceptedRays() == 0 && !options.shard && paths.size() == parts.front().film_count)
    return InputError(fmt::format("{}: every frame is black: no ray reached them",
                                  options.output_folder.string()));
  return report;
}

}  // namespace lf
