// SPDX-License-Identifier: Apache-2.0
// A focal surface: the depth in which each element of one camera is in focus, in place of one focus
// plane. It consists of pieces of the plate, each with a focus plane of its own, so that rays and
// elements are still mapped by homographies (doc/ray.md, "Focal surface").
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/geometry.h"
#include "lf/core/result.h"

namespace lf {

// The elements of a rectangle, and the plane on which they are in focus: at the element position
// (x, y), the inverse of its depth along the optical axis is
//   q(x, y) = inverse_depth . (x, y, 1)                                    in 1 / world units.
struct FocalPiece {
  PixelRect elements;
  Vec3 inverse_depth = Vec3::UnitZ();

  double At(double x, double y) const {
    return inverse_depth.x() * x + inverse_depth.y() * y + inverse_depth.z();
  }
};

// Returns the focus plane of a piece of the camera's plate, in world coordinates.
Plane PlaneOfPiece(const PinholeCamera& camera, const FocalPiece& piece);

// Bounds of the inverse depths of some elements.
struct FocalBlock {
  PixelRect elements;
  double q_low = 0;   // > 0
  double q_high = 0;  // >= q_low
};

class FocalSurface {
 public:
  // Largest number of pieces of a surface.
  static constexpr size_t kMostPieces = size_t{1} << 20;

  // Makes a surface of pieces that cover each element of a plate of width x height elements exactly
  // once. kInput, without the name of a file: they do not, they are more than kMostPieces, or the
  // inverse depth is not above 0, or infinite, somewhere in a piece.
  static Result<FocalSurface> Of(int width_px, int height_px, std::vector<FocalPiece> pieces);

  // FromBytes() returns exactly the surface whose Bytes() it is given. kInput: the bytes describe
  // no surface of this plate.
  std::string Bytes() const;
  static Result<FocalSurface> FromBytes(std::string_view bytes, int width_px, int height_px);

  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }
  const std::vector<FocalPiece>& pieces() const { return pieces_; }
  // Returns the piece of an element position; positions beyond the plate have the piece of the
  // nearest element.
  const FocalPiece& PieceAt(double x_px, double y_px) const;
  // At most kMostBlocks rectangles that cover the plate, with the bounds of their pieces. A piece
  // that reaches over several blocks counts in each of them.
  const std::vector<FocalBlock>& blocks() const { return blocks_; }
  static constexpr size_t kMostBlocks = 64;
  // Number of rows of all pieces together.
  size_t row_count() const { return row_count_; }
  // Returns a hash of Bytes(), as 16 hexadecimal digits.
  std::string Digest() const;

 private:
  FocalSurface() = default;
  void SetBlocks();

  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<FocalPiece> pieces_;
  std::vector<FocalBlock> blocks_;
  size_t row_count_ = 0;
  // The pieces in each square of kCell x kCell elements, row by row: pieces_of_cells_[i] for i in
  // [cell_begin_[cell], cell_begin_[cell + 1]).
  static constexpr int kCell = 16;
  int cell_columns_ = 0;
  std::vector<uint32_t> cell_begin_;
  std::vector<uint32_t> pieces_of_cells_;
};

using FocalSurfacePtr = std::shared_ptr<const FocalSurface>;

}  // namespace lf
