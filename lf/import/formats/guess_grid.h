// SPDX-License-Identifier: Apache-2.0
// Guesses how many views a picture holds, for advice. Internal to this folder.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "lf/core/image.h"
#include "lf/import/formats/picture_grid.h"

namespace lf {

// Returns the columns and rows that end the name of a picture, such as those of scene_5x5.png;
// nullopt for other names, and for fewer than 2 views.
std::optional<std::array<int, 2>> GridAtEndOfName(std::string_view file_name);

// Returns the columns and rows of views that lie side by side in a picture of one channel; nullopt
// if they are not certain. Neighbouring views are similar, so that the picture is similar to itself
// moved by the width of a view, and less so moved by less.
std::optional<std::array<int, 2>> FindTiles(const Image<float>& picture);

// Returns the columns and rows of views whose pixels are interleaved in a picture of one channel;
// nullopt if they are not certain. How similar a pixel is to one of the next ones depends on its
// place under the lenslet. Small mosaics may seem to be such pictures: ask FindTiles() before.
std::optional<std::array<int, 2>> FindLenslets(const Image<float>& picture);

// Returns true if the views of a picture with the name of a quilt are those of a grid of cameras
// instead of one row: the first views of two rows of the picture are more alike than the last view
// of the one and the first of the other, which are neighbours in a quilt.
bool HoldsGridOfCameras(const Image<float>& picture, const std::array<int, 2>& grid);

// Returns the grid of a picture that can be divided so: what the name states or, without that, what
// the pixels show. The name of a quilt counts, unless HoldsGridOfCameras(). nullopt if nothing is
// certain, and for files that cannot be read.
std::optional<PictureGrid> GuessPictureGrid(const std::filesystem::path& picture);

}  // namespace lf
