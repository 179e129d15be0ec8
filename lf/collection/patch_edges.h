// Finds the positions where the scanlines of a patch of ideal positions cross edges. They are the
// ends of the accepted pixels, found without halving arcs. Internal to collection.
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
  // The answer for a scanline: pixels outside [begin, end] are not accepted, pixels inside
  // [sure_begin, sure_end] are accepted, and between them rounding may decide.
  struct Pixels {
    double begin, end;
    double sure_begin, sure_end;
  };

  // Forgets what was added. The patch must outlive its use here.
  void Begin(const IdealPatch& patch);

  // Adds the condition form <= 0.
  void AddForm(const PixelForm& form);

  // Adds a disk. Returns false, and adds nothing, if scanlines may cross its rim more than twice.
  bool AddDisk(const RowSpans::Disk& disk);

  // Returns the pixels of scanline y that all edges leave; none if that is not certain, because a
  // form both rises and falls, or an edge is crossed too slowly. Scanlines are best asked for from
  // top to bottom, because each search starts at the root of the one before.
  std::optional<Pixels> Find(int y);

 private:
  using Values = std::array<double, IdealPatch::kControls>;  // at a scanline's control points

  // A linear form at the control points of the patch.
  struct Grid {
    Grid(const PixelForm& form, const Hull& hull);
    Values Along(const BezierWeights& row) const;
    std::array<double, IdealPatch::kControls * IdealPatch::kControls> values;  // [row][column]
  };

  struct Form {
    Grid grid;
    double rounding;
    double root;  // root on the scanline before
  };

  struct Disk {
    Grid right, up, forward;
    double square_radius;
    double rounding;
    double roots[2];
  };

  // Parameters of a scanline, from 0 to 1.
  struct Span {
    double begin = 0;
    double end = 1;
    bool empty() const { return !(begin <= end); }
  };

  bool Narrow(const BezierWeights& row, Form* form, Span* span) const;
  bool Narrow(const BezierWeights& row, Disk* disk, Span* span) const;

  std::optional<Hull> hull_;
  double slack_ = 0;  // tolerance of roots
  const IdealPatch* patch_ = nullptr;
  std::vector<Form> forms_;
  std::optional<Disk> disk_;
};

}  // namespace lf
