// SPDX-License-Identifier: Apache-2.0
#include "lf/core/quantities.h"
#include "lf/rebinning/probability_map.h"
#include "lf/render/settings/setting_rows.h"

namespace lf {
namespace {

void AddKeptRows(std::vector<Setting>& rows) {
  rows.push_back(Choice(
      {.key = "interpolation",
       .text = "What missing rays are interpolated between\n"
               "pixels: LF pixels are kept, those between them are interpolated within their LF "
               "image, and frames are collected from all of them; works with every lens\n"
               "cells: rays are sorted into the cells of a slab, and Gaussian kernels interpolate "
               "between them\n"
               "auto: cells if an option is given that only cells use, or with {mode rebin} and "
               "{lens_weights none}; otherwise pixels"},
      LF_MEMBER(rebin.interpolation),
      Named({RayInterpolation::kAuto, RayInterpolation::kPixels, RayInterpolation::kCells})));
  rows.push_back(Choice(
      {.key = "kept",
       .text = "Rays that are kept in memory\n"
               "all: all rays that the frames need\n"
               "edges: a random selection of these rays, more of them where the LF image changes "
               "strongly\n"
               "auto: all if there are at most {max_rays} of them, otherwise edges"},
      LF_MEMBER(rebin.kept), Named({KeptRays::kAuto, KeptRays::kAll, KeptRays::kEdges})));
  Setting max_rays = {
      .key = "max_rays",
      .placeholder = "N",
      .text =
          "Most kept pixels or cells in memory (as {memory} allows)\n"
          "A cell holds the mean of its rays. N may end in k, M or G, "
          "such as 3M for 3 million. 0: as many as fit into half of {memory}, or into a quarter of "
          "it with {mode hybrid}; pixels at most half of what a frame and two LF images leave."};
  max_rays.get = [](const FilmSettings& film) { return fmt::format("{}", film.rebin.max_cells); };
  max_rays.set = [](const std::string& text, FilmSettings* film) -> Result<void> {
    LF_ASSIGN_OR_RETURN(const uint64_t count, ParseCount(text, "{max_rays}"));
    if (count > 0 && count < RebinSettings::kLeastCells)
      return UsageError(
          fmt::format("{{max_rays {}}}: expected 0 (as many as {{memory}} allows), or at least {}",
                      text, RebinSettings::kLeastCells));
    film->rebin.max_cells = count;
    return {};
  };
  rows.push_back(std::move(max_rays));
  rows.push_back(Switch(
      {.key = "average_others",
       .text = "Average rays that are not kept into existing cells\n"
               "on: a ray that is not kept is averaged into its cell if a kept ray has made this "
               "cell already; this gives less noise, takes more time, and chooses {interpolation "
               "cells}\n"
               "off: only kept rays are averaged"},
      LF_MEMBER(rebin.rebin.averages_others)));
  rows.push_back(Choice(
      {.key = "preview",
       .text = "Interpolate gaps in unfinished frames of the hybrid\n"
               "on: rays of the first 64 LF images of each frame are kept, so that elements that "
               "have no collected ray yet are interpolated in pictures of the frame before it is "
               "finished; chooses {interpolation cells}, because pixels have no previews\n"
               "off: elements without a collected ray are interpolated only if they have none in "
               "the end\n"
               "auto: on for frames that need more than 256 LF images"},
      LF_MEMBER(rebin.previews), Named({Previews::kAuto, Previews::kOn, Previews::kOff})));
}

void AddProbabilityRows(std::vector<Setting>& rows) {
  rows.push_back(Plain(
      {.key = "alpha",
       .placeholder = "X",
       .most = kMostAlpha,
       .text = "Probability that a ray is kept, per image change\n"
               "Used with {kept edges}. A ray is kept with the probability X * C + {xi}, where C "
               "is the change of the LF image at its pixel: the absolute Laplacian of the stored "
               "values, where black is 0 and white is 1."},
      LF_MEMBER(rebin.rebin.probability.alpha)));
  rows.push_back(Plain({.key = "beta",
                        .placeholder = "X",
                        .most = 1,
                        .text = "Drop rays where the image changes less than this\n"
                                "Used with {kept edges}. X is compared with the change C of the "
                                "image that {alpha} describes."},
                       LF_MEMBER(rebin.rebin.probability.beta)));
  rows.push_back(Plain(
      {.key = "xi",
       .placeholder = "X",
       .most = 1,
       .text = "Least probability that a ray is kept\n"
               "Used with {kept edges}. X is added to the probability that {alpha} gives, and is "
               "the whole probability where the image does not change. Rays that {beta} drops are "
               "not kept."},
      LF_MEMBER(rebin.rebin.probability.xi)));
  rows.push_back(Plain({.key = "edge_sigma",
                        .placeholder = "PIXELS",
                        .most = kMostSigma_px,
                        .text = "Sigma of the smoothing before edge detection\n"
                                "Used with {kept edges}: the LF image is smoothed by a Gaussian "
                                "before edges are detected. In LF pixels. 0: no smoothing."},
                       LF_MEMBER(rebin.rebin.probability.sigma_px)));
  rows.push_back(Plain(
      {.key = "probability_sigma",
       .placeholder = "PIXELS",
       .most = kMostSigma_px,
       .text = "Sigma of the smoothing of probabilities (not smoothed)\n"
               "Used with {kept edges}: the probabilities of {alpha} are smoothed by a Gaussian, "
               "so that rays beside edges are kept. In LF pixels. 0: no smoothing."},
      LF_MEMBER(rebin.rebin.probability.second_sigma_px)));
  rows.push_back(Plain({.key = "colour_sigma",
                        .placeholder = "PIXELS",
                        .most = kMostSigma_px,
                        .text = "Sigma of the smoothing of ray colours (not smoothed)\n"
                                "The colours of kept rays are smoothed by a Gaussian, which "
                                "reduces noise. In LF pixels. 0: no smoothing. A number above "
                                "0 chooses {interpolation cells}."},
                       LF_MEMBER(rebin.rebin.colour_sigma_px)));
}

void AddInterpolationRows(std::vector<Setting>& rows) {
  rows.push_back(
      Plain({.key = "sigma_st",
             .placeholder = "X",
             .least = 0.01,
             .most = 100,
             .text = "Width of the interpolation kernel on the lens\n"
                     "X is the standard deviation of the Gaussian that weights rays by where they "
                     "pass the lens, in units of the distance between LF cameras. Another number "
                     "than the default chooses {interpolation cells}."},
            LF_MEMBER(rebin.query.sigma_st)));
  rows.push_back(
      Plain({.key = "sigma_uv",
             .placeholder = "X",
             .least = 0.05,
             .most = 8,
             .text = "Width of the interpolation kernel on the plate\n"
                     "X is the standard deviation of the Gaussian that weights rays by where they "
                     "meet the sensor plate, in elements (pixels of the frame), or in LF pixels "
                     "where these are larger. Another number than the default chooses "
                     "{interpolation cells}."},
            LF_MEMBER(rebin.query.sigma_uv)));
  rows.push_back(
      Plain({.key = "lens_points",
             .placeholder = "N",
             .most = 4096,
             .text = "Rays interpolated per element (until kernels overlap)\n"
                     "Each ray passes another point of the lens. 0: from 8 to 256, as "
                     "many as are needed for the kernels of {sigma_st} to overlap. A number above "
                     "0 chooses {interpolation cells}."},
            LF_MEMBER(rebin.query.lens_point_count)));
  rows.push_back(
      Plain({.key = "lens_sets",
             .placeholder = "K",
             .least = 1,
             .most = 8,
             .text = "Vary the lens points in squares of K x K elements\n"
                     "Each element of a square is interpolated through other points of the lens, "
                     "which turns visible steps in the blur into noise. 1: all elements have the "
                     "same lens points. A number above 1 chooses {interpolation cells}."},
            LF_MEMBER(rebin.query.lens_sets)));
  rows.push_back(
      Switch({.key = "reparameterise",
              .text = "Measure distances of rays on lens and focus plane\n"
                      "A ray is interpolated from kept rays by their distances from it.\n"
                      "on: distances are measured on the lens plane and focus plane of each frame\n"
                      "off: distances are measured on the two planes of the slab; chooses "
                      "{interpolation cells}"},
             LF_MEMBER(rebin.reparameterise)));
}

void AddSlabRows(std::vector<Setting>& rows) {
  rows.push_back(ZeroIfUnset({.key = "r_st",
                              .placeholder = "WIDTH",
                              .text = "Width of cells on the st plane (from camera distances)\n"
                                      "In world units. All rays in one cell of the slab are "
                                      "averaged. 0: at most a quarter of the distance between LF "
                                      "cameras. A width above 0 chooses {interpolation cells}."},
                             LF_MEMBER(rebin.slab.r_st_w)));
  rows.push_back(ZeroIfUnset(
      {.key = "r_uv",
       .placeholder = "WIDTH",
       .text = "Width of cells on the uv plane (from pixel sizes)\n"
               "In world units. All rays in one cell of the slab are "
               "averaged. 0: a quarter of an LF pixel or an eighth of an "
               "element, whichever is more. A width above 0 chooses {interpolation cells}."},
      LF_MEMBER(rebin.slab.r_uv_w)));
  rows.push_back(Point({.key = "slab_position",
                        .placeholder = "X Y Z",
                        .text = "Point on the st plane (among the lenses of the frames)\n"
                                "In world coordinates. The st plane is the plane of the slab that "
                                "lies near the lenses. A point chooses {interpolation cells}."},
                       LF_MEMBER(rebin.slab.position_world)));
  rows.push_back(Point({.key = "slab_forward",
                        .placeholder = "X Y Z",
                        .text = "Direction that the slab faces (as the frames look)\n"
                                "In world coordinates, perpendicular to both planes of the slab. "
                                "It must be within 60 degrees of the viewing direction of every "
                                "frame. A direction chooses {interpolation cells}."},
                       LF_MEMBER(rebin.slab.forward_world)));
  rows.push_back(ZeroIfUnset({.key = "slab_distance",
                              .placeholder = "X",
                              .text = "Distance from st plane to uv plane (to the focus plane)\n"
                                      "In world units. 0: half-way, in disparity, between the "
                                      "nearest and the farthest focus distance. A distance above 0 "
                                      "chooses {interpolation cells}."},
                             LF_MEMBER(rebin.slab.uv_distance_w)));
}

}  // namespace

void AddRebinRows(std::vector<Setting>& rows) {
  AddKeptRows(rows);
  AddProbabilityRows(rows);
  AddInterpolationRows(rows);
  AddSlabRows(rows);
}

}  // namespace lf
