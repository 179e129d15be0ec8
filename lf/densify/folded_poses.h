// SPDX-License-Identifier: Apache-2.0
// Finds LF images whose pictures contradict each other, because their poses are wrong.
//
// If a thing looks the same from two sides, a reconstruction may put the LF cameras of both sides
// at the same places (folded poses). Each LF camera then agrees with those of its own side, and not
// with others that stand as near.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/densify/inverse_depths.h"
#include "lf/densify/watched_loop.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/load/lf_image_store.h"

namespace lf {

// Two LF images that were compared.
struct ComparedPair {
  uint32_t first = 0, second = 0;
  double distance = 0;  // between the LF cameras
  // Share of the textured pixels of one LF image whose depth, found by comparing both, is
  // confirmed by the other one, where it shows a similar tone. The larger share of both.
  double agreeing_share = 0;
};

// Compares each of some LF images with the six of them whose LF cameras are nearest, reduced to
// about 100 pixels. Pairs with too little texture are left out.
//   ids    the LF images that are compared
//   range  of the scene
// Errors of LoadWorkingImage(); kInterrupted.
Result<std::vector<ComparedPair>> ComparePairs(const LightField& light_field,
                                               const LfImageStore& store,
                                               std::span<const uint32_t> ids,
                                               const InverseDepths& range, ThreadPool& pool,
                                               const Watch& watch = {});

// Returns groups of LF images that contradict each other, the largest first, each ascending; empty
// if there is no contradiction. A pair agrees if its share is at least 2/5 of what LF images
// usually reach with their best partner. LF images that are joined by pairs that agree make a
// group; groups of less than 3 LF images, or a tenth of those that were compared, are left out. Two
// groups contradict each other if a quarter of the LF images of the smaller one, and at least two,
// disagree clearly with one of the other group that is as near as those that
// agree. There is no verdict if LF images usually reach less than 0.15.
//   count  number of LF images
std::vector<std::vector<uint32_t>> ContradictingGroups(size_t count,
                                                       std::span<const ComparedPair> pairs);

// The group of which a film is made.
struct FilmGroup {
  size_t number = 0;  // its place among the groups, from 0
  double share = 0;   // of the nearness to the lenses of the film, 0 to 1
};

// Returns the group that stands in the lenses of a film; nullopt if none does clearly. In each
// frame, the eight LF cameras that its chart shows nearest to the middle of the lens have a
// nearness: it falls with the square of their distance, and a camera in the middle has 64 times
// that of the eighth. The group has at least 2/3 of all nearness in the mean over the frames, and
// at least half of it in every frame.
//   groups  ContradictingGroups(); LF images of no group count against all
//   frames  at least one
std::optional<FilmGroup> GroupOfFilm(const LightField& light_field,
                                     std::span<const std::vector<uint32_t>> groups,
                                     std::span<const RenderCamera> frames);

// Returns the message for the user if a film is made of one group: which LF images are left out,
// why, and how to film the other groups.
//   source  as that of ContradictionText()
std::string FilmGroupText(const LightField& light_field,
                          std::span<const std::vector<uint32_t>> groups, const FilmGroup& chosen,
                          std::span<const std::string> source);

// Returns the message for the user: the groups, and how to divide the light field.
//   source  LIGHTFIELD and its options, as the user gave them, for the commands of the message
std::string ContradictionText(const LightField& light_field,
                              std::span<const std::vector<uint32_t>> groups,
                              std::span<const std::string> source);

// Larger light fields are not compared. It would take minutes, and so many LF images are not
// reconstructed from photographs taken by hand.
inline constexpr size_t kMostChecked = 400;

struct Contradiction {
  std::string text;          // message for the user; "" if there is no contradiction
  std::vector<size_t> kept;  // LF images of which a film can be made, ascending; empty: none
  double share = 0;          // FilmGroup::share of these
};
// Compares the pairs of some LF images, as ComparePairs().
using PairSearch = std::function<Result<std::vector<ComparedPair>>(std::span<const uint32_t> ids)>;

// Looks for groups that contradict each other among some LF images. If there are any and there is a
// film, the others are compared as well and join the groups that they agree with, and the group of
// the film is chosen, if that is clear.
//   ids     those that are compared first
//   frames  of the film; empty: there is none
//   source  as that of ContradictionText()
Result<Contradiction> FindContradiction(const LightField& light_field,
                                        std::span<const uint32_t> ids,
                                        std::span<const RenderCamera> frames,
                                        std::span<const std::string> source,
                                        const PairSearch& search);

}  // namespace lf
