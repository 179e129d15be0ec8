// Which positions of a row fulfil conditions that are linear, or a circle's (doc/ray.md, "Spans").
// Internal to collection.
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
  // Real interval of positions, [begin, end]; empty if end < begin.
  struct Interval {
    double begin = 0;
    double end = 0;
    bool empty() const { return !(begin <= end); }
  };

  // right^2 + up^2 <= radius^2 forward^2, to be tried where half-planes keep the sign of forward.
  struct Disk {
    PixelForm right, up, forward;
    double radius = 0;
  };

  // The two sides exclude each other; on each, form p <= 0 for all.
  std::vector<PixelForm> half_planes[2];
  std::optional<Disk> disk;
  // The law knows more than these conditions, and decides at the ends for all between them.
  bool law_decides = false;

  // Leaves out what is decided all over `rect`: half-planes and a disk that hold there, and a side
  // on which a half-plane does not. For rows of `rect` only.
  void RestrictTo(const PixelRect& rect);

  // Those of [x_begin, x_end) in row y that the conditions let through and that the law accepts:
  // exact if accepted positions of a side have no gap but where a form stays at 0. Sorted. The law
  // is asked where rounding might decide, or for all ends if law_decides.
  //   accepted(side, x)  asks the law
  template <class Accepted>
  void Find(int y, int x_begin, int x_end, const Accepted& accepted, std::vector<RowSpan>* spans);

 private:
  bool is_shut_[2] = {false, false};

  struct Candidate {
    int begin = 0;
    int end = 0;
    bool tie = false;  // rounding decides every position
    Interval sure;     // it decides none
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
    const auto is_accepted = [&, sure = sure](int x) {  // the copy: for clang before 16
      const bool is_sure = x + 0.5 > sure.begin && x + 0.5 < sure.end && !law_decides &&
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
  // Two sides at most, one span each but for ties.
  if (spans->size() > 1) std::sort(spans->begin(), spans->end());
}

}  // namespace lf
