// SPDX-License-Identifier: Apache-2.0
// Rotates and mirrors pictures as their orientation tag says, if the tag exchanges width and
// height.
#pragma once

#include "lf/core/check.h"
#include "lf/core/geometry.h"
#include "lf/core/image.h"

namespace lf {

// Returns true if the tag (EXIF orientation, 1 to 8) exchanges width and height.
inline bool TurnsByQuarter(int orientation) { return orientation >= 5 && orientation <= 8; }

// Returns the picture as a viewer shows it, for the tags that exchange width and height:
//   5 mirrored at the diagonal from the upper left to the lower right, 6 turned clockwise,
//   7 mirrored at the other diagonal, 8 turned counter-clockwise (EXIF 2.3, 4.6.4)
template <class T>
Image<T> Upright(const Image<T>& stored, int orientation) {
  LF_CHECK(TurnsByQuarter(orientation));
  const int width = stored.height(), height = stored.width(), channels = stored.channels();
  Image<T> upright(width, height, channels);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int stored_x = orientation <= 6 ? y : height - 1 - y;
      const int stored_y = orientation == 5 || orientation == 8 ? x : width - 1 - x;
      for (int c = 0; c < channels; ++c) upright.at(x, y, c) = stored.at(stored_x, stored_y, c);
    }
  return upright;
}

// Returns the part of the stored picture that shows `rect` of the upright picture. `width` and
// `height` are those of the stored picture.
inline PixelRect StoredRect(const PixelRect& rect, int width, int height, int orientation) {
  LF_CHECK(TurnsByQuarter(orientation));
  PixelRect stored = {rect.y_begin, rect.x_begin, rect.y_end, rect.x_end};
  if (orientation > 6) {
    stored.x_begin = width - rect.y_end;
    stored.x_end = width - rect.y_begin;
  }
  if (orientation == 6 || orientation == 7) {
    stored.y_begin = height - rect.x_end;
    stored.y_end = height - rect.x_begin;
  }
  return stored;
}

// Returns the part of the upright picture that shows `rect` of the stored picture. `width` and
// `height` are those of the stored picture.
inline PixelRect UprightRect(const PixelRect& rect, int width, int height, int orientation) {
  LF_CHECK(TurnsByQuarter(orientation));
  PixelRect upright = {rect.y_begin, rect.x_begin, rect.y_end, rect.x_end};
  if (orientation > 6) {
    upright.y_begin = width - rect.x_end;
    upright.y_end = width - rect.x_begin;
  }
  if (orientation == 6 || orientation == 7) {
    upright.x_begin = height - rect.y_end;
    upright.x_end = height - rect.y_begin;
  }
  return upright;
}

}  // namespace lf
