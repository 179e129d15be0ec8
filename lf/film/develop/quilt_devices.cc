// SPDX-License-Identifier: Apache-2.0
#include "lf/film/develop/quilt_devices.h"

#include <algorithm>
#include <array>

#include "lf/core/check.h"

namespace lf {
namespace {

// Names end with the size of the display in inches, and with its orientation if there are two.
constexpr std::array<QuiltDevice, 7> kDevices = {{
    {"portrait", {8, 6}, {3360, 3360}, 3, 4},
    {"go", {11, 6}, {4092, 4092}, 9, 16},
    {"16-landscape", {7, 7}, {5999, 5999}, 16, 9},
    {"16-portrait", {11, 6}, {5995, 6000}, 9, 16},
    {"32-landscape", {7, 7}, {8190, 8190}, 16, 9},
    {"32-portrait", {11, 6}, {8184, 8184}, 9, 16},
    {"65", {8, 9}, {8192, 8192}, 16, 9},
}};

// Returns a / b, rounded up.
int RatioUp(int a, int b) { return (a + b - 1) / b; }

}  // namespace

ViewSize QuiltDevice::view() const {
  const ViewSize cell = tile();
  return {std::max(cell.width, RatioUp(cell.height * aspect_width, aspect_height)),
          std::max(cell.height, RatioUp(cell.width * aspect_height, aspect_width))};
}

std::span<const QuiltDevice> QuiltDevices() { return kDevices; }

std::vector<std::string> NamesOfQuiltDevices() {
  std::vector<std::string> names;
  for (const QuiltDevice& device : kDevices) names.emplace_back(device.name);
  return names;
}

const QuiltDevice& QuiltDeviceNamed(std::string_view name) {
  const auto* const found =
      std::find_if(kDevices.begin(), kDevices.end(),
                   [name](const QuiltDevice& device) { return name == device.name; });
  LF_CHECK(found != kDevices.end());
  return *found;
}

}  // namespace lf
