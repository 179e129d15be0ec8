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

// Returns the settings "unit_m", "depth_range", "bayer", "transfer", ...: the unit, the depth range
// and the whole encoding. ReadPixelSettings() reads them into `light_field`.
SettingList SettingsOfPixels(const LightField& light_field);
Result<void> ReadPixelSettings(const Settings& settings, LightField* light_field);

inline constexpr const char* kIntrinsicsTable = R"(
create table intrinsics (id integer primary key, width integer, height integer, fx real, fy real,
  cx real, cy real, skew real, distortion text, parameters text);)";

Result<void> WriteIntrinsics(const std::vector<Intrinsics>& intrinsics, Database* database);
//   settings  the settings of the file, for messages
Result<std::vector<Intrinsics>> ReadIntrinsics(const Settings& settings, Database* database);

// Binds the columns of an LF camera, beginning at `parameter`: intrinsics, gain, x, y, z (the
// position, which only people read) and pose.
void BindCamera(const LightField& light_field, LfImageId id, int parameter, Statement* statement);
// Reads the columns intrinsics, gain, pose, beginning at `column`.
//   name              name of the LF image, for messages; an empty name is damage
//   intrinsics_count  number of rows in the table of intrinsics
Result<LfCamera> ReadCamera(const Settings& settings, const Statement& row, int column,
                            const std::string& name, size_t intrinsics_count);

}  // namespace lf
