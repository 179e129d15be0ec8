// A light field's calibration in our SQLite files: what packages and packed stores have in common.
// Numbers keep all their bits.
#pragma once

#include <string>
#include <vector>

#include "lf/calibration_tables/settings_table.h"
#include "lf/camera/pinhole.h"
#include "lf/capture/light_field.h"
#include "lf/core/result.h"
#include "lf/database/database.h"

namespace lf {

// unit_m, depth_range and all of the encoding: settings "unit_m", "bayer", "transfer", ...
SettingList SettingsOfPixels(const LightField& light_field);
Result<void> ReadPixelSettings(const Settings& settings, LightField* light_field);

inline constexpr const char* kIntrinsicsTable = R"(
create table intrinsics (id integer primary key, width integer, height integer, fx real, fy real,
  cx real, cy real, skew real, distortion text, parameters text);)";

Result<void> WriteIntrinsics(const std::vector<Intrinsics>& intrinsics, Database* database);
// settings: of the file, for messages
Result<std::vector<Intrinsics>> ReadIntrinsics(const Settings& settings, Database* database);

// An LF camera as columns intrinsics, gain, x, y, z (for people) and pose.
inline constexpr int kCameraColumns = 6;
// Binds those that begin at `parameter`.
void BindCamera(const LightField& light_field, LfImageId id, int parameter, Statement* statement);
// From columns intrinsics, gain, pose that begin at `column`.
//   name              of the LF image, for messages; an empty one is damage
//   intrinsics_count  of the table
Result<LfCamera> ReadCamera(const Settings& settings, const Statement& row, int column,
                            const std::string& name, size_t intrinsics_count);

}  // namespace lf
