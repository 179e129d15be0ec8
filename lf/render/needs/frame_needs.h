// SPDX-License-Identifier: Apache-2.0
// Computes which LF images, pixels and LF cameras of a light field one frame needs (thesis 4.2.1).
//
// All parts of the program use FrameNeeds: packages contain these LF cameras, packed stores keep
// these pixels, orders and limits count these LF images, forecasts count these rays, and a render
// reads exactly these pixels (tests/programs/needed_pixels_test.py).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lf/camera/path/camera_path.h"
#include "lf/camera/render_camera.h"
#include "lf/core/geometry.h"
#include "lf/core/ids.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/render/hybrid/frame_sampling.h"
#include "lf/render/hybrid/rebinned_rays.h"
#include "lf/render/package/package.h"
#include "lf/render/settings/render_mode.h"
#include "lf/selection/image_index.h"
#include "lf/selection/lens_weights/frame_weights.h"
#include "lf/selection/select.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// The options of a render that determine what its frames need.
struct NeedsOptions {
  SelectOptions select;  // whole_images must be false
  // Must be kNone if KeepsOnlyCells(), because no rays are collected that could be weighted.
  LensWeights lens_weights = LensWeights::kAuto;
  // Must be above 0. Must be unset if KeepsCells().
  std::optional<size_t> max_image_count;
  RenderMode mode = RenderMode::kCollect;
  // Only its members interpolation, query, previews and rebin are used; none if the mode is
  // kCollect. The interpolation must not be kAuto if the mode rebins (InterpolationOf()).
  RebinSettings rebin;

  // True if the plates of frames are guarded (FilmSetup::is_guarded()): the light field must be
  // densified, and KeepsCells() false.
  bool guard = false;

  bool KeepsCells() const {
    return Rebins(mode) && rebin.interpolation == RayInterpolation::kCells;
  }
  bool KeepsPixels() const { return Rebins(mode) && !KeepsCells(); }
  bool KeepsOnlyCells() const { return KeepsCells() && !Collects(mode); }

  // Returns true if the picture of a frame may depend on LF cameras whose LF images are not read
  // for it.
  bool HasNeighbours() const { return lens_weights != LensWeights::kNone || Rebins(mode) || guard; }
};

struct FrameNeeds {
  struct Image {
    LfImageId id;
    PixelRect rect;  // bounds of all pixels that are read
    // number of pixels that are tested as rays of the frame, at all of its instants, plus number of
    // pixels that are rebinned
    uint64_t ray_count = 0;
  };
  uint64_t rebinned_count = 0;  // number of pixels that are rebinned; a part of RayCount()
  std::vector<Image> images;    // the LF images that are read, by ascending ranks
  // Other LF cameras that are needed to compute lens weights and gaps (render/hybrid/lens_gaps.h),
  // by ascending ids. The LF cameras of `images` and `neighbours` alone give the same lens weights
  // (in a densified light field, with and without its virtual LF images),
  // the same LF images within max_image_count, and (for the default QueryOptions) the same rebinned
  // rays as the whole light field. Empty if NeedsOptions::HasNeighbours() is false.
  std::vector<LfImageId> neighbours;
  // Density of the LF cameras around the lens; set if NeedsOptions::HasNeighbours() is true, or if
  // a sampling was passed to NeedsOf().
  std::optional<FrameSampling> sampling;
  // If the path has a shutter and NeedsOptions::HasNeighbours() is true: distance between
  // neighbouring LF cameras around the lens of each instant. Otherwise empty.
  std::vector<double> instant_distances_w;

  std::optional<double> camera_distance_w() const;
  uint64_t RayCount() const;
};

// SurroundingsOf() returns a sampling in the form that a package stores; SamplingOf() returns the
// sampling that this form stands for.
FrameSurroundings SurroundingsOf(const FrameSampling& sampling);
FrameSampling SamplingOf(const FrameSurroundings& surroundings);
// Returns the sampling that the package stores of a frame of the film; nullopt if the package
// stores no samplings.
std::optional<FrameSampling> SamplingOf(const Package& package, FrameId frame);

// Returns the LF images, pixels and LF cameras that a frame of a path needs: those that its camera
// needs or, with a shutter, those that any of its instants needs. CheckShutter() must accept the
// path.
//   package  the package whose LF cameras `index` covers, which tells samplings and distances of
//            the whole light field; null: they are measured in `index`
FrameNeeds NeedsOf(const ImageIndex& index, const CameraPath& path, FrameId frame,
                   const NeedsOptions& options, ThreadPool& pool, const Package* package = nullptr);

// Returns the LF images, pixels and LF cameras that one camera needs.
//   sampling  density of the LF cameras around the lens in the whole light field. Must be set if
//             `index` covers only a part of the light field; unset: measured in `index` if
//             options.HasNeighbours() is true
FrameNeeds NeedsOf(const ImageIndex& index, const RenderCamera& frame, const NeedsOptions& options,
                   ThreadPool& pool, const std::optional<FrameSampling>& sampling = {});

// Returns kInput if the frame reads pixels that a packed store does not keep (lfcompressor
// --needed-pixels). Missing or broken LF images are no error here.
//   store  must be opened in the same way as for rendering: with Mosaics::kToRgb if the estimator
//          is bilinear
Result<void> CheckKept(const LfImageStore& store, const LightField& light_field, FrameId frame,
                       const FrameNeeds& needs);

// Returns the error (kInput) for frames that no LF image contributes to. The message names only the
// first and the last of them.
//   frames  ascending; at least one
Error NoneContributes(std::span<const FrameId> frames);

}  // namespace lf
