// SPDX-License-Identifier: Apache-2.0
#include "lf/storage/packed/store_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>
#include <string>
#include <string_view>
#include <unordered_map>

#include "lf/core/check.h"
#include "lf/storage/packed/packed_format.h"
#include "lf/storage/packed/part_set.h"
#include "lf/storage/packed/plan_settings.h"
#include "lf/storage/tables/calibration_tables.h"

namespace lf {
namespace {

// Returns a random id, by which a store and its shards are recognized as parts of one store.
std::string NewStoreId() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

Result<void> WriteImages(const LightField& light_field, const PackedStorePlan& plan,
                         Database* database) {
  LF_ASSIGN_OR_RETURN(
      Statement insert,
      database->Prepare("insert into lf_images values (?, ?, ?, ?, ?, ?, ?, ?, ?)"));
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    insert.Bind(0, int64_t{i});
    if (light_field.cameras[i].is_virtual)
      insert.BindNull(1);
    else
      insert.Bind(1, int64_t{plan.whole_ids.empty() ? i : plan.whole_ids[i]});
    insert.Bind(2, std::string_view(light_field.image_names[i]));
    BindCamera(light_field, LfImageId{i}, 3, &insert);
    LF_RETURN_IF_ERROR(insert.Run());
  }
  return {};
}

// Writes the list of virtual LF images.
Result<void> WriteVirtual(const LightField& light_field, Database* database) {
  LF_ASSIGN_OR_RETURN(Statement insert, database->Prepare("insert into virtual_images values (?)"));
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (light_field.cameras[i].is_virtual) LF_RETURN_IF_ERROR(insert.Bind(0, int64_t{i}).Run());
  return {};
}

// Writes the list of LF images that were left out on purpose.
Result<void> WriteLeftOut(const PackedStorePlan& plan, Database* database) {
  LF_ASSIGN_OR_RETURN(Statement insert, database->Prepare("insert into left_out values (?)"));
  for (uint32_t i = 0; i < plan.rects.size(); ++i)
    if (plan.rects[i].empty()) LF_RETURN_IF_ERROR(insert.Bind(0, int64_t{i}).Run());
  return {};
}

}  // namespace

Result<void> CheckPlan(const LightField& light_field, const PackedStorePlan& plan) {
  LF_CHECK(plan.densified || !HasVirtual(light_field));
  LF_CHECK(!plan.densified || !plan.densified->settings.empty());
  LF_CHECK(plan.whole_ids.empty() || plan.whole_ids.size() == light_field.size());
  LF_CHECK(plan.rects.empty() || plan.rects.size() == light_field.size());
  LF_CHECK(!plan.densified || !plan.LeavesOut());
  LF_CHECK(plan.part_count <= kMostParts);
  LF_CHECK(plan.part_count == 0 ||
           (plan.shard_bytes == 0 && !plan.densified && !plan.is_predicted));
  std::unordered_map<std::string_view, int> uses;
  for (uint32_t i = 0; i < light_field.size(); ++i) {
    const bool is_virtual = light_field.cameras[i].is_virtual;
    if (is_virtual) ++uses[light_field.image_names[i]];
    LF_CHECK(plan.whole_ids.empty() || is_virtual == (plan.whole_ids[i] == kNoWholeId));
  }
  for (uint32_t i = 0; i < light_field.size(); ++i)
    if (const auto use = uses.find(light_field.image_names[i]);
        use != uses.end() && use->second > (light_field.cameras[i].is_virtual ? 1 : 0))
      return UsageError(
          fmt::format("two LF images, of which one is virtual, have the name '{}': rename the one "
                      "that is recorded",
                      use->first));
  return {};
}

Result<void> MakeStoreTables(const LightField& light_field, const PackedStorePlan& plan,
                             Database* database) {
  const bool is_one_file = plan.shard_bytes == 0 && plan.part_count == 0;
  LF_RETURN_IF_ERROR(database->Execute(fmt::format(
      "begin; {}{}{}{}{}{}{}{}{}", kSettingsTable, kIntrinsicsTable, kStoreTables,
      is_one_file ? kBlobsTable : "", is_one_file ? kFrontsTable : "",
      plan.part_count > 0 ? kRangesTable : "", plan.densified ? kDensifiedTables : "",
      plan.LeavesOut() ? kLeftOutTable : "", plan.is_predicted ? kPredictedTable : "")));
  LF_RETURN_IF_ERROR(WriteSettings({{"written_by", "lfrendertools " + plan.version},
                                    {"light_field", plan.source},
                                    {"state", kUnfinished},
                                    {"store", NewStoreId()},
                                    {"shards", "0"},
                                    {kPartBytesKey, ""}},
                                   database));
  LF_RETURN_IF_ERROR(WriteSettings(SettingsOfPlan(light_field, plan), database));
  LF_RETURN_IF_ERROR(WriteIntrinsics(light_field.intrinsics, database));
  LF_RETURN_IF_ERROR(WriteImages(light_field, plan, database));
  if (plan.densified) LF_RETURN_IF_ERROR(WriteVirtual(light_field, database));
  if (plan.LeavesOut()) LF_RETURN_IF_ERROR(WriteLeftOut(plan, database));
  return database->Execute("commit");
}

}  // namespace lf
