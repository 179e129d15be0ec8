// SPDX-License-Identifier: Apache-2.0
// Stores a light field's calibration in our SQLite files, for packages and packed stores. Numbers
// keep all their bits.
#pragma once

#include <string>
#include <vector>

#include "lf/camera/pinhole.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/sqlite/database.h"
#include "lf/storage/tables/settings_table.h"

namespace lf {

// Returns the settings that describe the pixels of a light field: the world unit ("unit_m"), the
// depth range, and all members of LightField::encoding ("bayer", "transfer", ...).
// ReadPixelSettings() reads them into `light_field`.
SettingList SettingsOfPixels(const LightField& light_field);
Result<void> ReadPixelSettings(const Settings& settings, LightField* light_field);

inline constexpr const char* kIntrinsicsTable = R"(
create table intrinsics (id integer primary key, width integer, height integer, fx real, fy real,
  cx real, cy real, skew real, distortion text, parameters text);)";

Result<void> WriteIntrinsics(const std::vector<Intrinsics>& intrinsics, Database* database);
// Reads the table of intrinsics, ordered by id.
//   settings  the settings of the file, which name the file in messages
Result<std::vector<Intrinsics>> ReadIntrinsics(const Settings& settings, Database* database);

// Binds an LF camera to the parameters of `statement` from number `parameter` on: index of its
// intrinsics, gain, x, y, z (the position in world units, which only people read) and pose.
void BindCamera(const LightField& light_field, LfImageId id, int parameter, Statement* statement);
// Reads an LF camera from three columns of a row, beginning at `column`: intrinsics, gain, pose.
//   settings          the settings of the file, which name the file in messages
//   name              name of the LF image, for messages; kInput if it is empty
//   intrinsics_count  number of rows in the table of intrinsics
Result<LfCamera> ReadCamera(const Settings& settings, const Statement& row, int column,
                            const std::string& name, size_t intrinsics_count);

}  // namespace lf
