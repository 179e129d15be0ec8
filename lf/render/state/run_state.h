// SPDX-License-Identifier: Apache-2.0
// The state of an unfinished render. It is in DIR/partial/ if DIR is the output folder, or in
// DIR/partial/NAME/ for a package NAME. A render can be interrupted at any moment and resumes from
// its state (doc/checkpoints.md).
//
//   lock              locked by the process that renders
//   run.json          times so far and skipped LF images
//   rays_0001_1.rays  rebinned rays of section 1 of the pass whose first frame is 1
//   kept_0001.pixels  kept LF pixels of the pass whose first frame is 1
//   frame_0001.plate  the plate of an unfinished frame, its inputs and its progress
//   frame_0001.exr    a picture of the unfinished frame, about as recent as its plate
//   frame_0002.json   the report and the inputs of a finished frame
//
// The state of a shard (shard.h) is in DIR/partial/shard_1_of_5/, or in
// DIR/partial/NAME.shard_1_of_5/ for a package NAME. The finished frames of a shard are plates,
// DIR/partial/shards/shard_1_of_5/frame_0001.plate.
#pragma once

#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/file_lock.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/film/develop/frame_file.h"
#include "lf/film/plate/plate_file.h"
#include "lf/film/plate/sensor_plate.h"
#include "lf/rebinning/kept_pixels.h"
#include "lf/rebinning/ray_map.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/noise_moments.h"
#include "lf/render/settings/shard.h"
#include "lf/render/state/report.h"
#include "lf/render/state/run_inputs.h"

namespace lf {

struct RunStateOptions {
  std::filesystem::path folder;  // DIR, the output folder
  std::string package;           // name of the package; empty unless packages may share DIR
  std::vector<FrameId> frames;   // all frames of the package, ascending
  FrameFormat format = FrameFormat::kExrHalf;
  bool resume = false;     // true: continues from the state in the folder
  bool overwrite = false;  // true: removes the state in the folder
  RunInputs rays;          // result of InputsOfRays(), and what only rebinned rays depend on
  RunInputs picture;       // result of InputsOfPicture(), and kFilmOfPackage if there is a package
  std::optional<Shard> shard = std::nullopt;
  std::vector<FrameId> written = {};  // frames that the render writes, ascending; empty: all
};

// Returns the name of the state's folder below DIR/partial/, which also is in the name of the
// report; empty if the render has neither a package name nor a shard.
std::string NameOfState(const std::string& package, const std::optional<Shard>& shard);

class RunState {
 public:
  // Makes the folder, locks it and, with options.resume, reads the state in it. The camera path
  // must outlive the object.
  // kUsage: the folder has an unfinished render, and neither resume nor overwrite is set; the state
  // was made from other inputs (the message names the first input that differs, and both values);
  // packages or shards that are in the folder were rendered from other inputs; or frames of another
  // film would stay in the folder (other_films.h), and overwrite is not set: it makes a warning of
  // this error.
  // kInput: a file of the state is damaged.
  // kOutput: the folder cannot be written, or another process renders into it.
  static Result<std::unique_ptr<RunState>> Open(const RunStateOptions& options,
                                                const CameraPath& path);
  ~RunState();  // removes the folder of the state if it is empty

  // Reports of the frames that are finished and whose files exist.
  const std::map<FrameId, FrameReport>& finished() const { return finished_; }
  // Totals of earlier runs, such as times and skipped LF images; without frames.
  const RenderReport& earlier() const { return earlier_; }
  // True if the state has plates of unfinished frames, rebinned rays or kept pixels.
  bool HasPlates() const { return !plates_.empty() || has_rays_; }
  bool HasPlate(FrameId frame) const { return plates_.contains(frame); }

  // Returns the path of the file of a finished frame: its picture or, for a shard, its plate.
  std::filesystem::path FinishedPath(FrameId frame) const;

  // True if the plate beside the file of a finished frame (FolderOptions::keep_plates) has the rays
  // of this run's inputs: an earlier render of the folder may have left another one.
  bool HasPlateBeside(FrameId frame) const;

  // Adds the rays of the frame's plate in the state to `plate`, and returns the frame's progress.
  // If the state has no plate of the frame, adds nothing and returns zeros.
  //   plate    empty, of the frame's size
  //   moments  receives the moments that were saved with the plate, if any; null: they are not
  //            needed
  // kInput: the plate is damaged.
  Result<FrameProgress> LoadPlate(FrameId frame, SensorPlate* plate,
                                  std::optional<NoiseMoments>* moments = nullptr) const;
  // Writes the frame's plate and its moments (unless null) into one file, so that both always have
  // the same LF images. Several threads may call this at the same time, for different frames.
  // kOutput: the file cannot be written; the previous file is intact.
  Result<void> SavePlate(FrameId frame, const FrameProgress& progress, const SensorPlate& plate,
                         ThreadPool& pool, const NoiseMoments* moments = nullptr);
  // LoadRays() and SaveRays() read and write the rebinned rays of one section of a pass. `first` is
  // the first frame of the pass. `frames` describes all frames of the pass, because the rays depend
  // on them in addition to the inputs. LoadRays() returns nullopt if the state has no such rays, or
  // if RunStateOptions::resume is false.
  // kUsage: the rays were made for other frames or from other inputs. kInput: the file is damaged,
  // or has more than max_cells cells.
  struct Rays {
    RayMap map;
    uint32_t ranks_done = 0;
  };
  Result<std::optional<Rays>> LoadRays(FrameId first, size_t section, const std::string& frames,
                                       size_t max_cells, ThreadPool& pool) const;
  Result<void> SaveRays(FrameId first, size_t section, const std::string& frames, const RayMap& map,
                        uint32_t ranks_done, ThreadPool& pool);
  // LoadKept() and SaveKept() read and write the kept pixels of a pass. Parameters and errors are
  // those of LoadRays() and SaveRays(), for a file with more than max_pixels pixels.
  struct Kept {
    KeptPixels pixels;
    uint32_t ranks_done = 0;
  };
  Result<std::optional<Kept>> LoadKept(FrameId first, const std::string& frames, size_t max_pixels,
                                       ThreadPool& pool) const;
  Result<void> SaveKept(FrameId first, const std::string& frames, const KeptPixels& pixels,
                        uint32_t ranks_done, ThreadPool& pool);
  // kUsage: the run was begun in a mode that keeps rays, and is resumed in one that does not.
  Result<void> CheckNoRays() const;
  void RemoveRays();  // removes the rebinned rays and the kept pixels of all passes

  Result<void> SaveTotals(const RenderReport& totals);
  // Records that a frame is finished, and removes its plate and picture from the state. Must be
  // called only after the file FinishedPath() is written.
  Result<void> SaveFinished(const FrameReport& frame);
  // Forgets that a frame is finished, so that it can be rendered again. Removes no file.
  void Forget(FrameId frame) { finished_.erase(frame); }

  // Returns the entries of the file of a plate, in the state or beside the frames: inputs, progress
  // and moments.
  //   moments  null: the entries contain no moments
  PlateEntries PlateText(FrameId frame, const FrameProgress& progress,
                         const NoiseMoments* moments = nullptr) const;
  std::filesystem::path PicturePath(FrameId frame) const;

  // Returns the error of an interrupted run of these frames, kInterrupted: how many are finished,
  // and which of finished frames and state there are to be resumed.
  Error Interruption(std::span<const FrameId> frames) const;

  // Removes the files of the state, except for `lock`.
  void RemoveAll();
  // Ends a finished render: writes report.json (report-NAME.json if the state is in
  // DIR/partial/NAME/) with the frames of `report` and those of the same film that an earlier
  // render left in the folder, and removes the state. If the state still has plates of unfinished
  // frames, only the reports of finished frames are removed.
  Result<void> Close(const RenderReport& report);

 private:
  RunState(const RunStateOptions& options, const CameraPath& path, FileLock lock);
  Result<void> FindEarlierRun();
  Result<void> CheckOtherPackages() const;
  Result<void> FindOtherFilms();
  Result<void> Read();
  bool IsKept(const std::filesystem::path& picture) const;
  Result<void> ReadFinished(const std::filesystem::path& path);
  Result<void> CheckPlate(FrameId frame) const;
  Result<void> Check(const std::string& place, FrameId frame, const RunInputs& recorded,
                     bool has_picture) const;
  std::filesystem::path PlatePath(FrameId frame) const;
  std::filesystem::path RecordPath(FrameId frame) const;
  std::filesystem::path RaysPath(FrameId first, size_t section) const;
  std::filesystem::path KeptPath(FrameId first) const;
  std::filesystem::path ReportPath() const;
  std::string Name() const;

  RunStateOptions options_;
  const CameraPath& path_;
  std::filesystem::path partial_;
  FileLock lock_;
  std::mutex plates_mutex_;    // held while SavePlate() changes plates_
  std::set<FrameId> plates_;   // unfinished frames with a plate in the state
  std::set<FrameId> records_;  // finished frames with a report in the state
  bool has_rays_ = false;      // true if the state has rebinned rays or kept pixels
  std::map<FrameId, FrameReport> finished_;
  RenderReport earlier_;
  std::optional<RenderReport> staying_;  // frames of this film that the render does not write
};

}  // namespace lf
