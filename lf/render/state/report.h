// The report of a render: report.json, and the numbers that people are shown. The state of an
// interrupted render also consists of reports: one of each finished frame, and one of the times and
// the skipped LF images.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/film/develop/develop.h"
#include "lf/render/collect/collect.h"
#include "lf/render/collect/sample_rule.h"
#include "lf/render/state/run_inputs.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

// Samples of a frame with --stop-when or --require: the number asked for, and the measured ones.
struct FrameSamples {
  uint32_t asked = 0;
  SampleShare measured;
};

// Noise of a frame with --stop-when or --require "noise<=X" (render/collect/noise_rule.h).
struct FrameNoise {
  double asked = 0;               // X, in linear radiance
  std::optional<double> reached;  // none: too few LF images, or no reachable element
  uint32_t places = 0;            // measured with the LF images before this place of the order
  uint64_t image_count = 0;       // of these, LF images with rays in the frame
};

struct FrameReport {
  FrameId frame;
  FrameRays rays;
  // Per channel R, G, B.
  std::array<uint64_t, 3> empty_element_count{};  // without a ray of their own, not interpolated
  std::array<uint64_t, 3> min_count{};
  std::array<uint64_t, 3> median_count{};
  double develop_s = 0;
  std::optional<FrameSamples> samples;  // if they were asked for
  RunInputs camera;                     // InputsOfCamera()
  // Facts about lens weights, with which counts are sums of weights; none without them.
  struct Weighed {
    double effective_count = 0;  // median over elements that LF images see
                                 // (render/collect/frame_lens.h)
    double hat_share = 0;        // part of hats in the weights
    LensCoverage coverage;
  };
  std::optional<Weighed> weighed = std::nullopt;
  // If set, the frame was finished early (RenderOptions::finish_early), with the LF images before
  // this place of the order.
  std::optional<uint32_t> places_done = std::nullopt;
  // With rebinned rays, the share of the picture that is interpolated between them.
  std::optional<double> interpolated_share = std::nullopt;
  std::optional<FrameNoise> noise = std::nullopt;  // if it was asked for
};

// Facts about rebinned rays (render/hybrid/rebinned_rays.h).
struct RebinReport {
  size_t slab_count = 0;         // of the pass with most slabs
  uint64_t cell_count = 0;       // at the end of the pass with most cells
  uint64_t looked_at_count = 0;  // covered LF pixels
  double cpu_s = 0;              // CPU time from LF pixels to cells
  // "all": all rays that frames ask for; "edges": those at edges; "some": fewer, because there was
  // no room. Unless it is "all", the picture of a frame depends on which frames are rendered with
  // it.
  std::string kept = "all";
};

// Report of one of several packages that were rendered by one call.
struct PackageReport {
  std::string name;
  size_t selected_image_count = 0;  // as in RenderReport
  size_t skipped_image_count = 0;
};

struct RenderReport {
  std::string version;
  RunInputs inputs;  // of rays and pictures, the same for all frames
  Estimator estimator = Estimator::kNearest;
  int width = 0;
  int height = 0;
  int thread_count = 0;
  size_t lf_image_count = 0;        // of the light field
  bool has_masks = false;           // true if LF images have masks, as files or alpha; not written
  size_t selected_image_count = 0;  // LF images read in the largest pass
  size_t pass_count = 0;
  std::vector<FrameReport> frames;
  // LF images that were skipped because they are missing or broken, each once.
  std::vector<SkippedImage> skipped;
  std::vector<PackageReport> packages;  // empty unless RenderPackages() was called
  double total_s = 0;
  double load_cpu_s = 0;  // this and the next two as in CollectTimes
  double load_wall_s = 0;
  double collect_cpu_s = 0;
  std::optional<RebinReport> rebinning = std::nullopt;
  uint64_t peak_memory_bytes = 0;

  uint64_t TestedRays() const;
  uint64_t AcceptedRays() const;
  // Returns true if no frame has light, neither collected nor interpolated.
  bool IsBlack() const;
  // Millions of accepted rays per CPU second of collection.
  double MraysPerSecondPerCore() const;
  // Adds the skipped LF images whose names are not in the list yet.
  void AddSkipped(std::span<const SkippedImage> images);
};

// Returns the counts of a developed frame.
FrameReport MakeFrameReport(FrameId frame, const FrameRays& rays, const DevelopedFrame& developed);

// Largest resident memory of this process so far.
uint64_t PeakMemoryBytes();

std::string ToJson(const RenderReport& report);

// Reads the parts of a report that a resumed render needs: inputs, frames, skipped LF images, times
// and selected_image_count. kInput: the text is not a report. The message calls it `name`.
Result<RenderReport> ParseReport(std::string_view text, const std::string& name);
Result<RenderReport> ReadReport(const std::filesystem::path& path);

Result<void> WriteReport(const RenderReport& report, const std::filesystem::path& path);

}  // namespace lf
