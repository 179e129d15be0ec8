// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/focal_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "lf/core/hash.h"

namespace lf {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers in Bytes() are little-endian");

// A piece in Bytes().
struct StoredPiece {
  std::array<int32_t, 4> elements;
  std::array<double, 3> inverse_depth;
};
static_assert(sizeof(StoredPiece) == 40);

struct Bounded {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

// Returns the bounds of the inverse depths in a piece, which it has at its corners.
Bounded InverseDepthsOf(const FocalPiece& piece) {
  Bounded bounds;
  const PixelRect& r = piece.elements;
  for (const int y : {r.y_begin, r.y_end})
    for (const int x : {r.x_begin, r.x_end}) {
      const double q = piece.At(x, y);
      if (!std::isfinite(q)) return {-1, q};
      bounds.low = std::min(bounds.low, q);
      bounds.high = std::max(bounds.high, q);
    }
  return bounds;
}

std::string TextOf(const PixelRect& r) {
  return fmt::format("[{}, {}) x [{}, {})", r.x_begin, r.x_end, r.y_begin, r.y_end);
}

}  // namespace

// With e = (x, y, 1) = K X / Z for a point X of depth Z in axes of the camera, 1 = q(e) Z is
// v . K X = 1 for v = inverse_depth, a plane with the normal K^T v.
Plane PlaneOfPiece(const PinholeCamera& camera, const FocalPiece& piece) {
  const Vec3 normal_camera = camera.intrinsics.Matrix().transpose() * piece.inverse_depth;
  const RigidTransform& pose = camera.cam_from_world;
  const double length = normal_camera.norm();
  return {pose.rotation.transpose() * normal_camera / length,
          (1 - normal_camera.dot(pose.translation)) / length};
}

Result<FocalSurface> FocalSurface::Of(int width_px, int height_px, std::vector<FocalPiece> pieces) {
  FocalSurface surface;
  surface.width_px_ = width_px;
  surface.height_px_ = height_px;
  if (pieces.empty() || pieces.size() > kMostPieces)
    return InputError(
        fmt::format("a focal surface of {} pieces; expected 1 to {}", pieces.size(), kMostPieces));
  const PixelRect plate{0, 0, width_px, height_px};
  surface.cell_columns_ = (width_px + kCell - 1) / kCell;
  const int cell_rows = (height_px + kCell - 1) / kCell;
  std::vector<std::vector<uint32_t>> of_cells(static_cast<size_t>(surface.cell_columns_) *
                                              static_cast<size_t>(cell_rows));
  long long covered = 0;
  for (size_t i = 0; i < pieces.size(); ++i) {
    const PixelRect& r = pieces[i].elements;
    if (r.empty() || Intersection(r, plate) != r)
      return InputError(fmt::format("a piece {} of a focal surface is not within {} x {} elements",
                                    TextOf(r), width_px, height_px));
    const Bounded q = InverseDepthsOf(pieces[i]);
    if (!(q.low > 0) || !std::isfinite(q.high))
      return InputError(fmt::format(
          "a piece {} of a focal surface reaches behind the lens or to infinity", TextOf(r)));
    covered += r.pixel_count();
    surface.row_count_ += static_cast<size_t>(r.height());
    for (int row = r.y_begin / kCell; row <= (r.y_end - 1) / kCell; ++row)
      for (int column = r.x_begin / kCell; column <= (r.x_end - 1) / kCell; ++column) {
        std::vector<uint32_t>& cell =
            of_cells[static_cast<size_t>(row) * static_cast<size_t>(surface.cell_columns_) +
                     static_cast<size_t>(column)];
        for (const uint32_t other : cell)
          if (!Intersection(r, pieces[other].elements).empty())
            return InputError(fmt::format("pieces {} and {} of a focal surface overlap", TextOf(r),
                                          TextOf(pieces[other].elements)));
        cell.push_back(static_cast<uint32_t>(i));
      }
  }
  if (covered != plate.pixel_count())
    return InputError(
        fmt::format("a focal surface covers {} of {} elements", covered, plate.pixel_count()));
  for (const std::vector<uint32_t>& cell : of_cells) {
    surface.cell_begin_.push_back(static_cast<uint32_t>(surface.pieces_of_cells_.size()));
    surface.pieces_of_cells_.insert(surface.pieces_of_cells_.end(), cell.begin(), cell.end());
  }
  surface.cell_begin_.push_back(static_cast<uint32_t>(surface.pieces_of_cells_.size()));
  surface.pieces_ = std::move(pieces);
  surface.SetBlocks();
  return surface;
}

void FocalSurface::SetBlocks() {
  constexpr int kAlongSide = 8;
  static_assert(kMostBlocks == size_t{kAlongSide} * kAlongSide);
  const auto border = [](int i, int size) {
    return static_cast<int>(static_cast<int64_t>(size) * i / kAlongSide);
  };
  std::vector<FocalBlock> blocks;
  for (int j = 0; j < kAlongSide; ++j)
    for (int i = 0; i < kAlongSide; ++i)
      blocks.push_back({{border(i, width_px_), border(j, height_px_), border(i + 1, width_px_),
                         border(j + 1, height_px_)},
                        std::numeric_limits<double>::infinity(),
                        0});
  for (const FocalPiece& piece : pieces_) {
    const Bounded q = InverseDepthsOf(piece);
    const PixelRect& r = piece.elements;
    const auto first = [](int begin, int size) {
      return static_cast<int>(static_cast<int64_t>(begin) * kAlongSide / size);
    };
    for (int j = first(r.y_begin, height_px_); j < kAlongSide; ++j)
      for (int i = first(r.x_begin, width_px_); i < kAlongSide; ++i) {
        FocalBlock& block = blocks[static_cast<size_t>(j) * kAlongSide + static_cast<size_t>(i)];
        if (block.elements.x_begin >= r.x_end || block.elements.y_begin >= r.y_end) break;
        if (Intersection(block.elements, r).empty()) continue;
        block.q_low = std::min(block.q_low, q.low);
        block.q_high = std::max(block.q_high, q.high);
      }
  }
  // A plate with fewer than 8 rows or columns has empty blocks.
  std::erase_if(blocks, [](const FocalBlock& block) { return block.elements.empty(); });
  blocks_ = std::move(blocks);
}

const FocalPiece& FocalSurface::PieceAt(double x_px, double y_px) const {
  // Written so that NaN becomes 0.
  const auto element = [](double position, int size) {
    return position > 0 ? static_cast<int>(std::min(position, static_cast<double>(size - 1))) : 0;
  };
  const int x = element(x_px, width_px_), y = element(y_px, height_px_);
  const size_t cell = static_cast<size_t>(y / kCell) * static_cast<size_t>(cell_columns_) +
                      static_cast<size_t>(x / kCell);
  size_t i = cell_begin_[cell];
  while (i + 1 < cell_begin_[cell + 1] && !pieces_[pieces_of_cells_[i]].elements.Contains(x, y))
    ++i;
  return pieces_[pieces_of_cells_[i]];
}

std::string FocalSurface::Bytes() const {
  std::string bytes(pieces_.size() * sizeof(StoredPiece), '\0');
  for (size_t i = 0; i < pieces_.size(); ++i) {
    const PixelRect& r = pieces_[i].elements;
    const Vec3& v = pieces_[i].inverse_depth;
    const StoredPiece stored{{r.x_begin, r.y_begin, r.x_end, r.y_end}, {v.x(), v.y(), v.z()}};
    std::memcpy(bytes.data() + i * sizeof(StoredPiece), &stored, sizeof(StoredPiece));
  }
  return bytes;
}

Result<FocalSurface> FocalSurface::FromBytes(std::string_view bytes, int width_px, int height_px) {
  if (bytes.size() % sizeof(StoredPiece) != 0)
    return InputError(fmt::format("a focal surface of {} bytes; expected a multiple of {}",
                                  bytes.size(), sizeof(StoredPiece)));
  if (bytes.size() / sizeof(StoredPiece) > kMostPieces)
    return InputError(fmt::format("a focal surface of more than {} pieces", kMostPieces));
  std::vector<FocalPiece> pieces(bytes.size() / sizeof(StoredPiece));
  for (size_t i = 0; i < pieces.size(); ++i) {
    StoredPiece stored;
    std::memcpy(&stored, bytes.data() + i * sizeof(StoredPiece), sizeof(StoredPiece));
    const auto& [elements, depth] = stored;
    pieces[i] = {{elements[0], elements[1], elements[2], elements[3]},
                 {depth[0], depth[1], depth[2]}};
  }
  return Of(width_px, height_px, std::move(pieces));
}

std::string FocalSurface::Digest() const { return fmt::format("{:016x}", HashBytes(Bytes())); }

}  // namespace lf
