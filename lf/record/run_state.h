// What a render has done so far, in DIR/partial/ of its output folder, so that it can be
// interrupted at any moment and gone on with (doc/checkpoints.md); of a package that has a name, in
// DIR/partial/NAME/.
//
//   lock              held by the process at work
//   run.json          times so far and skipped LF images
//   rays_0001_1.rays  rebinned rays of the frames from 1 on
//   frame_0001.plate  the plate of an unfinished frame, what it is made from and how far it is
//   frame_0001.exr    its picture, about as new
//   frame_0002.json   the report of a finished frame, and what it is made from
//
// Of a shard (shard.h) all of that is in DIR/partial/shard_1_of_5/, or NAME.shard_1_of_5/; its
// finished frames are plates, DIR/partial/shards/shard_1_of_5/frame_0001.plate.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lf/collector/collect.h"
#include "lf/collector/noise_moments.h"
#include "lf/core/file_lock.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/path/camera_path.h"
#include "lf/plate/plate_file.h"
#include "lf/plate/sensor_plate.h"
#include "lf/rebinning/ray_map.h"
#include "lf/record/report.h"
#include "lf/record/run_inputs.h"
#include "lf/record/shard.h"
#include "lf/sequence/frame_file.h"

namespace lf {

struct RunStateOptions {
  std::filesystem::path folder;  // DIR
  std::string package;           // its name, if others are rendered into DIR at the same time
  std::vector<FrameId> frames;   // of the package, ascending
  FrameFormat format = FrameFormat::kExrHalf;
  bool resume = false;     // go on with what is there
  bool overwrite = false;  // remove what is there
  RunInputs rays;          // InputsOfRays, InputsOfPicture
  RunInputs picture;
  std::optional<Shard> shard = std::nullopt;
};

class RunState {
 public:
  // Makes the folder, locks it and looks at what is there. The path must outlive the state.
  // kUsage: an unfinished render is there and neither resume nor overwrite is asked for, or it was
  //   made from other inputs: the message names the first that differs, and both values. Or other
  //   packages were rendered into the folder from other inputs.
  // kInput: a file of the state is damaged. kOutput: the folder, or another program at work in it.
  static Result<std::unique_ptr<RunState>> Open(const RunStateOptions& options,
                                                const CameraPath& path);
  ~RunState();  // leaves no empty partial/ behind

  // Frames that were finished before and are still there.
  const std::map<FrameId, FrameReport>& finished() const { return finished_; }
  // Times and skipped LF images of earlier runs.
  const RenderReport& earlier() const { return earlier_; }
  // Of unfinished frames, or rebinned rays for them.
  bool HasPlates() const { return !plates_.empty() || has_rays_; }
  bool HasPlate(FrameId frame) const { return plates_.contains(frame); }

  // Where a finished frame is: its picture, or the plate of a shard.
  std::filesystem::path FinishedPath(FrameId frame) const;

  // Adds the rays of the frame's plate, if there is one, and tells how far it is.
  //   plate    empty, of the frame's size
  //   moments  gets the moments that were saved with it, if it is given and there are any
  // kInput: damaged.
  Result<FrameProgress> LoadPlate(FrameId frame, SensorPlate* plate,
                                  std::optional<NoiseMoments>* moments = nullptr) const;
  // Writes the frame's plate, and its moments, unless null, into the same file, so that both are
  // always of the same LF images. kOutput; the file before is then intact.
  Result<void> SavePlate(FrameId frame, const FrameProgress& progress, const SensorPlate& plate,
                         ThreadPool& pool, const NoiseMoments* moments = nullptr);
  // Rebinned rays of a pass, by its first frame, and what they depend on beside the inputs: of a
  // section those that LoadRays() finds, none if there are none.
  // kUsage: of other frames. kInput: damaged, or more than max_cells.
  struct Rays {
    RayMap map;
    uint32_t places_done = 0;
  };
  Result<std::optional<Rays>> LoadRays(FrameId first, size_t section, const std::string& frames,
                                       size_t max_cells, ThreadPool& pool) const;
  Result<void> SaveRays(FrameId first, size_t section, const std::string& frames, const RayMap& map,
                        uint32_t places_done, ThreadPool& pool);
  void RemoveRays();

  Result<void> SaveTotals(const RenderReport& totals);
  // To be called when the frame's own file is written: its unfinished files are removed.
  Result<void> SaveFinished(const FrameReport& frame);
  // A finished frame that is to be rendered anew.
  void Forget(FrameId frame) { finished_.erase(frame); }

  // Returns what a plate's file says beside its rays, also of one that is kept.
  //   moments  null: none
  PlateEntries PlateText(FrameId frame, const FrameProgress& progress,
                         const NoiseMoments* moments = nullptr) const;
  std::filesystem::path PicturePath(FrameId frame) const;

  // Nothing that is there is of use: removes it.
  void RemoveAll();
  // All is done: writes report.json (of a package report-NAME.json) and removes what is not needed
  // any more.
  Result<void> Close(const RenderReport& report);

 private:
  RunState(const RunStateOptions& options, const CameraPath& path, FileLock lock);
  Result<void> Look();
  Result<void> CheckOtherPackages() const;
  Result<void> Read();
  bool IsKept(const std::filesystem::path& picture) const;
  Result<void> ReadFinished(const std::filesystem::path& path);
  Result<void> CheckPlate(FrameId frame) const;
  Result<void> Check(const std::string& place, FrameId frame, const RunInputs& recorded,
                     bool has_picture) const;
  std::filesystem::path PlatePath(FrameId frame) const;
  std::filesystem::path RecordPath(FrameId frame) const;
  std::filesystem::path RaysPath(FrameId first, size_t section) const;
  std::filesystem::path ReportPath() const;
  std::string Name() const;

  RunStateOptions options_;
  const CameraPath& path_;
  std::filesystem::path partial_;
  FileLock lock_;
  std::set<FrameId> plates_;   // files that are there
  std::set<FrameId> records_;  // of finished frames
  bool has_rays_ = false;
  std::map<FrameId, FrameReport> finished_;
  RenderReport earlier_;
};

}  // namespace lf
