#include "lf/selection/ideal_cells.h"

#include <algorithm>
#include <optional>

namespace lf {
namespace {

constexpr int kCellsAlong = 24;

IdealCell BoundCell(const Intrinsics& k, const DistortionMap& map, const PixelRect& rect) {
  IdealCell cell;
  cell.rect = rect;
  Vec3 q[3][3];
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const std::optional<Vec3> position = IdealPosition(
          k, map, rect.x_begin + 0.5 * i * rect.width(), rect.y_begin + 0.5 * j * rect.height());
      if (!position) return cell;
      q[j][i] = *position;
    }
  Vec3 low = q[0][0], high = q[0][0], bend = Vec3::Zero();
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      low = low.cwiseMin(q[j][i]);
      high = high.cwiseMax(q[j][i]);
    }
  for (int i = 0; i < 3; ++i) {
    bend = bend.cwiseMax((q[i][0] - 2 * q[i][1] + q[i][2]).cwiseAbs());
    bend = bend.cwiseMax((q[0][i] - 2 * q[1][i] + q[2][i]).cwiseAbs());
  }
  bend = bend.cwiseMax((q[0][0] - q[0][2] - q[2][0] + q[2][2]).cwiseAbs());
  constexpr double kRounding = 1e-9;
  cell.middle = 0.5 * (low + high);
  cell.extent = 0.5 * (high - low) + 2 * bend + kRounding * cell.middle.cwiseAbs();
  cell.has_bounds = true;
  return cell;
}

}  // namespace

std::vector<IdealCell> MakeIdealCells(const Intrinsics& k) {
  const DistortionMap map(k.distortion);
  const int side = std::max(8, (std::max(k.width_px, k.height_px) + kCellsAlong - 1) / kCellsAlong);
  std::vector<IdealCell> cells;
  for (int y = 0; y < k.height_px; y += side)
    for (int x = 0; x < k.width_px; x += side)
      cells.push_back(BoundCell(
          k, map, {x, y, std::min(k.width_px, x + side), std::min(k.height_px, y + side)}));
  return cells;
}

}  // namespace lf
