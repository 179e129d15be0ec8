// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/focal_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "lf/camera/render_camera.h"
#include "lf/camera/testing_scenes.h"

namespace lf {
namespace {

std::vector<FocalPiece> FourPieces() {
  return {{{0, 0, 10, 20}, {0.001, 0, 0.2}},
          {{10, 0, 30, 20}, {0, 0.002, 0.3}},
          {{0, 20, 30, 30}, {0, 0, 0.4}},
          {{0, 30, 30, 40}, {-0.001, -0.001, 0.5}}};
}

TEST(FocalSurface, PiecesOfElementsAreFoundAndPositionsBeyondThePlateHaveTheNearest) {
  const auto surface = FocalSurface::Of(30, 40, FourPieces());
  ASSERT_TRUE(surface) << surface.error().message;
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 30; ++x)
      EXPECT_TRUE(surface->PieceAt(x + 0.5, y + 0.5).elements.Contains(x, y)) << x << " " << y;
  EXPECT_EQ(surface->PieceAt(-5, -1).elements, (PixelRect{0, 0, 10, 20}));
  EXPECT_EQ(surface->PieceAt(1e300, 3).elements, (PixelRect{10, 0, 30, 20}));
  EXPECT_EQ(surface->PieceAt(30, 40).elements, (PixelRect{0, 30, 30, 40}));
  EXPECT_EQ(surface->row_count(), 60u);
}

// The plate ends with a square of elements in which pieces are looked up.
TEST(FocalSurface, APositionRightOfThePlateHasThePieceOfItsRow) {
  const auto surface =
      FocalSurface::Of(32, 32, {{{0, 0, 32, 16}, {0, 0, 0.2}}, {{0, 16, 32, 32}, {0, 0, 0.3}}});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_EQ(surface->PieceAt(1e6, 3).At(0, 0), 0.2);
  EXPECT_EQ(surface->PieceAt(32, 1e6).At(0, 0), 0.3);
}

TEST(FocalSurface, BlocksBoundTheirPieces) {
  const auto surface = FocalSurface::Of(30, 40, FourPieces());
  ASSERT_TRUE(surface);
  EXPECT_LE(surface->blocks().size(), FocalSurface::kMostBlocks);
  long long covered = 0;
  for (const FocalBlock& block : surface->blocks()) {
    covered += block.elements.pixel_count();
    for (int y = block.elements.y_begin; y < block.elements.y_end; ++y)
      for (int x = block.elements.x_begin; x < block.elements.x_end; ++x) {
        const double q = surface->PieceAt(x, y).At(x + 0.5, y + 0.5);
        EXPECT_LE(block.q_low, q);
        EXPECT_GE(block.q_high, q);
      }
  }
  EXPECT_EQ(covered, 1200);
}

TEST(FocalSurface, ItsBytesAreReadBackExactlyAndDamageIsFound) {
  const auto surface = FocalSurface::Of(30, 40, FourPieces());
  ASSERT_TRUE(surface);
  const std::string bytes = surface->Bytes();
  const auto read = FocalSurface::FromBytes(bytes, 30, 40);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->Bytes(), bytes);
  EXPECT_EQ(read->Digest(), surface->Digest());
  EXPECT_FALSE(FocalSurface::FromBytes(bytes, 31, 40));
  EXPECT_FALSE(FocalSurface::FromBytes(bytes.substr(1), 30, 40));
  EXPECT_FALSE(FocalSurface::FromBytes(bytes.substr(40), 30, 40));
  EXPECT_FALSE(FocalSurface::FromBytes("", 30, 40));
}

TEST(FocalSurface, PiecesMustCoverThePlateOnceAndStayInFrontOfTheLens) {
  const auto error_of = [](const std::vector<FocalPiece>& pieces) {
    const auto surface = FocalSurface::Of(30, 40, pieces);
    return surface ? std::string() : surface.error().message;
  };
  std::vector<FocalPiece> pieces = FourPieces();
  pieces[1].elements.x_begin = 9;
  EXPECT_NE(error_of(pieces).find("overlap"), std::string::npos) << error_of(pieces);
  pieces = FourPieces();
  pieces[1].elements.x_begin = 11;
  EXPECT_NE(error_of(pieces).find("covers"), std::string::npos) << error_of(pieces);
  pieces = FourPieces();
  pieces[1].elements.x_end = 31;
  EXPECT_NE(error_of(pieces).find("not within"), std::string::npos) << error_of(pieces);
  for (const double q : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                         std::numeric_limits<double>::infinity()}) {
    pieces = FourPieces();
    pieces[2].inverse_depth.z() = q;
    EXPECT_NE(error_of(pieces).find("behind the lens"), std::string::npos) << error_of(pieces);
  }
}

TEST(FocalSurface, FocusPointsOfACameraAreOnThePlanesOfItsPieces) {
  RenderCamera camera = testing::ParallelPair(0, 0, 0.1, 0.2).render_camera;
  camera.pinhole.cam_from_world =
      *LookAlong({0.3, -0.2, 0.4}, Vec3(0.1, 0.2, 1).normalized(), Vec3(0, -1, 0));
  Intrinsics& k = camera.pinhole.intrinsics;
  const auto surface = FocalSurface::Of(k.width_px, k.height_px,
                                        {{{0, 0, k.width_px, k.height_px}, {1e-4, -2e-4, 0.4}}});
  ASSERT_TRUE(surface) << surface.error().message;
  const FocalPiece& piece = surface->pieces()[0];
  camera.surface = std::make_shared<const FocalSurface>(*surface);
  const Plane plane = PlaneOfPiece(camera.pinhole, piece);
  EXPECT_NEAR(plane.normal.norm(), 1, 1e-12);
  for (const double y : {0.0, 7.5, 40.0})
    for (const double x : {0.0, 3.25, 60.0}) {
      const auto point = FocusPointOfElement(camera, x, y);
      ASSERT_TRUE(point);
      EXPECT_NEAR(plane.normal.dot(*point), plane.offset_w, 1e-9);
      const Vec3 in_camera = camera.pinhole.cam_from_world * *point;
      EXPECT_NEAR(1 / in_camera.z(), piece.At(x, y), 1e-12);
    }
  int count = 0;
  ForEachPiece(camera, [&](const RenderCamera& of_piece) {
    ++count;
    EXPECT_FALSE(of_piece.surface);
    EXPECT_EQ(ElementsOf(of_piece), piece.elements);
    EXPECT_NEAR((of_piece.focus_plane.normal - plane.normal).norm(), 0, 1e-15);
  });
  EXPECT_EQ(count, 1);
}

}  // namespace
}  // namespace lf
