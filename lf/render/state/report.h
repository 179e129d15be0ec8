// SPDX-License-Identifier: Apache-2.0
// The report of a render: the contents of report.json, from which programs also print numbers for
// people. The state of an interrupted render also contains reports: one for each finished frame,
// and one with the times and the skipped LF images.
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
#include "lf/film/develop/picture.h"
#include "lf/render/collect/frame_rays.h"
#include "lf/render/state/run_inputs.h"
#include "lf/selection/lens_weights/lens_coverage.h"

namespace lf {

// Samples of a frame, measured if FilmSettings::stop_when or `require` has a rule for them. `asked`
// is N of "samples>=N".
struct FrameSamples {
  uint32_t asked = 0;
  SampleShare measured;
};

// Noise of a frame, measured if FilmSettings::stop_when or `require` has a rule for it
// (render/collect/noise_rule.h).
struct FrameNoise {
  double asked = 0;               // X of the rule, in linear radiance
  std::optional<double> reached;  // unset: cannot be measured (MeasureNoise() is infinite)
  uint32_t ranks = 0;             // the LF images before this rank of the order were collected
  uint64_t image_count = 0;       // number of LF images before `ranks` with rays in the frame
};

// How much of a frame with a guarded plate, or of a film of such frames, rests on virtual LF
// images.
struct VirtualLight {
  // Mean of DevelopedFrame::densified over the elements with rays.
  double densified_share = 0;
  // Share of these elements whose virtual light is doubtful (DevelopedFrame::doubtful_count).
  double doubtful_share = 0;
  friend bool operator==(const VirtualLight&, const VirtualLight&) = default;
};

// Report of one finished frame.
struct FrameReport {
  FrameId frame;
  FrameRays rays;
  // The next three arrays have one value for each of the channels R, G, B: the number of elements
  // that have neither a collected ray nor an interpolated colour; the smallest and the median
  // number of rays that an element collected.
  std::array<uint64_t, 3> empty_element_count{};
  std::array<uint64_t, 3> min_count{};
  std::array<uint64_t, 3> median_count{};
  double develop_s = 0;                 // elapsed time to develop the plate
  std::optional<FrameSamples> samples;  // set if a rule "samples>=N" was given
  RunInputs camera;                     // result of InputsOfCamera()
  // Facts about lens weights; unset if there are none. With lens weights, counts are sums of
  // weights.
  struct Weighed {
    // Median of FrameLens::EffectiveCounts(), the effective numbers of LF images, over the elements
    // that LF images see.
    double effective_count = 0;
    double hat_share = 0;  // share of the hat weights in all weights
    LensCoverage coverage;
  };
  std::optional<Weighed> weighed = std::nullopt;
  // If set, the frame was finished early (FolderOptions::finish_early): it has only the LF images
  // before this rank of the order.
  std::optional<uint32_t> ranks_done = std::nullopt;
  // The share of the picture that is interpolated from rebinned rays; unset if the mode has none.
  std::optional<double> interpolated_share = std::nullopt;
  std::optional<VirtualLight> virtual_light = std::nullopt;  // unset unless the plate is guarded
  // Set if a rule "noise<=X" was given, unless the frame was finished early from a plate without
  // noise moments.
  std::optional<FrameNoise> noise = std::nullopt;
};

// Facts about rebinned rays (render/hybrid/rebinned_rays.h), or about kept pixels
// (render/hybrid/frame_pixels.h).
struct RebinReport {
  size_t slab_count = 0;    // largest number of slabs in a pass; 0 with kept pixels
  uint64_t cell_count = 0;  // largest number of cells at the end of a pass; 0 with kept pixels
  // Number of LF pixels that the coverage maps cover or, with kept pixels, that frames ask for.
  uint64_t looked_at_count = 0;
  double cpu_s = 0;  // CPU time to keep cells or pixels, sum of all threads
  // Says which of the rays that finished frames need were kept. "all": all of them; "edges": only
  // rays at edges in the LF images; "some": not even all of these, because there was no room.
  // Unless it is "all", the picture of a frame depends on which other frames are rendered in the
  // same pass.
  std::string kept = "all";
  struct Pixels {
    uint64_t count = 0;     // largest number of kept pixels at the end of a pass
    double kept_share = 1;  // FramePixels::Facts::kept_share, the smallest of all passes
  };
  std::optional<Pixels> pixels = std::nullopt;  // unset with cells

  // Adds the facts of other passes: of counts that are the largest of a pass, the larger is kept.
  void Add(const RebinReport& other);
};

// Report of one of the packages that one call of RenderPackages() has rendered.
struct PackageReport {
  std::string name;
  size_t selected_image_count = 0;  // largest number of recorded LF images that a pass reads
  size_t skipped_image_count = 0;
  size_t selected_virtual_count = 0;  // largest number of virtual LF images that a pass reads
};

// Report of a whole render.
struct RenderReport {
  std::string version;
  RunInputs inputs;  // RunStateOptions::rays and picture, which all frames have in common
  Estimator estimator = Estimator::kNearest;
  int width = 0;
  int height = 0;
  int thread_count = 0;
  size_t lf_image_count = 0;  // number of recorded LF images of the light field
  size_t virtual_count = 0;   // number of virtual LF images of the light field
  bool has_masks = false;     // true if LF images have masks, as files or alpha; not in the JSON
  // Largest numbers of recorded and virtual LF images that a pass reads.
  size_t selected_image_count = 0;
  size_t selected_virtual_count = 0;
  size_t pass_count = 0;
  std::vector<FrameReport> frames;
  // LF images that were skipped because they are missing or broken, each once.
  std::vector<SkippedImage> skipped;
  std::vector<PackageReport> packages;  // empty unless RenderPackages() was called
  double total_s = 0;
  // This and the next two: the CollectTimes (render/collect/collect.h) of all passes, added up.
  double load_cpu_s = 0;
  double load_wall_s = 0;
  double collect_cpu_s = 0;
  std::optional<RebinReport> rebinning = std::nullopt;
  uint64_t peak_memory_bytes = 0;

  uint64_t TestedRays() const;
  uint64_t AcceptedRays() const;
  // Returns the mean over the frames with guarded plates; nullopt if there are none.
  std::optional<VirtualLight> MeanVirtualLight() const;
  // Returns true if no frame has a collected or interpolated ray.
  bool IsBlack() const;
  // Returns millions of accepted rays per CPU second of collection; 0 if collection took no time.
  double MraysPerSecondPerCore() const;
  // Adds to `skipped` those of `images` whose names are not in it yet.
  void AddSkipped(std::span<const SkippedImage> images);
  void AddRebinning(const RebinReport& other);  // RebinReport::Add(), even if `rebinning` is unset
};

// Returns a report with the counts of a developed frame.
FrameReport MakeFrameReport(FrameId frame, const FrameRays& rays, const DevelopedFrame& developed);

// Returns the largest resident memory that this process has had so far.
uint64_t PeakMemoryBytes();

std::string ToJson(const RenderReport& report);

// Reads the parts of a report that a resumed render needs: version, inputs, frames, skipped LF
// images, times, rebinning and selected_image_count. kInput: the text is not a report. The message
// begins with `name`.
Result<RenderReport> ParseReport(std::string_view text, const std::string& name);
Result<RenderReport> ReadReport(const std::filesystem::path& path);

Result<void> WriteReport(const RenderReport& report, const std::filesystem::path& path);

}  // namespace lf
