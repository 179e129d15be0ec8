// SPDX-License-Identifier: Apache-2.0
// The settings of a film (lf/render/settings/setting_table.h) as Python's keyword arguments.
#pragma once

#include <pybind11/pybind11.h>

#include <map>
#include <string>

#include "lf/core/result.h"
#include "lf/render/settings/film_settings.h"

namespace lf::python {

// Values by keys, as the texts of the table.
using SettingWords = std::map<std::string, std::string>;

// Returns the settings of a film. Frames get an opacity, for Frame.save(), which may give files
// alpha. kUsage: a text is no value of its setting; the message names the argument.
Result<FilmSettings> FilmSettingsOf(const SettingWords& words);

// Lets messages name options as arguments (lf/core/spelling.h). Adds settings(), which returns the
// rows of the table that are arguments, and texts_of_settings(), which returns the texts of all
// settings after some were set.
void AddSettings(pybind11::module_& module);

}  // namespace lf::python
