// SPDX-License-Identifier: Apache-2.0
// Makes packages from a light field and a camera path (thesis 4.2.1), and forecasts the cost of
// rendering the packages.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/distribute/preprocess/frame_density.h"
#include "lf/distribute/preprocess/render_rate.h"
#include "lf/light_field/model/light_field.h"
#include "lf/render/collect/collect_batch.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/film_settings.h"

namespace lf {

// The quantity that is about equal in all packages: tested rays, or frames.
enum class PackageBalance { kRays, kFrames };

struct PreprocessOptions {
  std::optional<std::filesystem::path> output_folder;  // unset: only forecasts
  bool overwrite = false;                              // true: existing packages are replaced
  // Files that are read, besides those of the light field, and that no package may replace.
  std::vector<std::filesystem::path> inputs = {};
  std::vector<FrameId> frames;  // frames to pack, ascending; empty: all frames of the path

  // Settings of the renders that follow. The package states order, seed, max_image_count and
  // max_angle_rad, so that renders cannot change them. Packages can be rendered with any estimator
  // and any lens weights. Exception: packages for LensWeights::kNone and RenderMode::kCollect can
  // only be rendered with these two, because they lack the neighbours, which lens weights and
  // rebinned rays need. The mode decides what frames need, and therefore the forecast, and which
  // pixels lfcompressor --needed-pixels keeps; if whole LF images are kept, other packages can be
  // rendered in any mode. LensWeights::kAuto means kNone if no rays are weighted (HasLensWeights()
  // in interpolation.h).
  FilmSettings film;

  // Number of packages: package_count if it is set; otherwise, if frames_per_package is set, as
  // many as that requires; otherwise as few as possible such that all plates of a package fit into
  // memory_bytes at the same time.
  size_t memory_bytes = size_t{8} << 30;
  std::optional<size_t> package_count;
  std::optional<size_t> frames_per_package;
  PackageBalance balance = PackageBalance::kRays;

  std::optional<DepthRange> depths;  // depths of the scene; unset: those of the light field
  bool strict = false;               // true: a missing LF image is an error
  std::string version;               // version of the program
  std::string light_field_name;      // the argument LIGHTFIELD, as the user wrote it
  std::vector<std::string> light_field_options;  // PackageSource::options
  const std::atomic<bool>* interrupted = nullptr;
};

struct FrameForecast {
  FrameId frame;
  size_t image_count = 0;       // number of recorded LF images that are read
  size_t virtual_count = 0;     // number of virtual LF images that are read
  uint64_t ray_count = 0;       // number of rays that are tested or rebinned
  uint64_t rebinned_count = 0;  // number of these that are rebinned
  FrameDensity density;

  bool ReadsNone() const { return image_count + virtual_count == 0; }
};

// CPU time of a render, by its stages.
struct StageTimes {
  // Prefilters, order of the LF images and octree of the LF cameras; with rebinned rays also their
  // slabs, the gaps of the lenses, and the maps of what is needed.
  double begin_s = 0;
  double load_s = 0;      // reading and decoding LF images
  double collect_s = 0;   // collecting rays
  double rebin_s = 0;     // sorting LF pixels into cells of rebinned rays
  double complete_s = 0;  // interpolating frames from rebinned rays
  double finish_s = 0;    // lens weights, developing and writing

  double Sum() const { return begin_s + load_s + collect_s + rebin_s + complete_s + finish_s; }
};

struct PackageForecast {
  std::string name;  // package-0000, or package-0000-of-frames-1-4 for a part of the film
  std::vector<FrameId> frames;
  size_t image_count = 0;      // number of recorded LF images that are read
  size_t virtual_count = 0;    // number of virtual LF images that are read
  size_t missing_count = 0;    // number of LF images to read whose files are missing or empty
  size_t neighbour_count = 0;  // number of other LF cameras: their images are not read
  uint64_t read_bytes = 0;     // total size of the files that are read
  uint64_t ray_count = 0;
  size_t memory_bytes = 0;  // memory that the render needs
  // Number of passes over the LF images; above 1 if the plates do not all fit into the memory at
  // the same time.
  size_t pass_count = 0;
  StageTimes cpu;  // CPU time to render; 0 if PreprocessReport::rate is unset
};

struct PreprocessReport {
  size_t light_field_image_count = 0;    // number of recorded LF images of the light field
  size_t light_field_virtual_count = 0;  // number of its virtual LF images
  size_t needed_count = 0;               // LF images that packages need, each counted once
  size_t missing_count = 0;   // number of needed LF images whose files are missing or empty
  std::string first_missing;  // path of the first missing or empty file
  std::vector<FrameForecast> frames;
  std::vector<PackageForecast> packages;
  std::optional<RenderRate> rate;
  std::string rate_error;  // reason why `rate` is unset; empty if it is set
  double index_s = 0;      // time to compute the order of LF images and the octree of LF cameras
  // Time to compute the needs of frames: once to divide the film, and again to make packages for
  // needs that were too large to be kept in memory.
  double select_s = 0;
  double density_s = 0;
  double write_s = 0;
};

// Makes the packages. They appear under their final names at the same time, when all are complete
// (package_folder.h). kUsage: packages exist already; a package would replace a file that is read;
// the lens of a frame is a pinhole, but the weights are kArea; settings that only cells use are
// given for pixels; cells are kept (render/settings/interpolation.h), but max_image_count is set,
// the LF images have opacity, the path has a shutter, or a lens has a hood, a transmission or a
// focal surface; cells alone are kept, but lens_weights is not kNone. kInput: no LF image
// contributes to any frame; an LF image is missing and `strict` is set; a packed store lacks
// pixels. kOutput: the disk fails; another process writes packages into the folder; one frame needs
// more than memory_bytes. kInterrupted: *options.interrupted is true. After an error, the folder
// has the previous packages, or none.
//   progress  called twice for each frame, for the forecast and for its package; `total` is twice
//             the number of frames
Result<PreprocessReport> Preprocess(const LightField& light_field, const CameraPath& path,
                                    const PreprocessOptions& options, ThreadPool& pool,
                                    const std::function<void(size_t done, size_t total)>& progress);

}  // namespace lf
