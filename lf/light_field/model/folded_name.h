// SPDX-License-Identifier: Apache-2.0
// Forms of file names that are compared in place of the names. Internal to this folder.
#pragma once

#include <string>
#include <string_view>

namespace lf {

// Returns the name in lower case and in Unicode's normal form C, so that names are equal that look
// alike: macOS writes "ü" as two characters (form D), most other programs as one (form C). Bytes of
// a name that is not UTF-8 stay, but for the case of ASCII letters.
std::string FoldedName(std::string_view name);

// Returns the name without a date at its beginning, and without the time behind the date, as
// programs that copy photographs put them before the names: "2021-05-04 12.30.01 img_7" becomes
// "img_7". Years are those from 1900 to 2099. Returns the name unchanged if nothing would remain.
std::string WithoutDate(const std::string& name);

}  // namespace lf
