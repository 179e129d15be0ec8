// Finds the positions of a row that fulfil linear conditions and the condition of a disk
// (doc/ray.md, "Spans"). Internal to collection.
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
  // Real interval of positions, [begin, end]. Empty if end < begin.
  struct Interval {
    double begin = 0;
    double end = 0;
    bool empty() const { return !(begin <= end); }
  };

  // right^2 + up^2 <= radius^2 forward^2. Applies only where half-planes fix the sign of forward.
  struct Disk {
    PixelForm right, up, forward;
    double radius = 0;
  };

  // The two sides exclude each other. On a side, form p <= 0 must hold for all of its forms.
  std::vector<PixelForm> half_planes[2];
  std::optional<Disk> disk;
  // The ray model knows more than these conditions, and decides for a whole span at its ends.
  bool model_decides = false;

  // Removes what is decided on all of `rect`: half-planes and a disk that hold there, and a side on
  // which a half-plane does not. Only rows of `rect` may be asked for afterwards.
  void RestrictTo(const PixelRect& rect);

  // Finds the positions of [x_begin, x_end) in row y that fulfil the conditions and that the ray
  // model accepts. The spans are sorted. They are exact if accepted positions of a side have gaps
  // only where a form stays at 0. The ray model is asked where rounding might decide, or for all
  // ends if model_decides.
  //   accepted(side, x)  asks the ray model
  template <class Accepted>
  void Find(int y, int x_begin, int x_end, const Accepted& accepted, std::vector<RowSpan>* spans);

 private:
  bool is_shut_[2] = {false, false};

  struct Candidate {
    int begin = 0;
    int end = 0;
    bool tie = false;  // rounding decides every position
    Interval sure;     // positions where rounding decides nothing
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
    const auto is_accepted = [&, sure = sure](int x) {  // copied for clang before 16
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
  // There are at most two sides, with one span each unless there are ties.
  if (spans->size() > 1) std::sort(spans->begin(), spans->end());
}

}  // namespace lf
