// SPDX-License-Identifier: Apache-2.0
// A picture in the opening of the lens: how much light each of its places lets through. It gives
// out-of-focus lights any shape, and soft edges.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "lf/camera/aperture.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

// The picture is the square around the circle of Aperture::radius_w. The photographer behind the
// camera sees it upright. It turns with the blades and is squeezed with the opening, and only its
// part within the opening counts.
class Transmission {
 public:
  // Finer pictures are reduced, because a lens holds far fewer than 64 x 64 LF cameras.
  static constexpr int kMostSide = 64;

  // Returns a transmission of a picture of any size and shape. A picture that is no square is
  // centred in a dark one. Blocks of pixels become their mean if a side exceeds kMostSide.
  //   shares  [height][width][1]: 0 lets no light through, 255 all of it. Linear: half the value is
  //           half the light
  // kInput: the picture is empty, or wholly dark within the circle.
  static Result<Transmission> Of(const Image<uint8_t>& shares);

  // Text() returns the picture as rows of two hexadecimal digits for each place, with a '/' between
  // rows, from the upper left place on: "00ff/ff00". FromText() reads it; kInput: the text does not
  // have this form, its rows are no square of at most kMostSide, or the picture is wholly dark.
  std::string Text() const;
  static Result<Transmission> FromText(std::string_view text);

  // Number of places across and down.
  int side() const { return shares_.width(); }
  // Returns the share of the light that a place lets through, times 255.
  int Share(int column, int row) const { return shares_.at(column, row); }
  // Mean of all places, from 0 to 1.
  double Mean() const;

  bool operator==(const Transmission& other) const { return Text() == other.Text(); }

 private:
  explicit Transmission(Image<uint8_t> shares) : shares_(std::move(shares)) {}
  Image<uint8_t> shares_;  // [side][side]
};

using TransmissionPtr = std::shared_ptr<const Transmission>;
// Returns true if both are null or equal.
bool AreEqual(const TransmissionPtr& a, const TransmissionPtr& b);

// Converts lens coordinates to continuous coordinates of the picture, from 0 to side; both are
// linear in the point.
struct TransmissionAxes {
  TransmissionAxes(const Transmission& transmission, const Aperture& aperture);
  double Column(const Vec2& point_lens) const { return across.dot(point_lens) + middle; }
  double Row(const Vec2& point_lens) const { return down.dot(point_lens) + middle; }
  Vec2 across;
  Vec2 down;
  double middle;
};

// Returns the share of the light, from 0 to 1, that the lens lets through at a point; 0 outside of
// the picture. Does not test whether the point is in the opening.
double LightThrough(const Transmission& transmission, const Aperture& aperture,
                    const Vec2& point_lens);

}  // namespace lf
