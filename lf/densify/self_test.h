// SPDX-License-Identifier: Apache-2.0
// Tells from recorded LF images how right virtual ones are.
#pragma once

#include <string>
#include <vector>

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/densify_plan.h"
#include "lf/densify/watched_loop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// A recorded LF image and the virtual one at its place, made without it.
struct LeftOut {
  std::string name;
  double virtual_psnr_db = 0;
  // The best that the same LF images reach without depths: their mean, aligned at one of several
  // depths.
  double blend_psnr_db = 0;
  // Angle between its ray to the middle of the scene and theirs, weighted as their colours are.
  double angle_deg = 0;
  // True: it was made of LF images on one side of it, so that it tells how right virtual LF images
  // beyond the recorded ones are.
  bool is_beyond = false;
  double GainDb() const { return virtual_psnr_db - blend_psnr_db; }
};

// The least median gain of a light field that can be densified. Wrong poses, and depths that are
// not found, leave no gain.
inline constexpr double kLeastGainDb = 1.5;

// From this median on, virtual LF images that are not worse than the mean may fill the lenses of a
// film.
inline constexpr double kRightDb = 30;

// From this median on, virtual LF images are about as right as pixels can tell. So is a mean that
// they hardly exceed.
inline constexpr double kNearlyRightDb = 36;

// Leaves out up to eight of the sources of virtual LF images in turn, spread over them, and
// compares each with the virtual LF image that is made of its neighbours; both are reduced to about
// 200 pixels, smoothed and compared where something is to be seen. The distances between LF cameras
// are therefore larger than they will be. LF images on the hull of the LF cameras are not tested,
// because none surround them. If fewer than four are inside it, as in a row, those between two
// others are tested. Empty if there are none. If virtual LF cameras stand beyond the recorded ones,
// up to four LF images are also made of those on one side of them. Errors of LoadWorkingImage();
// kInterrupted.
Result<std::vector<LeftOut>> TestByLeavingOut(const LightField& light_field,
                                              const LfImageStore& store, const DensifyPlan& plan,
                                              ThreadPool& pool, const Watch& watch = {});

// Returns the tests of one kind.
std::vector<LeftOut> TestsOf(const std::vector<LeftOut>& tests, bool is_beyond);

double MedianPsnrDb(const std::vector<LeftOut>& tests);
double MedianGainDb(const std::vector<LeftOut>& tests);

}  // namespace lf
