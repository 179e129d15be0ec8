// SPDX-License-Identifier: Apache-2.0
// How much of the light of all LF images an element of a guarded plate shows (develop.h). Internal
// to this folder.
#pragma once

#include "lf/film/develop/develop.h"
#include "lf/film/plate/sensor_plate.h"

namespace lf {

struct GuardShare {
  double densified = 0;  // DevelopedFrame::densified
  double trust = 1;      // DevelopedFrame::trust
  // True if the element is rather out of focus than in focus, and its trust is below
  // kDoubtfulTrust.
  bool is_doubtful = false;
};

// Returns the shares of element (x, y) of a guarded plate.
GuardShare GuardShareOf(const SensorPlate& plate, const DevelopOptions& options, int x, int y);

}  // namespace lf
