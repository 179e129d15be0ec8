// Makes packages from a light field and a camera path (thesis 4.2.1), and forecasts the cost of
// rendering them.
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
#include "lf/render/hybrid/render_mode.h"
#include "lf/render/package/package.h"
#include "lf/selection/lens_weights/frame_weights.h"

namespace lf {

// Quantity of which packages get about equal shares.
enum class PackageBalance { kRays, kFrames };

struct PreprocessOptions {
  std::optional<std::filesystem::path> output_folder;  // none: nothing is written
  bool overwrite = false;                              // replace existing packages
  std::vector<FrameId> frames;                         // ascending; empty: all of the path
  ImageOrder order = ImageOrder::kShuffle;
  uint64_t seed = 0;
  std::optional<size_t> max_image_count;
  std::optional<double> max_angle_rad;

  // Options of the later renders. Packages serve any estimator and any lens weights, but packages
  // for kNone lack the neighbours that weights are measured against.
  RayReading reading = {.estimator = Estimator::kBilinear};
  LensWeights lens_weights = LensWeights::kAuto;
  // Determines what frames need, and thereby the forecast and what lfcompressor --needed-pixels
  // keeps. Packages of whole LF images serve every mode.
  RenderMode mode = RenderMode::kCollect;

  // Number of packages: package_count; or as many as frames_per_package requires; or, by default,
  // as few as possible such that the plates of each fit into memory_bytes together.
  size_t memory_bytes = size_t{8} << 30;
  std::optional<size_t> package_count;
  std::optional<size_t> frames_per_package;
  PackageBalance balance = PackageBalance::kRays;

  std::optional<DepthRange> depths;  // of the scene; none: as the light field states
  bool strict = false;               // a missing LF image is an error
  std::string version;               // of the program
  std::string light_field_name;      // LIGHTFIELD, as the user gave it
  const std::atomic<bool>* interrupted = nullptr;
};

struct FrameForecast {
  FrameId frame;
  size_t image_count = 0;  // approximate number of LF images with rays
  uint64_t ray_count = 0;  // number of pixels of their rectangles
  FrameDensity density;
};

struct PackageForecast {
  std::string name;  // package-0000; for a part of the film: package-0000-of-frames-1-4
  std::vector<FrameId> frames;
  size_t image_count = 0;      // LF images to be read
  size_t missing_count = 0;    // of these, files that are missing or empty
  size_t neighbour_count = 0;  // further LF cameras against which lens weights are measured
  uint64_t read_bytes = 0;     // size of their files
  uint64_t ray_count = 0;
  size_t memory_bytes = 0;
  size_t pass_count = 0;  // passes over the LF images; above 1 if the plates do not fit into the
                          // memory together
  double cpu_s = 0;       // for rendering; 0 without a rate
};

struct PreprocessReport {
  size_t light_field_image_count = 0;
  size_t needed_count = 0;    // LF images that packages need, each counted once
  size_t missing_count = 0;   // of these, files that are missing or empty
  std::string first_missing;  // path of the first missing file
  std::vector<FrameForecast> frames;
  std::vector<PackageForecast> packages;
  std::optional<RenderRate> rate;
  std::string rate_error;  // why there is no rate
  double index_s = 0;      // time for the octree and the order
  double select_s = 0;     // time for the needs of frames, computed twice: to divide the film, and
                           // to make packages
  double density_s = 0;
  double write_s = 0;
};

// Makes the packages. They get their final names together, when all are complete
// (package_folder.h). kUsage: packages exist, kArea cannot weigh the lenses, lens weights are given
// with RenderMode::kRebin, or max_image_count with rebinned rays. kInput: no LF image contributes
// to any frame, or one is missing with `strict`. kOutput: the disk fails, another program is at
// work in the folder, or one frame needs more than the memory. kInterrupted. After an error the
// previous packages are there, or none.
Result<PreprocessReport> Preprocess(const LightField& light_field, const CameraPath& path,
                                    const PreprocessOptions& options, ThreadPool& pool,
                                    const std::function<void(size_t done, size_t total)>& progress);

}  // namespace lf
