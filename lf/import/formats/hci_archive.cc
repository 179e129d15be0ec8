// SPDX-License-Identifier: Apache-2.0
#include "lf/import/formats/hci_archive.h"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace lf {
namespace {

constexpr double kLargest = 1e9;

std::optional<double> ValueOf(const Hdf5Attributes& attributes, std::string_view key) {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::nullopt : std::optional(found->second);
}

// Checks the sizes that the file states twice.
Result<void> CheckSizes(const Hdf5Attributes& attributes, const ViewArray& array,
                        const std::string& name) {
  const struct {
    std::string_view key, what;
    int size;
  } sizes[] = {{"hRes", "columns of views", array.columns},
               {"vRes", "rows of views", array.rows},
               {"xRes", "columns of pixels", array.info.width},
               {"yRes", "rows of pixels", array.info.height},
               {"channels", "channels", array.info.channels}};
  for (const auto& size : sizes)
    if (const std::optional<double> stated = ValueOf(attributes, size.key);
        stated && *stated != size.size)
      return InputError(fmt::format(
          "{}: its attribute {} is {}, but its dataset has {} {}: correct the attribute, "
          "or save the array as a file of NumPy, which has none",
          name, size.key, *stated, size.size, size.what));
  return {};
}

// Returns a length; nullopt if it is not stated.
Result<std::optional<double>> Length(const Hdf5Attributes& attributes, std::string_view key,
                                     const std::string& name) {
  const std::optional<double> value = ValueOf(attributes, key);
  if (value && !(*value > 0 && *value <= kLargest))
    return InputError(fmt::format(
        "{}: its attribute {} is {}: expected above 0 and at most 1e9: give the distance "
        "between cameras by {{lfimport pitch}}",
        name, key, *value));
  return value;
}

}  // namespace

Result<HciArchive> HciArchiveOf(const Hdf5Attributes& attributes, const ViewArray& array,
                                const std::string& name) {
  LF_RETURN_IF_ERROR(CheckSizes(attributes, array, name));
  HciArchive archive;
  LF_ASSIGN_OR_RETURN(const std::optional<double> across, Length(attributes, "dH", name));
  LF_ASSIGN_OR_RETURN(const std::optional<double> down, Length(attributes, "dV", name));
  if (across) archive.pitch_w = Vec2(*across, down.value_or(*across));
  if (const std::optional<double> focal = ValueOf(attributes, "focalLength")) {
    // Lenses between 136 degrees across and a telescope. A focal length in millimetres or metres is
    // mostly a much smaller number.
    const double in_widths = *focal / array.info.width;
    (in_widths >= 0.2 && in_widths <= 100 ? archive.focal_px : archive.unclear_focal_length) =
        focal;
  }
  const std::optional<double> shift = ValueOf(attributes, "shift");
  if (shift && !(*shift >= 0 && *shift <= kLargest))
    return InputError(fmt::format(
        "{}: its attribute shift is {} pixels: expected 0 or more; give the depth of the "
        "plane that stands still by {{lfimport plane_distance}}",
        name, *shift));
  if (shift && archive.pitch_w && archive.focal_px) {
    const double plane_w = archive.pitch_w->x() * *archive.focal_px / *shift;
    if (plane_w > 0 && plane_w <= kLargest) archive.plane_distance_w = plane_w;
  }
  return archive;
}

}  // namespace lf
