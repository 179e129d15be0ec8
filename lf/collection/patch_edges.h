// Where the scanlines of a patch of ideal positions cross edges: the ends of their accepted pixels,
// found without halving arcs. Internal to collection.
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
  // Of a scanline: pixels outside [begin, end] are not accepted, those inside [sure_begin,
  // sure_end] are; between, rounding may decide.
  struct Pixels {
    double begin, end;
    double sure_begin, sure_end;
  };

  // Forgets what was added; the patch has to last.
  void Begin(const IdealPatch& patch);

  // form <= 0
  void AddForm(const PixelForm& form);

  // False, and nothing is added, if scanlines may cross it more than twice.
  bool AddDisk(const RowSpans::Disk& disk);

  // What all edges leave of scanline y, from top to bottom by preference; none if that is not
  // certain: where forms both rise and fall, or edges are crossed too slowly.
  std::optional<Pixels> Find(int y);

 private:
  using Values = std::array<double, IdealPatch::kControls>;  // at the control points of a scanline

  // A linear form at the control points of the patch.
  struct Grid {
    Grid(const PixelForm& form, const Hull& hull);
    Values Along(const BezierWeights& row) const;
    std::array<double, IdealPatch::kControls * IdealPatch::kControls> values;  // [row][column]
  };

  struct Form {
    Grid grid;
    double rounding;
    double root;  // on the scanline before
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
  double slack_ = 0;  // of roots
  const IdealPatch* patch_ = nullptr;
  std::vector<Form> forms_;
  std::optional<Disk> disk_;
};

}  // namespace lf
