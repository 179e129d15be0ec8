// SPDX-License-Identifier: Apache-2.0
// A view of a display, as the user's configuration of OpenColorIO defines it: converts linear light
// to the values of PNG frames, in place of the sRGB curve.
#pragma once

#include <memory>
#include <string>

#include "lf/core/image.h"
#include "lf/core/result.h"

namespace lf {

class DisplayView {
 public:
  virtual ~DisplayView() = default;

  // Opens a view of the configuration that the environment variable OCIO names. The configuration
  // must say what linear light is: by the role aces_interchange, or by a colour space that has one
  // of the usual names of linear Rec. 709.
  //   display  empty: the default display of the configuration
  // kUsage: OCIO is not set; the configuration has no such display or view, or does not say what
  // linear light is; the program was built without OpenColorIO. kInput: the configuration cannot be
  // read.
  static Result<std::shared_ptr<const DisplayView>> Open(const std::string& display,
                                                         const std::string& view);

  // Converts linear light [height][width][3] of kRec709 to display values. May be called by many
  // threads at once.
  virtual void Apply(Image<float>* rgb) const = 0;
  // Display, view and a hash of the configuration. Views with equal identities give equal values.
  virtual const std::string& identity() const = 0;
  // True if the values are those of an sRGB display, as far as the names in the configuration tell.
  virtual bool is_srgb() const = 0;
};

}  // namespace lf
