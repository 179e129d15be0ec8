#include "tools/rebin_arguments.h"

#include <fmt/format.h>

#include "tools/common/program.h"

namespace lf {

void RebinArguments::AddTo(CLI::App& app) {
  constexpr const char* kGroup = "Rebinned rays (--mode rebin, hybrid; doc/rebinning.md)";
  const auto add = [&](const char* name, auto& value, const char* help) {
    return app.add_option(name, value, help)->group(kGroup);
  };
  ProbabilityOptions& edges = options.rebin.probability;
  add("--kept", kept,
      "Rays that finished frames ask for: all, edges (by how much the image changes there), or "
      "auto: "
      "all if --max-rays has room for them")
      ->check(CLI::IsMember({"auto", "all", "edges"}));
  add("--max-rays", max_rays,
      "The most cells of rays in memory; 0: what half of --memory holds, with hybrid a quarter")
      ->check(WholeNumber());
  add("--alpha", edges.alpha, "Of edges: probability per change of stored values, black to white 1")
      ->check(CLI::Range(0.0, kMostAlpha));
  add("--beta", edges.beta, "Rays where the image changes less are left out")
      ->check(CLI::Range(0.0, 1.0));
  add("--xi", edges.xi, "Probability of every other ray, added")->check(CLI::Range(0.0, 1.0));
  add("--edge-sigma", edges.sigma_px, "LF pixels that the image is smoothed by before; 0: not")
      ->check(CLI::Range(0.0, kMostSigma_px));
  add("--probability-sigma", edges.second_sigma_px,
      "LF pixels that probabilities are smoothed by; 0: not")
      ->check(CLI::Range(0.0, kMostSigma_px));
  add("--colour-sigma", options.rebin.colour_sigma_px,
      "LF pixels that colours of rays are smoothed by, against noise; 0: as recorded")
      ->check(CLI::Range(0.0, kMostSigma_px));
  add("--average-others", average_others,
      "on: rays that are not kept are added to cells that are there: less noise, more time")
      ->check(CLI::IsMember({"on", "off"}));
  add("--preview", preview,
      "hybrid: on, rays are kept for unfinished pictures, too, until enough is collected; off; "
      "auto: on for frames that need more than 256 LF images")
      ->check(CLI::IsMember({"auto", "on", "off"}));
  add("--sigma-st", options.query.sigma_st,
      "Of the kernel on the lens, in distances between LF cameras")
      ->check(CLI::Range(0.01, 100.0));
  add("--sigma-uv", options.query.sigma_uv,
      "Of the kernel on the plate, in elements (in LF pixels where these are larger)")
      ->check(CLI::Range(0.05, 8.0));
  add("--nearest", nearest,
      "With --back-end reference: of so many rays, however far; 0: of those within 3 sigma")
      ->check(CLI::Range(0, 1000));
  add("--lens-points", options.query.lens_point_count,
      "Rays asked for each element; 0: so many that their kernels overlap, 8 to 256")
      ->check(CLI::Range(0, 4096));
  add("--lens-sets", options.query.lens_sets,
      "K: elements of K x K squares have different lens points: noise in place of steps")
      ->check(CLI::Range(1, 8));
  add("--reparameterise", reparameterise,
      "on: rays are told apart on each frame's lens and focus plane; off: on the slab's planes")
      ->check(CLI::IsMember({"on", "off"}));
  add("--r-st", r_st_w, "Width of cells on the slab's st plane, world units; 0: by LF cameras")
      ->check(CLI::NonNegativeNumber);
  add("--r-uv", r_uv_w, "The same on its uv plane; 0: by pixels")->check(CLI::NonNegativeNumber);
  add("--slab-position", slab_position_w, "X Y Z of the st plane; default: among the frames")
      ->expected(3);
  add("--slab-forward", slab_forward, "X Y Z that the slab faces; default: as the frames do")
      ->expected(3);
  add("--slab-distance", slab_distance_w,
      "From the st plane to the uv plane, world units; 0: to the focus")
      ->check(CLI::NonNegativeNumber);
  add("--coverage-cells", options.coverage.cells_across,
      "How finely rays are sorted out that no frame asks for: cells across a frame")
      ->check(CLI::Range(4, 1024));
}

Result<RebinPassOptions> RebinArguments::Make(uint64_t seed) const {
  RebinPassOptions made;
  made.rebin = options.rebin;
  made.query = options.query;
  made.nearest = static_cast<size_t>(nearest);
  made.coverage = options.coverage;
  for (const KeptRays known : {KeptRays::kAll, KeptRays::kEdges})
    if (kept == NameOf(known)) made.kept = known;
  made.max_cells = static_cast<size_t>(max_rays);
  if (max_rays > 0 && made.max_cells < RebinnedRays::kLeastCells)
    return UsageError(fmt::format("--max-rays {}: expected 0, or {} and more", max_rays,
                                  RebinnedRays::kLeastCells));
  made.reparameterise = reparameterise == "on";
  if (!made.reparameterise && made.query.lens_sets > 1)
    return UsageError("--reparameterise off: has one set of lens points: leave out --lens-sets");
  for (const Previews known : {Previews::kOn, Previews::kOff})
    if (preview == NameOf(known)) made.previews = known;
  made.rebin.averages_others = average_others == "on";
  made.rebin.seed = made.query.seed = seed;
  if (r_st_w > 0) made.slab.r_st_w = r_st_w;
  if (r_uv_w > 0) made.slab.r_uv_w = r_uv_w;
  if (slab_distance_w > 0) made.slab.uv_distance_w = slab_distance_w;
  const auto vector = [](const std::vector<double>& v) { return Vec3(v[0], v[1], v[2]); };
  if (!slab_position_w.empty()) made.slab.position_world = vector(slab_position_w);
  if (!slab_forward.empty()) made.slab.forward_world = vector(slab_forward);
  if (made.slab.forward_world && !(made.slab.forward_world->norm() > 0))
    return UsageError("--slab-forward 0 0 0 is no direction");
  return made;
}

}  // namespace lf
