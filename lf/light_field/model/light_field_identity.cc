// SPDX-License-Identifier: Apache-2.0
#include "lf/light_field/model/light_field_identity.h"

#include "lf/light_field/model/value_hasher.h"

namespace lf {

LightFieldIdentity IdentityOf(const LightField& light_field) {
  ValueHasher names;
  for (const std::string& name : light_field.image_names) names.Add(name);
  for (const std::string& name : light_field.mask_names) names.Add(name);
  ValueHasher calibration;
  for (const LfCamera& camera : light_field.cameras) {
    calibration.Add(camera.cam_from_world);
    calibration.Add(static_cast<double>(camera.intrinsics_index));
    calibration.Add(camera.gain[0]);
    if (!camera.gain.are_equal())
      for (const float gain : camera.gain.of_channels) calibration.Add(gain);
    // Only the mark is hashed, so that light fields without virtual LF images keep their hash.
    if (camera.is_virtual) calibration.Add(std::string("virtual"));
  }
  // The times are hashed only where frames depend on them, so that other light fields keep their
  // hash.
  if (light_field.slice_times.size() > 1)
    for (const double time : light_field.times) calibration.Add(time);
  for (const Intrinsics& k : light_field.intrinsics) calibration.Add(k);
  return {light_field.size(), names.Text(), calibration.Text()};
}

}  // namespace lf
