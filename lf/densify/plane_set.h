// SPDX-License-Identifier: Apache-2.0
// The planes that are compared in a part of an image. Internal to this folder.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lf/densify/inverse_depths.h"

namespace lf {

// Runs of neighbouring planes, in ascending order. In memory, a plane is an entry. Two entries that
// are no planes stand between runs, so that a path of semi-global matching does not step from one
// run to the next as if they were neighbours.
class PlaneSet {
 public:
  struct Run {
    int first = 0;  // plane
    int count = 0;
    int entry = 0;  // of the first plane

    int End() const { return first + count; }
    int EntryOf(int plane) const { return entry + (plane - first); }
  };

  // Returns planes 0 ... planes - 1.
  static PlaneSet All(int planes);
  // Returns the marked planes and those in short gaps between them.
  //   marks  [plane]: 1 if the plane is in the set, otherwise 0; at least one is marked
  static PlaneSet Marked(std::span<const uint8_t> marks);

  std::span<const Run> runs() const { return runs_; }
  int entries() const { return runs_.back().entry + runs_.back().count; }
  bool operator==(const PlaneSet& other) const;

  // Returns the inverse depth of each entry; NaN for entries that are no planes.
  //   planes  number of planes that are evenly spaced over the range
  std::vector<float> Depths(const InverseDepths& range, int planes) const;
  // Returns the run of an entry that is a plane.
  const Run& RunAt(int entry) const;

 private:
  std::vector<Run> runs_;
};

}  // namespace lf
