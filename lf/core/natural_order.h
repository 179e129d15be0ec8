// SPDX-License-Identifier: Apache-2.0
// The order of file names in which people count them.
#pragma once

#include <string_view>

namespace lf {

// Compares names so that numbers in them count by their value: 2 before 10.
bool NaturallyLess(std::string_view a, std::string_view b);

}  // namespace lf
