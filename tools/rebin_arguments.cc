#include "tools/rebin_arguments.h"

#include <fmt/format.h>

#include "tools/common/help.h"
#include "tools/common/program.h"

#include "lf/core/value_named.h"

namespace lf {

namespace {

void AddKeptRays(OptionGroup& group, RebinArguments& a) {
  group.AddChoice("--kept", a.kept, {"auto", "all", "edges"},
                  "Rays that are kept in memory\n"
                  "all: all rays that finished frames ask for\n"
                  "edges: rays are kept with a probability that grows with the change of the image "
                  "there\n"
                  "auto: all if --max-rays has room for them, otherwise edges");
  group
      .Add("--max-rays N", a.max_rays,
           "Most cells of rays in memory (by --memory)\n"
           "0: what half of --memory holds, or a quarter with --mode hybrid.")
      ->check(WholeNumber());
  group.AddChoice("--average-others", a.average_others, {"on", "off"},
                  "Add rays that are not kept to existing cells\n"
                  "This gives less noise and takes more time.");
  group.AddChoice("--preview", a.preview, {"auto", "on", "off"},
                  "Keep rays for unfinished pictures of --mode hybrid\n"
                  "They are kept until enough is collected.\n"
                  "auto: on for frames that need more than 256 LF images");
}

void AddProbabilities(OptionGroup& group, RebinArguments& a) {
  ProbabilityOptions& edges = a.options.rebin.probability;
  group
      .Add("--alpha X", edges.alpha,
           "With edges: probability per change of the image\n"
           "The change is that of stored values, where black to white is 1.")
      ->check(CLI::Range(0.0, kMostAlpha));
  group.Add("--beta X", edges.beta, "Drop rays where the image changes less than this")
      ->check(CLI::Range(0.0, 1.0));
  group
      .Add("--xi X", edges.xi,
           "Probability of every other ray\n"
           "It is added to the probability by --alpha.")
      ->check(CLI::Range(0.0, 1.0));
  group
      .Add("--edge-sigma PIXELS", edges.sigma_px,
           "Sigma of the smoothing before edges are searched\n"
           "In LF pixels. 0: no smoothing.")
      ->check(CLI::Range(0.0, kMostSigma_px));
  group
      .Add("--probability-sigma PIXELS", edges.second_sigma_px,
           "Sigma that smooths the probabilities (not smoothed)\n"
           "In LF pixels.")
      ->check(CLI::Range(0.0, kMostSigma_px));
  group
      .Add("--colour-sigma PIXELS", a.options.rebin.colour_sigma_px,
           "Sigma that smooths the colours of rays (as recorded)\n"
           "In LF pixels. It reduces noise.")
      ->check(CLI::Range(0.0, kMostSigma_px));
}

void AddInterpolation(OptionGroup& group, RebinArguments& a) {
  group
      .Add("--sigma-st X", a.options.query.sigma_st,
           "Width of the kernel on the lens\n"
           "In distances between LF cameras.")
      ->check(CLI::Range(0.01, 100.0));
  group
      .Add("--sigma-uv X", a.options.query.sigma_uv,
           "Width of the kernel on the plate\n"
           "In elements, or in LF pixels where these are larger.")
      ->check(CLI::Range(0.05, 8.0));
  group
      .Add("--lens-points N", a.options.query.lens_point_count,
           "Rays asked for each element (until kernels overlap)\n"
           "0: so many that their kernels overlap, 8 to 256.")
      ->check(CLI::Range(0, 4096));
  group
      .Add("--lens-sets K", a.options.query.lens_sets,
           "Vary the lens points in squares of K x K elements\n"
           "The elements of a square have different lens points: noise in place of steps.")
      ->check(CLI::Range(1, 8));
  group.AddChoice("--reparameterise", a.reparameterise, {"on", "off"},
                  "Tell rays apart on each frame's lens and focus plane\n"
                  "off: rays are told apart on the planes of the slab");
}

void AddSlab(OptionGroup& group, RebinArguments& a) {
  group
      .Add("--r-st WIDTH", a.r_st_w,
           "Width of cells on the st plane (by LF cameras)\n"
           "In world units, on the slab's st plane.")
      ->check(CLI::NonNegativeNumber);
  group
      .Add("--r-uv WIDTH", a.r_uv_w,
           "Width of cells on the uv plane (by pixels)\n"
           "In world units, on the slab's uv plane.")
      ->check(CLI::NonNegativeNumber);
  group.Add("--slab-position X Y Z", a.slab_position_w, "Point of the st plane (among the frames)")
      ->expected(3);
  group
      .Add("--slab-forward X Y Z", a.slab_forward, "Direction that the slab faces (as the frames)")
      ->expected(3);
  group
      .Add("--slab-distance X", a.slab_distance_w,
           "Distance from st plane to uv plane (to the focus)\n"
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
           "Interpolate from the N nearest rays (within 3 sigma)\n"
           "With --back-end reference: takes the N nearest rays, however far they are. 0: takes "
           "the rays within 3 sigma.")
      ->check(CLI::Range(0, 1000));
  measuring
      .Add("--coverage-cells N", options.coverage.cells_across,
           "Cells of the coverage map across a frame\n"
           "The map sorts out rays that no frame asks for; with more cells it does so more finely.")
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
    return UsageError(fmt::format("--max-rays {}: expected 0, or {} and more", max_rays,
                                  RebinnedRays::kLeastCells));
  made.reparameterise = reparameterise == "on";
  if (!made.reparameterise && made.query.lens_sets > 1)
    return UsageError("--reparameterise off: has one set of lens points: leave out --lens-sets");
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
    return UsageError("--slab-forward 0 0 0 is no direction");
  return made;
}

}  // namespace lf
