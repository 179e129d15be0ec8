// SPDX-License-Identifier: Apache-2.0
// The quilts that light field displays are given, by the tables of their maker.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lf/film/develop/view_layout.h"

namespace lf {

// A display, and the quilt for it. The tiles of a quilt need not have the aspect of the display:
// the maker squeezes views into them, and displays stretch them again.
struct QuiltDevice {
  const char* name;                 // "portrait"
  TileCounts grid;                  // of the quilt
  ViewSize quilt;                   // size that the maker states
  int aspect_width, aspect_height;  // of the display: width : height of what a view shows

  double aspect() const { return static_cast<double>(aspect_width) / aspect_height; }
  // Size of a tile: that of the quilt divided by its columns and rows, rounded down.
  ViewSize tile() const { return {quilt.width / grid.columns, quilt.height / grid.rows}; }
  // Size of the smallest view of the display's aspect that has the width and the height of a tile.
  ViewSize view() const;
};

// The settings of docs.lookingglassfactory.com, "Quilts", as of 2024.
std::span<const QuiltDevice> QuiltDevices();
// Returns the names of the devices: portrait, go, ...
std::vector<std::string> NamesOfQuiltDevices();
// Returns the device. The name must be one of NamesOfQuiltDevices().
const QuiltDevice& QuiltDeviceNamed(std::string_view name);

}  // namespace lf
