// From a light field and a camera path to packages (thesis 4.2.1), and what rendering them will
// take.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lf/capture/light_field.h"
#include "lf/collector/collect_batch.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/hybrid/render_mode.h"
#include "lf/lens_weights/frame_weights.h"
#include "lf/package/package.h"
#include "lf/path/camera_path.h"
#include "lf/preprocess/frame_density.h"
#include "lf/preprocess/render_rate.h"

namespace lf {

// What packages have about as much of as each other.
enum class PackageBalance { kRays, kFrames };

struct PreprocessOptions {
  std::optional<std::filesystem::path> output_folder;  // none: nothing is written
  bool overwrite = false;                              // packages that are there
  std::vector<FrameId> frames;                         // ascending; empty: all of the path
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  std::optional<size_t> max_image_count;
  std::optional<double> max_angle_rad;

  // Of the renders to come. Packages serve any estimator and any weights, but those that are made
  // for kNone have no neighbours to weigh against.
  RayReading reading = {.estimator = Estimator::kBilinear};
  LensWeights lens_weights = LensWeights::kAuto;
  // Decides what frames need, and so the forecast and what lfcompressor --needed-pixels keeps.
  // Whole LF images serve every mode.
  RenderMode mode = RenderMode::kCollect;

  // How many packages: so many; of so many frames; or, by default, so few that the plates of each
  // are in memory_bytes together.
  size_t memory_bytes = size_t{8} << 30;
  std::optional<size_t> package_count;
  std::optional<size_t> frames_per_package;
  PackageBalance balance = PackageBalance::kRays;

  std::optional<DepthRange> depths;  // of the scene; none: as the light field says
  bool strict = false;               // an LF image that is not there is an error
  std::string version;               // of the program
  std::string light_field_name;      // LIGHTFIELD, as it was given
  const std::atomic<bool>* interrupted = nullptr;
};

struct FrameForecast {
  FrameId frame;
  size_t image_count = 0;  // LF images with rays, about
  uint64_t ray_count = 0;  // pixels of their rectangles
  FrameDensity density;
};

struct PackageForecast {
  std::string name;  // package-0000; of a part of the film: package-0000-of-frames-1-4
  std::vector<FrameId> frames;
  size_t image_count = 0;      // LF images to be read
  size_t missing_count = 0;    // of these, files that are not there, or are empty
  size_t neighbour_count = 0;  // LF cameras that lens weights are measured against besides
  uint64_t read_bytes = 0;     // of their files
  uint64_t ray_count = 0;
  size_t memory_bytes = 0;
  size_t pass_count = 0;  // over the LF images, where the plates are not in the memory together
  double cpu_s = 0;       // of rendering; 0 without a rate
};

struct PreprocessReport {
  size_t light_field_image_count = 0;
  size_t needed_count = 0;    // LF images that packages need, each counted once
  size_t missing_count = 0;   // of these, files that are not there, or are empty
  std::string first_missing;  // its path
  std::vector<FrameForecast> frames;
  std::vector<PackageForecast> packages;
  std::optional<RenderRate> rate;
  std::string rate_error;  // why there is none
  double index_s = 0;      // spent on the octree and the order
  double select_s = 0;     // on what frames need, twice: to divide them, and to pack them
  double density_s = 0;
  double write_s = 0;
};

// Packages get their names together, when all are whole (package_folder.h).
// kUsage: packages are there, lenses that kArea cannot weigh, lens weights with RenderMode::kRebin,
// max_image_count with rebinned rays. kInput: no LF image contributes to
// any frame; one is missing, if strict. kOutput: the disk, another program
// at work in the folder, less memory than one frame needs. kInterrupted. After an error the
// packages of before are there, or none.
Result<PreprocessReport> Preprocess(const LightField& light_field, const CameraPath& path,
                                    const PreprocessOptions& options, ThreadPool& pool,
                                    const std::function<void(size_t done, size_t total)>& progress);

}  // namespace lf
