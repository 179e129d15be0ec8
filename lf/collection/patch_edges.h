// SPDX-License-Identifier: Apache-2.0
// Finds where the scanlines of a patch of ideal positions cross the edges of lens and plate. The
// accepted pixels of a scanline end there, so that the scanline need not be halved to find them.
// Internal to collection.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lf/camera/ideal_pixels.h"
#include "lf/collection/patch_hull.h"
#include "lf/collection/row_spans.h"
#include "lf/core/geometry.h"

namespace lf {

class PatchEdges {
 public:
  // The accepted pixels of a scanline, where pixel x is at x: pixels outside [begin, end] are not
  // accepted, pixels inside [sure_begin, sure_end] are accepted, and rounding may decide about
  // pixels between these bounds.
  struct Pixels {
    double begin, end;
    double sure_begin, sure_end;
  };

  // Removes all conditions, and makes `patch` the current patch. The patch must outlive the calls
  // of Find().
  void Begin(const IdealPatch& patch);

  // Adds the condition that `form` is at most 0.
  void AddForm(const PixelForm& form);

  // Adds the condition of a disk. Returns false, and adds nothing, if scanlines may cross its rim
  // more than twice, or if disk.forward may be 0 or negative on the patch.
  bool AddDisk(const RowSpans::Disk& disk);

  // Returns the pixels of scanline y that fulfil all conditions; none if the search fails, because
  // a form may both rise and fall along the scanline, or because rounding hides where it crosses 0.
  // Calls are fastest for scanlines from top to bottom, because each search starts at the root on
  // the previous scanline.
  std::optional<Pixels> Find(int y);

 private:
  using Values =
      std::array<double, IdealPatch::kControls>;  // values of a form at a scanline's control points

  // The values of a linear form at the control points of the patch.
  struct Grid {
    Grid(const PixelForm& form, const Hull& hull);
    Values Along(const BezierWeights& row) const;
    std::array<double, size_t{IdealPatch::kControls} * IdealPatch::kControls>
        values;  // [row][column]
  };

  struct Form {
    Grid grid;
    double rounding;
    double root;  // root of the form on the previous scanline, in the parameter along it
  };

  struct Disk {
    Grid right, up, forward;
    double square_radius;
    double rounding;
    double roots[2];
  };

  // An interval of the parameter along a scanline, which runs from 0 to 1.
  struct Span {
    double begin = 0;
    double end = 1;
    bool empty() const { return !(begin <= end); }
  };

  bool Narrow(const BezierWeights& row, Form* form, Span* span) const;
  bool Narrow(const BezierWeights& row, Disk* disk, Span* span) const;

  std::optional<Hull> hull_;
  double slack_ = 0;  // tolerance of roots, in the parameter along a scanline
  const IdealPatch* patch_ = nullptr;
  std::vector<Form> forms_;
  std::optional<Disk> disk_;
};

}  // namespace lf
