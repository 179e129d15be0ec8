// Pictures turned as their orientation tag says.
#pragma once

#include "lf/core/check.h"
#include "lf/core/image.h"

namespace lf {

// Whether the tag (EXIF orientation, 1 to 8) exchanges width and height.
inline bool TurnsByQuarter(int orientation) { return orientation >= 5 && orientation <= 8; }

// The picture as a viewer shows it, for the tags that exchange width and height:
//   5 mirrored at the diagonal, 6 turned clockwise, 7 mirrored at the other diagonal,
//   8 turned counter-clockwise (EXIF 2.3, 4.6.4)
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

}  // namespace lf
