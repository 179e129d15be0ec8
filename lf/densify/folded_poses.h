// SPDX-License-Identifier: Apache-2.0
// Finds LF images whose pictures contradict each other, because their poses are wrong.
//
// If a thing looks the same from two sides, a reconstruction may put the LF cameras of both sides
// at the same places (folded poses). Each LF camera then agrees with those of its own side, and not
// with others that stand as near.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

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
// group; small groups are left out. Two groups contradict each other if a quarter of the LF images
// of the smaller one disagree clearly with one of the other group that is as near as those that
// agree. There is no verdict if LF images usually reach less than 0.15.
//   count  number of LF images
std::vector<std::vector<uint32_t>> ContradictingGroups(size_t count,
                                                       std::span<const ComparedPair> pairs);

// Returns the message for the user: the groups, and how to divide the light field.
//   source  LIGHTFIELD and its options, as the user gave them, for the commands of the message
std::string ContradictionText(const LightField& light_field,
                              std::span<const std::vector<uint32_t>> groups,
                              std::span<const std::string> source);

}  // namespace lf
