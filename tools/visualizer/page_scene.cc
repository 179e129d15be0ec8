// SPDX-License-Identifier: Apache-2.0
#include "tools/visualizer/page_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lf/camera/path/path_yaml.h"
#include "lf/camera/path/path_yaml_write.h"
#include "lf/core/file.h"
#include "lf/core/hash.h"
#include "lf/core/log.h"
#include "lf/import/paths/open_path.h"
#include "lf/import/paths/transmission_file.h"
#include "lf/render/package/package_file.h"
#include "lf/render/state/run_inputs.h"
#include "lf/storage/load/open_store.h"
#include "lf/view/scene_bytes.h"

namespace lf {
namespace {

constexpr size_t kMostDrafts = 8;
constexpr uint64_t kMostFilms = 3;
// Memory for reference images of predicted LF images. Who looks around asks for neighbours, so that
// those of a few dozen groups suffice.
constexpr uint64_t kReferenceBytes = uint64_t{256} << 20;

}  // namespace

std::string IdOfText(std::string_view text) { return fmt::format("{:016x}", HashBytes(text)); }

PageScene::PageScene(LightField light_field, PageArguments arguments)
    : arguments_(std::move(arguments)),
      light_field_(std::move(light_field)),
      pool_(arguments_.threads),
      index_(light_field_, RanksOf(arguments_.film.order, light_field_, arguments_.film.seed)) {}

Result<std::unique_ptr<PageScene>> PageScene::Open(LightField light_field,
                                                   PageArguments arguments) {
  std::unique_ptr<PageScene> scene(new PageScene(std::move(light_field), std::move(arguments)));
  LF_ASSIGN_OR_RETURN(scene->store_, OpenStore(scene->light_field_, Mosaics::kToRgb));
  scene->store_->LimitReferences(kReferenceBytes);
  LF_RETURN_IF_ERROR(scene->OpenFirstDraft());
  LF_RETURN_IF_ERROR(scene->OpenPackages());
  LF_RETURN_IF_ERROR(scene->OpenDepths());
  return scene;
}

// The page edits YAML. A path of another form is converted, and saved beside it.
Result<void> PageScene::OpenFirstDraft() {
  std::filesystem::path& path = arguments_.path;
  LF_ASSIGN_OR_RETURN(const bool is_yaml, IsPathYaml(path));
  if (is_yaml) {
    LF_ASSIGN_OR_RETURN(const std::string text, ReadFile(path));
    LF_ASSIGN_OR_RETURN(first_draft_, AddDraft(text));
    if (first_draft_->path->has_focal_surface())
      LogWarning(
          "{}: focus.surface: the page, its live picture and exports show frames that are in focus "
          "on the plane at lens.focus_distance; a preview (P), and lfrenderer, focus on the "
          "surface",
          path.string());
    return {};
  }
  LF_ASSIGN_OR_RETURN(CameraPath opened, OpenPath(path, PathOptionsFor(light_field_)));
  LF_ASSIGN_OR_RETURN(const PathYaml yaml, PathYamlOf(opened));
  for (const std::string& lost : yaml.lost)
    LogWarning("{}: the page, which edits YAML, does not show {}", path.string(), lost);
  path = path.lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  path += ".yaml";
  std::error_code error;
  if (std::filesystem::exists(path, error))
    return UsageError(
        fmt::format("{}: exists, but the page would save the converted path there: give this file "
                    "as PATH, or remove it",
                    path.string()));
  LogInfo("the path is converted to YAML; the page saves it as {}", path.string());
  first_draft_ = KeepDraft(yaml.text, PathFrames(std::move(opened)));
  return {};
}

Result<void> PageScene::OpenPackages() {
  for (const std::string& name : arguments_.packages) {
    LF_ASSIGN_OR_RETURN(Package read, ReadPackage(name));
    if (read.whole.image_count != light_field_.size())
      return InputError(fmt::format(
          "{}: was made from a light field of {} LF images, but {} has {}: give the light field "
          "of the package",
          name, read.whole.image_count, arguments_.light_field, light_field_.size()));
    packages_hash_ = HashOfCameras(read.path);
    first_draft_->is_of_packages = HasCamerasOfPackages(*first_draft_->path);
    if (!first_draft_->is_of_packages) {
      packages_note_ = fmt::format(
          "{} was made for another path than {}: packages are ignored. Make new ones with "
          "lfpreprocessor.",
          read.name, arguments_.path.string());
      LogWarning("{}", packages_note_);
      packages_.clear();
      package_indices_.clear();
      return {};
    }
    auto package = std::make_unique<Package>(std::move(read));
    package_indices_.push_back(std::make_unique<ImageIndex>(package->light_field, package->ranks));
    packages_.push_back(std::move(package));
  }
  return {};
}

Result<void> PageScene::OpenDepths() {
  if (arguments_.depths.size() > kMostDepthFiles)
    return UsageError(fmt::format("--depth is given {} times: expected at most {} files",
                                  arguments_.depths.size(), kMostDepthFiles));
  for (const std::string& name : arguments_.depths) {
    LF_ASSIGN_OR_RETURN(DepthPoints points,
                        ReadDepthPoints(name, SceneOrigin(light_field_), light_field_.unit_m));
    if (points.places.size() < points.count_in_file)
      LogInfo("{}: the page shows {} of its {} points: one of each {}, chosen at random", name,
              points.places.size(), points.count_in_file,
              (points.count_in_file + kMostDepthPoints - 1) / kMostDepthPoints);
    depths_.push_back({name, std::move(points)});
  }
  return {};
}

Result<PathFrames> PageScene::Parse(const std::string& text) const {
  return ParsePathFrames(text, arguments_.path.filename().string(), light_field_.unit_m,
                         PicturesBeside(arguments_.path));
}

Result<std::shared_ptr<PathDraft>> PageScene::AddDraft(const std::string& text) {
  const std::string id = IdOfText(text);
  if (std::shared_ptr<PathDraft> known = FindDraft(id)) return known;
  LF_ASSIGN_OR_RETURN(PathFrames path, Parse(text));
  const std::atomic<bool>* const interrupted = arguments_.interrupted;
  LF_RETURN_IF_ERROR(
      path.Check([&] { return events_.is_closed() || (interrupted != nullptr && *interrupted); }));
  return KeepDraft(text, std::move(path));
}

Result<std::shared_ptr<const PathFrames>> PageScene::FramesOf(const std::string& text) {
  const std::string id = IdOfText(text);
  if (const std::shared_ptr<PathDraft> known = FindDraft(id)) return known->path;
  {
    const std::lock_guard lock(mutex_);
    if (last_frames_ && last_id_ == id) return last_frames_;
  }
  LF_ASSIGN_OR_RETURN(PathFrames path, Parse(text));
  auto frames = std::make_shared<const PathFrames>(std::move(path));
  const std::lock_guard lock(mutex_);
  last_id_ = id;
  last_frames_ = frames;
  return frames;
}

// True if the path has the packages' cameras. Computes all cameras of the path: they take no more
// memory than the packages.
bool PageScene::HasCamerasOfPackages(const PathFrames& path) const {
  return !packages_hash_.empty() && HashOfCameras(*EvaluatePath(path)) == packages_hash_;
}

std::shared_ptr<PathDraft> PageScene::KeepDraft(const std::string& text, PathFrames path) {
  auto draft = std::make_shared<PathDraft>();
  draft->id = IdOfText(text);
  draft->text = text;
  draft->is_of_packages = HasCamerasOfPackages(path);
  draft->path = std::make_shared<const PathFrames>(std::move(path));
  std::list<std::shared_ptr<PathDraft>> forgotten;  // their threads end after the lock is released
  const std::lock_guard lock(mutex_);
  drafts_.push_front(draft);
  while (drafts_.size() > kMostDrafts)
    forgotten.splice(forgotten.end(), drafts_, std::prev(drafts_.end()));
  return draft;
}

std::shared_ptr<PathDraft> PageScene::FindDraft(const std::string& id) {
  if (first_draft_ && first_draft_->id == id) return first_draft_;
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(drafts_.begin(), drafts_.end(),
                                  [&](const auto& draft) { return draft->id == id; });
  if (found == drafts_.end()) return nullptr;
  drafts_.splice(drafts_.begin(), drafts_, found);
  return drafts_.front();
}

FrameUse PageScene::UseOf(const PathDraft& draft, FrameId frame) {
  const RenderCamera camera = *draft.path->Camera(frame);
  FrameUse use = UseOfCameras(index_, camera, arguments_.needs, pool_);
  if (!draft.is_of_packages) return use;
  for (size_t i = 0; i < packages_.size(); ++i) {
    const Package& package = *packages_[i];
    const auto found =
        std::lower_bound(package.frames.begin(), package.frames.end(), frame,
                         [](const PackageFrame& one, FrameId wanted) { return one.id < wanted; });
    if (found == package.frames.end() || found->id != frame) continue;
    NeedsOptions options = arguments_.needs;
    options.max_image_count = package.choices.max_image_count;
    options.select.max_angle_rad = package.choices.max_angle_rad;
    FrameNeeds needs =
        NeedsOf(*package_indices_[i], camera, options, pool_, SamplingOf(package, frame));
    for (CameraUse& one : use.of_cameras)
      if (one == CameraUse::kUsed) one = CameraUse::kLimit;
    for (FrameNeeds::Image& image : needs.images) {
      image.id = LfImageId{package.images[image.id.value].id};
      use.of_cameras[image.id.value] = CameraUse::kUsed;
    }
    use.used = std::move(needs.images);
  }
  return use;
}

std::shared_ptr<FilmUse> PageScene::FilmOf(PathDraft& draft) {
  std::vector<std::shared_ptr<FilmUse>> left;  // their threads end after the lock is released
  const std::lock_guard lock(mutex_);
  if (draft.film) return draft.film;
  draft.film_number = ++films_begun_;
  for (const auto& other : drafts_)
    if (other->film && other->film_number + kMostFilms <= films_begun_)
      left.push_back(std::exchange(other->film, nullptr));
  draft.film = std::make_shared<FilmUse>(
      index_, draft.path, arguments_.needs, pool_,
      [this, id = draft.id] { events_.Post("film", "{\"path\":\"" + id + "\"}"); });
  return draft.film;
}

Result<std::string> PageScene::TextOnDisk() const { return ReadFile(arguments_.path); }

}  // namespace lf
