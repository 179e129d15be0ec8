// SPDX-License-Identifier: Apache-2.0
// Everything that the page may ask about: the light field, the path and its drafts, packages, and
// the render that is watched.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "tools/visualizer/event_board.h"

#include "lf/camera/path/evaluate_path.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"
#include "lf/selection/image_index.h"
#include "lf/storage/load/lf_image_store.h"
#include "lf/view/depth_points.h"
#include "lf/view/film_use.h"
#include "lf/view/frame_use.h"

namespace lf {

// The command line of lfvisualizer.
struct PageArguments {
  std::string light_field;                       // LIGHTFIELD as it was given
  std::vector<std::string> light_field_options;  // words, such as --fov-deg 60
  std::filesystem::path path;  // PATH; if it is not YAML, the scene replaces it by PATH.yaml
  std::vector<std::string> packages;
  std::vector<std::string> depths;  // depth maps and point clouds (lf/view/depth_points.h)
  std::filesystem::path watch;      // folder of the watched render; empty if none is watched
  FilmSettings film;                // of the frames that the page shows and renders
  NeedsOptions needs;               // what these frames need
  int threads = 0;
  size_t live_memory_bytes = size_t{512} << 20;  // LiveOptions::memory_bytes
  // Once it is true, PageScene::Open() ends with kInterrupted. May be null.
  const std::atomic<bool>* interrupted = nullptr;
};

// A path while it is edited: its text, checked by the parser of the programs.
struct PathDraft {
  std::string id;  // hash of the text: IdOfText(text)
  std::string text;
  std::shared_ptr<const PathFrames> path;  // PathFrames::Check() has found no error in it
  bool is_of_packages = false;    // true if packages are shown that have the cameras of this path
  std::shared_ptr<FilmUse> film;  // null before FilmOf(), and after newer films have stopped it
  uint64_t film_number = 0;       // number of the film in the order in which films were started
};

// A depth map or a point cloud that the page shows.
struct DepthFile {
  std::string name;  // as it was given
  DepthPoints points;
};
// The largest number of depth files of a page.
inline constexpr size_t kMostDepthFiles = 8;

class PageScene {
 public:
  // kInput: the path, a package or a packed store cannot be read; a package was made from a light
  // field with another number of LF images; a depth file is refused. kUsage: a depth file has
  // another extension, or there are more than kMostDepthFiles. If a package was made for another
  // path, all packages are ignored, with a warning (packages_note()).
  static Result<std::unique_ptr<PageScene>> Open(LightField light_field, PageArguments arguments);

  const PageArguments& arguments() const { return arguments_; }
  const LightField& light_field() const { return light_field_; }
  const LfImageStore& store() const { return *store_; }
  const ImageIndex& index() const { return index_; }
  ThreadPool& pool() { return pool_; }
  EventBoard& events() { return events_; }
  const std::vector<std::unique_ptr<Package>>& packages() const { return packages_; }
  // Returns why the packages are ignored; "" if they are not.
  const std::string& packages_note() const { return packages_note_; }
  const std::vector<DepthFile>& depths() const { return depths_; }

  // Returns the path in the file as it was when lfvisualizer started.
  std::shared_ptr<PathDraft> first_draft() const { return first_draft_; }
  // Parses a draft, checks all its frames, and keeps it. kInput: the error that the programs would
  // report. kInterrupted: the program ends (PageArguments::interrupted, or a closed event board).
  Result<std::shared_ptr<PathDraft>> AddDraft(const std::string& text);
  // Returns the path of a text that need not be a draft. Its frames are not checked: each may have
  // an error when it is asked for. A text is not parsed again if it is a draft, or if the last call
  // had it. kInput as for ParsePathFrames().
  Result<std::shared_ptr<const PathFrames>> FramesOf(const std::string& text);
  // Returns a draft, or nullptr if it is unknown. The scene keeps only the first draft and the few
  // drafts that were used last.
  std::shared_ptr<PathDraft> FindDraft(const std::string& id);

  // Returns which LF images a frame uses, as decided by its package if the draft has the cameras of
  // that package.
  FrameUse UseOf(const PathDraft& draft, FrameId frame);
  // Returns the draft's FilmUse, which examines all frames of the draft in the background. Starts
  // it if it does not exist. Only the three that were started last continue; older ones are
  // stopped.
  std::shared_ptr<FilmUse> FilmOf(PathDraft& draft);

  // Returns the current content of PATH.yaml. kInput while the file that Save writes does not
  // exist, because PATH has another form.
  Result<std::string> TextOnDisk() const;

 private:
  PageScene(LightField light_field, PageArguments arguments);
  Result<void> OpenFirstDraft();
  Result<void> OpenPackages();
  Result<void> OpenDepths();
  Result<PathFrames> Parse(const std::string& text) const;
  bool HasCamerasOfPackages(const PathFrames& path) const;
  std::shared_ptr<PathDraft> KeepDraft(const std::string& text, PathFrames path);

  PageArguments arguments_;
  LightField light_field_;
  ThreadPool pool_;
  ImageIndex index_;
  std::unique_ptr<LfImageStore> store_;
  std::vector<std::unique_ptr<Package>> packages_;
  std::vector<std::unique_ptr<ImageIndex>> package_indices_;
  std::string packages_note_;
  std::string packages_hash_;  // hash of the cameras of the packages' path
  std::vector<DepthFile> depths_;
  EventBoard events_;
  std::mutex mutex_;  // guards the members below
  uint64_t films_begun_ = 0;
  std::shared_ptr<PathDraft> first_draft_;
  std::list<std::shared_ptr<PathDraft>> drafts_;   // the most recently used one first
  std::string last_id_;                            // IdOfText() of last_frames_
  std::shared_ptr<const PathFrames> last_frames_;  // the path that FramesOf() parsed last
};

// Returns a hash of the text: 16 hexadecimal digits.
std::string IdOfText(std::string_view text);

}  // namespace lf
