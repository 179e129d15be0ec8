// SPDX-License-Identifier: Apache-2.0
// Finds the positions of a row (pixels of a scanline, or elements of a row of the plate) that
// fulfil linear conditions and the condition of a disk (doc/ray.md, "Spans"). Internal to
// collection.
#pragma once

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "lf/camera/ray_forms.h"
#include "lf/core/geometry.h"

namespace lf {

// Positions [first, second) of a row.
using RowSpan = std::pair<int, int>;

class RowSpans {
 public:
  // Interval [begin, end] of continuous coordinates along a row, in which position x is at x + 0.5.
  // Empty if end < begin.
  struct Interval {
    double begin = 0;
    double end = 0;
    bool empty() const { return !(begin <= end); }
  };

  // The condition right^2 + up^2 <= radius^2 forward^2 on the values of three linear forms. The
  // half-planes must fix the sign of `forward`, because the square does not show it.
  struct Disk {
    PixelForm right, up, forward;
    double radius = 0;
  };

  // There are two alternative sets of conditions, called sides, such as n.d < 0 and n.d > 0 for the
  // normal n of the focus plane and the direction d of a ray. A position p fulfils the conditions
  // of a side if form p <= 0 for all half-planes of the side, and if p is in the disk, unless there
  // is none. No position may fulfil the conditions of both sides.
  std::vector<PixelForm> half_planes[2];
  std::optional<Disk> disk;
  // True if the ray model (`accepted` of Find()) has more conditions than the half-planes and the
  // disk. It then tests the ends of every span, and a span with accepted ends is accepted as a
  // whole.
  bool model_decides = false;

  // Removes the conditions that are decided on all of `rect`: half-planes and a disk that hold
  // everywhere in it, and a side with a half-plane that holds nowhere in it. Afterwards, Find()
  // must be called only for positions in `rect`.
  void RestrictTo(const PixelRect& rect);

  // Finds the positions of [x_begin, x_end) in row y that fulfil the conditions and that the ray
  // model accepts. Replaces `spans` by the sorted result. It is exact if the accepted positions of
  // each side have no gap. It is also exact if a form is 0 along the whole row, because the ray
  // model then tests every position. The ray model is applied only where rounding may decide, and
  // to all ends of spans if model_decides is true.
  //   accepted(side, x)  returns true if the ray model accepts position x on this side
  template <class Accepted>
  void Find(int y, int x_begin, int x_end, const Accepted& accepted, std::vector<RowSpan>* spans);

 private:
  bool is_shut_[2] = {false, false};

  struct Candidate {
    int begin = 0;
    int end = 0;
    bool tie = false;  // true if rounding decides about every position
    Interval sure;     // positions where all half-planes hold in spite of rounding
  };
  bool IsSurelyInDisk(double centre_x, double centre_y) const;
  Candidate FindCandidate(int side, double centre_y, int x_begin, int x_end) const;
};

template <class Accepted>
void RowSpans::Find(int y, int x_begin, int x_end, const Accepted& accepted,
                    std::vector<RowSpan>* spans) {
  spans->clear();
  for (const int side : {0, 1}) {
    if (is_shut_[side]) continue;
    auto [begin, end, tie, sure] = FindCandidate(side, y + 0.5, x_begin, x_end);
    const auto is_accepted = [&, sure = sure](int x) {  // clang < 16 cannot capture `sure` itself
      const bool is_sure = x + 0.5 > sure.begin && x + 0.5 < sure.end && !model_decides &&
                           (!disk || IsSurelyInDisk(x + 0.5, y + 0.5));
      return is_sure || accepted(side, x);
    };
    while (begin < end && !is_accepted(begin)) ++begin;
    while (begin < end && !is_accepted(end - 1)) --end;
    if (!tie && begin < end) spans->emplace_back(begin, end);
    for (int x = begin; tie && x < end;) {
      int stop = x;
      while (stop < end && accepted(side, stop)) ++stop;
      if (stop > x) spans->emplace_back(x, stop);
      x = stop + 1;
    }
  }
  // Each of the two sides has at most one span, unless rounding decides about its positions (tie).
  if (spans->size() > 1) std::sort(spans->begin(), spans->end());
}

}  // namespace lf
