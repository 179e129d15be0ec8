// SPDX-License-Identifier: Apache-2.0
#include "tools/rebin_arguments.h"

#include <fmt/format.h>

#include "tools/common/help.h"
#include "tools/common/program.h"
#include "tools/common/validators.h"

#include "lf/core/quantities.h"
#include "lf/core/value_named.h"

namespace lf {

namespace {

void AddKeptRays(OptionGroup& group, RebinArguments& a) {
  group.AddChoice(
      "--kept", a.kept, {"auto", "all", "edges"},
      "Rays that are kept in memory\n"
      "all: all rays that the frames need\n"
      "edges: a random selection of these rays, more of them where the LF image changes strongly\n"
      "auto: all if there are at most --max-rays of them, otherwise edges");
  group
      .Add(
          "--max-rays N", a.max_rays,
          "Most rebinned rays (cells) in memory (as --memory allows)\n"
          "A rebinned ray is the mean of all rays in one cell of the slab. N may end in k, M or G, "
          "such as 3M for 3 million. 0: as many as fit into half of --memory, or into a quarter of "
          "it with --mode hybrid.")
      ->check(NotEmpty());
  group.AddChoice(
      "--average-others", a.average_others, {"on", "off"},
      "Average rays that are not kept into existing cells\n"
      "on: a ray that is not kept is averaged into its cell if a kept ray has made this "
      "cell already; this gives less noise and takes more time\n"
      "off: only kept rays are averaged");
  group.AddChoice(
      "--preview", a.preview, {"auto", "on", "off"},
      "Interpolate gaps in unfinished frames of the hybrid\n"
      "on: rays of the first 64 LF images of each frame are kept, so that elements that have no "
      "collected ray yet are interpolated in pictures of the frame before it is finished\n"
      "off: elements without a collected ray are interpolated only if they have none in the end\n"
      "auto: on for frames that need more than 256 LF images");
}

void AddProbabilities(OptionGroup& group, RebinArguments& a) {
  ProbabilityOptions& edges = a.options.rebin.probability;
  group
      .Add("--alpha X", edges.alpha,
           "Probability that a ray is kept, per image change\n"
           "Used with --kept edges. "
           "A ray is kept with the probability X * C + --xi, where C is the change of the LF image "
           "at its pixel: the absolute Laplacian of the stored values, where black is 0 and white "
           "is 1.")
      ->check(CLI::Range(0.0, kMostAlpha));
  group
      .Add("--beta X", edges.beta,
           "Drop rays where the image changes less than this\n"
           "Used with --kept edges. X is compared with the change C of the image that --alpha "
           "describes.")
      ->check(CLI::Range(0.0, 1.0));
  group
      .Add(
          "--xi X", edges.xi,
          "Least probability that a ray is kept\n"
          "Used with --kept edges. X is added to the probability that --alpha gives, and is the "
          "whole probability where the image does not change. Rays that --beta drops are not kept.")
      ->check(CLI::Range(0.0, 1.0));
  group
      .Add("--edge-sigma PIXELS", edges.sigma_px,
           "Sigma of the smoothing before edge detection\n"
           "Used with --kept edges: the LF image is smoothed by a Gaussian before edges are "
           "detected. In LF pixels. 0: no smoothing.")
      ->check(CLI::Range(0.0, kMostSigma_px));
  group
      .Add("--probability-sigma PIXELS", edges.second_sigma_px,
           "Sigma of the smoothing of probabilities (not smoothed)\n"
           "Used with --kept edges: the probabilities of --alpha are smoothed by a Gaussian, so "
           "that rays beside edges are kept. In LF pixels. 0: no smoothing.")
      ->check(CLI::Range(0.0, kMostSigma_px));
  group
      .Add("--colour-sigma PIXELS", a.options.rebin.colour_sigma_px,
           "Sigma of the smoothing of ray colours (not smoothed)\n"
           "The colours of kept rays are smoothed by a Gaussian, which reduces noise. In LF "
           "pixels. 0: no smoothing.")
      ->check(CLI::Range(0.0, kMostSigma_px));
}

void AddInterpolation(OptionGroup& group, RebinArguments& a) {
  group
      .Add("--sigma-st X", a.options.query.sigma_st,
           "Width of the interpolation kernel on the lens\n"
           "X is the standard deviation of the Gaussian that weights rays by where they pass the "
           "lens, in units of the distance between LF cameras.")
      ->check(CLI::Range(0.01, 100.0));
  group
      .Add("--sigma-uv X", a.options.query.sigma_uv,
           "Width of the interpolation kernel on the plate\n"
           "X is the standard deviation of the Gaussian that weights rays by where they meet the "
           "sensor plate, in elements (pixels of the frame), or in LF pixels where these are "
           "larger.")
      ->check(CLI::Range(0.05, 8.0));
  group
      .Add("--lens-points N", a.options.query.lens_point_count,
           "Rays interpolated per element (until kernels overlap)\n"
           "Each ray passes another point of the lens. 0: from 8 to 256, as many as are needed for "
           "the kernels of --sigma-st to overlap.")
      ->check(CLI::Range(0, 4096));
  group
      .Add("--lens-sets K", a.options.query.lens_sets,
           "Vary the lens points in squares of K x K elements\n"
           "Each element of a square is interpolated through other points of the lens, which turns "
           "visible steps in the blur into noise. 1: all elements have the same lens points.")
      ->check(CLI::Range(1, 8));
  group.AddChoice("--reparameterise", a.reparameterise, {"on", "off"},
                  "Measure distances of rays on lens and focus plane\n"
                  "A ray is interpolated from kept rays by their distances from it.\n"
                  "on: distances are measured on the lens plane and focus plane of each frame\n"
                  "off: distances are measured on the two planes of the slab");
}

void AddSlab(OptionGroup& group, RebinArguments& a) {
  group
      .Add("--r-st WIDTH", a.r_st_w,
           "Width of cells on the st plane (from camera distances)\n"
           "In world units. All rays in one cell of the slab are averaged. 0: at most a quarter of "
           "the distance between LF cameras.")
      ->check(CLI::NonNegativeNumber);
  group
      .Add("--r-uv WIDTH", a.r_uv_w,
           "Width of cells on the uv plane (from pixel sizes)\n"
           "In world units. All rays in one cell of the slab are averaged. 0: a quarter of an LF "
           "pixel or an eighth of an element, whichever is more.")
      ->check(CLI::NonNegativeNumber);
  group
      .Add("--slab-position X Y Z", a.slab_position_w,
           "Point on the st plane (among the lenses of the frames)\n"
           "In world coordinates. The st plane is the plane of the slab that lies near the lenses.")
      ->expected(3);
  group
      .Add("--slab-forward X Y Z", a.slab_forward,
           "Direction that the slab faces (as the frames look)\n"
           "In world coordinates, perpendicular to both planes of the slab. It must be within 60 "
           "degrees of the viewing direction of every frame.")
      ->expected(3);
  group
      .Add("--slab-distance X", a.slab_distance_w,
           "Distance from st plane to uv plane (to the focus plane)\n"
           "In world units. 0: half-way, in disparity, between the nearest and the farthest focus "
           "distance.")
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
           "Needs --back-end reference. The N nearest rays are used at any distance. 0: all rays "
           "within three times --sigma-st and --sigma-uv are used.")
      ->check(CLI::Range(0, 1000));
  measuring
      .Add("--coverage-cells N", options.coverage.cells_across,
           "Cells of the coverage map across a frame\n"
           "The coverage map finds rays that no frame needs, so that they are not kept. A map of "
           "more cells finds more of these rays.")
      ->check(CLI::Range(4, 1024));
}

Result<RebinSettings> RebinArguments::Make() const {
  RebinSettings made;
  made.rebin = options.rebin;
  made.query = options.query;
  made.nearest = static_cast<size_t>(nearest);
  made.coverage = options.coverage;
  made.kept = ValueNamed(kept, {KeptRays::kAll, KeptRays::kEdges}).value_or(KeptRays::kAuto);
  LF_ASSIGN_OR_RETURN(made.max_cells, ParseCount(max_rays, "--max-rays"));
  if (made.max_cells > 0 && made.max_cells < RebinnedRays::kLeastCells)
    return UsageError(
        fmt::format("--max-rays {}: expected 0 (as many as --memory allows), or at least {}",
                    max_rays, RebinnedRays::kLeastCells));
  made.reparameterise = reparameterise == "on";
  if (!made.reparameterise && made.query.lens_sets > 1)
    return UsageError(
        "--reparameterise off cannot be used with --lens-sets above 1: leave one of them out");
  made.previews = ValueNamed(preview, {Previews::kOn, Previews::kOff}).value_or(Previews::kAuto);
  made.rebin.averages_others = average_others == "on";
  if (r_st_w > 0) made.slab.r_st_w = r_st_w;
  if (r_uv_w > 0) made.slab.r_uv_w = r_uv_w;
  if (slab_distance_w > 0) made.slab.uv_distance_w = slab_distance_w;
  const auto vector = [](const std::vector<double>& v) { return Vec3(v[0], v[1], v[2]); };
  if (!slab_position_w.empty()) made.slab.position_world = vector(slab_position_w);
  if (!slab_forward.empty()) made.slab.forward_world = vector(slab_forward);
  if (made.slab.forward_world && !(made.slab.forward_world->norm() > 0))
    return UsageError(
        "--slab-forward 0 0 0: expected a direction, with at least one number other than 0");
  return made;
}

}  // namespace lf
