// What a render did: report.json, and the numbers a person is told. The state of an interrupted
// render keeps such reports, too: one of each finished frame, and one of what was spent and
// skipped.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/collector/collect.h"
#include "lf/collector/sample_rule.h"
#include "lf/core/ids.h"
#include "lf/core/result.h"
#include "lf/lens_weights/lens_coverage.h"
#include "lf/record/run_inputs.h"
#include "lf/sequence/develop.h"

namespace lf {

// With --stop-when or --require: how many samples were asked for, and what there is.
struct FrameSamples {
  uint32_t asked = 0;
  SampleShare measured;
};

// With --stop-when or --require "noise<=X" (collector/noise_rule.h).
struct FrameNoise {
  double asked = 0;               // X, in linear radiance
  std::optional<double> reached;  // none: too few LF images, or nothing can be reached
  uint32_t places = 0;            // measured with the LF images before this place of the order
  uint64_t image_count = 0;       // of these, LF images with rays in the frame
};

struct FrameReport {
  FrameId frame;
  FrameRays rays;
  // Per channel R, G, B.
  std::array<uint64_t, 3> empty_element_count{};  // without a ray of their own, nor interpolated
  std::array<uint64_t, 3> min_count{};
  std::array<uint64_t, 3> median_count{};
  double develop_s = 0;
  std::optional<FrameSamples> samples;  // where they were asked for
  RunInputs camera;                     // InputsOfCamera()
  // With lens weights (then counts are sums of weights).
  struct Weighed {
    double effective_count = 0;  // median over what LF images see (collector/frame_lens.h)
    double hat_share = 0;        // the part of hats in the weights
    LensCoverage coverage;
  };
  std::optional<Weighed> weighed = std::nullopt;
  // Finished early (RenderOptions::finish_early), with the LF images before this place of the
  // order.
  std::optional<uint32_t> places_done = std::nullopt;
  // With rebinned rays: of the picture, how much is interpolated between them.
  std::optional<double> interpolated_share = std::nullopt;
  std::optional<FrameNoise> noise = std::nullopt;  // where it was asked for
};

// Of rebinned rays (hybrid/rebinned_rays.h).
struct RebinReport {
  size_t slab_count = 0;         // of the pass with the most
  uint64_t cell_count = 0;       // at the end of that with the most
  uint64_t looked_at_count = 0;  // LF pixels
  double cpu_s = 0;              // from LF pixels to cells
  // "all" that frames ask for, "edges" of them, or "some": more than there was room for. Unless it
  // is "all" the picture of a frame depends on which frames are rendered with it.
  std::string kept = "all";
};

// One of several packages that were rendered by one call.
struct PackageReport {
  std::string name;
  size_t selected_image_count = 0;  // as RenderReport
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
  bool has_masks = false;           // LF images of it, by files or alpha; not recorded
  size_t selected_image_count = 0;  // read, largest pass
  size_t pass_count = 0;
  std::vector<FrameReport> frames;
  // LF images that were left out because they are missing or broken, each once.
  std::vector<SkippedImage> skipped;
  std::vector<PackageReport> packages;  // empty unless RenderPackages() was called
  double total_s = 0;
  double load_cpu_s = 0;  // this and the next two as CollectTimes
  double load_wall_s = 0;
  double collect_cpu_s = 0;
  std::optional<RebinReport> rebinning = std::nullopt;
  uint64_t peak_memory_bytes = 0;

  uint64_t TestedRays() const;
  uint64_t AcceptedRays() const;
  // Returns whether no frame has any light: neither collected nor interpolated.
  bool IsBlack() const;
  // Millions of accepted rays per CPU second of collection.
  double MraysPerSecondPerCore() const;
  // Adds those that are not known by their name yet.
  void AddSkipped(std::span<const SkippedImage> images);
};

// Counts of the developed frame.
FrameReport MakeFrameReport(FrameId frame, const FrameRays& rays, const DevelopedFrame& developed);

// Largest resident memory of this process so far.
uint64_t PeakMemoryBytes();

std::string ToJson(const RenderReport& report);

// What was written, as far as a render that goes on needs it: inputs, frames, skipped LF images,
// times, the number selected. kInput: no such text; the message calls it `name`.
Result<RenderReport> ParseReport(std::string_view text, const std::string& name);
Result<RenderReport> ReadReport(const std::filesystem::path& path);

Result<void> WriteReport(const RenderReport& report, const std::filesystem::path& path);

}  // namespace lf
