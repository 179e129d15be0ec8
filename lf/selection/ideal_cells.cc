// SPDX-License-Identifier: Apache-2.0
#include "lf/selection/ideal_cells.h"

#include <algorithm>
#include <optional>

namespace lf {
namespace {

constexpr int kCellsAlong = 24;

// Ideal positions of the corners, the middles of the sides and the middles of all cells. Cells
// share the positions on their borders, because finding a position takes long.
class Positions {
 public:
  Positions(const Intrinsics& k, int side)
      : xs_(Coordinates(k.width_px, side)), ys_(Coordinates(k.height_px, side)) {
    const DistortionMap map(k.distortion);
    for (const double y : ys_)
      for (const double x : xs_) positions_.push_back(IdealPosition(k, map, x, y));
  }

  // Position (i, j) of cell (column, row), where i and j are 0, 1 or 2.
  const std::optional<Vec3>& At(int column, int row, int i, int j) const {
    return positions_[(2 * static_cast<size_t>(row) + j) * xs_.size() + 2 * column + i];
  }

 private:
  // Returns the beginning and the middle of each cell along an axis, and the end of the last one.
  static std::vector<double> Coordinates(int size_px, int side) {
    std::vector<double> coordinates;
    for (int begin = 0; begin < size_px; begin += side) {
      coordinates.push_back(begin);
      coordinates.push_back(begin + 0.5 * (std::min(size_px, begin + side) - begin));
    }
    coordinates.push_back(size_px);
    return coordinates;
  }

  std::vector<double> xs_, ys_;
  std::vector<std::optional<Vec3>> positions_;  // [y][x]
};

IdealCell BoundCell(const Positions& positions, int column, int row, const PixelRect& rect) {
  IdealCell cell;
  cell.rect = rect;
  Vec3 q[3][3];
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const std::optional<Vec3>& position = positions.At(column, row, i, j);
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
  const int side = std::max(8, (std::max(k.width_px, k.height_px) + kCellsAlong - 1) / kCellsAlong);
  const Positions positions(k, side);
  std::vector<IdealCell> cells;
  for (int y = 0; y < k.height_px; y += side)
    for (int x = 0; x < k.width_px; x += side)
      cells.push_back(
          BoundCell(positions, x / side, y / side,
                    {x, y, std::min(k.width_px, x + side), std::min(k.height_px, y + side)}));
  return cells;
}

}  // namespace lf
