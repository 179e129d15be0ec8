#include "tools/rebin_arguments.h"

#include <fmt/format.h>

#include "tools/common/help.h"
#include "tools/common/program.h"

#include "lf/core/value_named.h"

namespace lf {

namespace {

void AddKeptRays(OptionGroup& group, RebinArguments& a) {
  group.AddChoice(
      "--kept", a.kept, {"auto", "all", "edges"},
      "Rays that are kept in memory\n"
      "all: all rays that the finished frames need\n"
      "edges: a random part of them, with more rays where the LF image changes strongly\n"
      "auto: all if they are at most --max-rays, otherwise edges");
  group
      .Add("--max-rays N", a.max_rays,
           "Most rebinned rays (cells) in memory (as --memory allows)\n"
           "0: as many as fit into half of --memory, or into a quarter with --mode hybrid.")
      ->check(WholeNumber());
  group.AddChoice("--average-others", a.average_others, {"on", "off"},
                  "Average rays that are not kept into existing cells\n"
                  "This gives less noise and takes more time.");
  group.AddChoice("--preview", a.preview, {"auto", "on", "off"},
                  "Interpolate previews of frames in --mode hybrid\n"
                  "Rays are kept for unfinished frames until enough LF images are collected.\n"
                  "auto: on for frames that need more than 256 LF images");
}

void AddProbabilities(OptionGroup& group, RebinArguments& a) {
  ProbabilityOptions& edges = a.options.rebin.probability;
  group
      .Add("--alpha X", edges.alpha,
           "Probability per change of the image, for --kept edges\n"
           "With --kept edges, a ray is kept with the probability X * change + --xi. The change of "
           "the image is measured in stored values, where the step from black to white is 1.")
      ->check(CLI::Range(0.0, kMostAlpha));
  group
      .Add("--beta X", edges.beta,
           "Drop rays where the image changes less than this\n"
           "In the unit of --alpha. Needs --kept edges.")
      ->check(CLI::Range(0.0, 1.0));
  group
      .Add("--xi X", edges.xi,
           "Probability of rays where the image does not change\n"
           "It is added to the probability by --alpha.")
      ->check(CLI::Range(0.0, 1.0));
  group
      .Add("--edge-sigma PIXELS", edges.sigma_px,
           "Sigma of the smoothing before edge detection\n"
           "In LF pixels. 0: no smoothing.")
      ->check(CLI::Range(0.0, kMostSigma_px));
  group
      .Add("--probability-sigma PIXELS", edges.second_sigma_px,
           "Sigma of the smoothing of probabilities (not smoothed)\n"
           "In LF pixels.")
      ->check(CLI::Range(0.0, kMostSigma_px));
  group
      .Add("--colour-sigma PIXELS", a.options.rebin.colour_sigma_px,
           "Sigma of the smoothing of ray colours (not smoothed)\n"
           "In LF pixels. Smoothing reduces noise.")
      ->check(CLI::Range(0.0, kMostSigma_px));
}

void AddInterpolation(OptionGroup& group, RebinArguments& a) {
  group
      .Add("--sigma-st X", a.options.query.sigma_st,
           "Width of the kernel on the lens\n"
           "Standard deviation, in units of the distance between LF cameras.")
      ->check(CLI::Range(0.01, 100.0));
  group
      .Add("--sigma-uv X", a.options.query.sigma_uv,
           "Width of the kernel on the plate\n"
           "Standard deviation, in elements, or in LF pixels where these are larger.")
      ->check(CLI::Range(0.05, 8.0));
  group
      .Add("--lens-points N", a.options.query.lens_point_count,
           "Rays requested per element (until kernels overlap)\n"
           "0: as many as are needed for their kernels to overlap, from 8 to 256.")
      ->check(CLI::Range(0, 4096));
  group
      .Add("--lens-sets K", a.options.query.lens_sets,
           "Vary the lens points in squares of K x K elements\n"
           "Each element of a square has lens points of its own, which turns visible steps into "
           "noise.")
      ->check(CLI::Range(1, 8));
  group.AddChoice("--reparameterise", a.reparameterise, {"on", "off"},
                  "Measure distances of rays on lens and focus plane\n"
                  "on: distances are measured on the lens plane and focus plane of each frame\n"
                  "off: distances are measured on the planes of the slab");
}

void AddSlab(OptionGroup& group, RebinArguments& a) {
  group
      .Add("--r-st WIDTH", a.r_st_w,
           "Width of cells on the st plane (from camera distances)\n"
           "In world units.")
      ->check(CLI::NonNegativeNumber);
  group
      .Add("--r-uv WIDTH", a.r_uv_w,
           "Width of cells on the uv plane (from pixel sizes)\n"
           "In world units.")
      ->check(CLI::NonNegativeNumber);
  group
      .Add("--slab-position X Y Z", a.slab_position_w,
           "Point on the st plane (among the lenses of the frames)")
      ->expected(3);
  group
      .Add("--slab-forward X Y Z", a.slab_forward,
           "Direction that the slab faces (as the frames look)")
      ->expected(3);
  group
      .Add("--slab-distance X", a.slab_distance_w,
           "Distance from st plane to uv plane (to the focus plane)\n"
           "In world units.")
      ->check(CLI::NonNegativeNumber);
}

}  // namespace

void RebinArguments::AddTo(CLI::App& app) {
  OptionGroup group(app, "Rebinned rays (--mode rebin, hybrid; doc/rebinning.md)");
  AddKeptRays(group, *this);
  AddProbabilities(group, *this);
  AddInterpolation(group, *this);
  AddSlab(group, *this);
  OptionGroup measuring(app, kMeasuringGroup);
  measuring
      .Add("--nearest N", nearest,
           "Interpolate from the N nearest rays (all within 3 sigma)\n"
           "Needs --back-end reference. Uses the N nearest rays, at any distance. 0: uses all rays "
           "within 3 sigma.")
      ->check(CLI::Range(0, 1000));
  measuring
      .Add("--coverage-cells N", options.coverage.cells_across,
           "Cells of the coverage map across a frame\n"
           "The map rejects rays that no frame needs. With more cells it rejects more of them.")
      ->check(CLI::Range(4, 1024));
}

Result<RebinPassOptions> RebinArguments::Make(uint64_t seed) const {
  RebinPassOptions made;
  made.rebin = options.rebin;
  made.query = options.query;
  made.nearest = static_cast<size_t>(nearest);
  made.coverage = options.coverage;
  made.kept = ValueNamed(kept, {KeptRays::kAll, KeptRays::kEdges}).value_or(KeptRays::kAuto);
  made.max_cells = static_cast<size_t>(max_rays);
  if (max_rays > 0 && made.max_cells < RebinnedRays::kLeastCells)
    return UsageError(fmt::format("--max-rays {}: expected 0, or at least {}", max_rays,
                                  RebinnedRays::kLeastCells));
  made.reparameterise = reparameterise == "on";
  if (!made.reparameterise && made.query.lens_sets > 1)
    return UsageError(
        "--reparameterise off works with one set of lens points only: leave out --lens-sets");
  made.previews = ValueNamed(preview, {Previews::kOn, Previews::kOff}).value_or(Previews::kAuto);
  made.rebin.averages_others = average_others == "on";
  made.rebin.seed = made.query.seed = seed;
  if (r_st_w > 0) made.slab.r_st_w = r_st_w;
  if (r_uv_w > 0) made.slab.r_uv_w = r_uv_w;
  if (slab_distance_w > 0) made.slab.uv_distance_w = slab_distance_w;
  const auto vector = [](const std::vector<double>& v) { return Vec3(v[0], v[1], v[2]); };
  if (!slab_position_w.empty()) made.slab.position_world = vector(slab_position_w);
  if (!slab_forward.empty()) made.slab.forward_world = vector(slab_forward);
  if (made.slab.forward_world && !(made.slab.forward_world->norm() > 0))
    return UsageError("--slab-forward 0 0 0 is no direction: give a vector that is not zero");
  return made;
}

}  // namespace lf
