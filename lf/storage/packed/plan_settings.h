// SPDX-License-Identifier: Apache-2.0
// The settings of a packed store that follow from its plan, and how they differ from those of an
// existing store. Internal to this folder.
#pragma once

#include <optional>
#include <string>

#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/tables/settings_table.h"

namespace lf {

// Returns the settings that an unfinished store must share with the plan by which it is resumed.
SettingList SettingsOfPlan(const LightField& light_field, const PackedStorePlan& plan);

// Returns the films that the settings of a store state; nullopt if they state none. kInput: damaged
// settings.
Result<std::optional<StoreFilms>> FilmsOf(const Settings& settings);

// Returns the first difference between the settings of a store and a plan, as text that continues
// "begun with": "codec default, levels 4, threshold 3, but now it is ...". Returns none if there is
// no difference.
//   any_shards  true: the size of shards may differ
std::optional<std::string> FirstDifference(const Settings& settings, const LightField& light_field,
                                           const PackedStorePlan& plan, bool any_shards);

}  // namespace lf
