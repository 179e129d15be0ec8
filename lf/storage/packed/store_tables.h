// SPDX-License-Identifier: Apache-2.0
// Makes the tables of a packed store, with everything but the encoded images. Internal to this
// folder.
#pragma once

#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"
#include "lf/storage/packed/packed_store_writer.h"
#include "lf/storage/sqlite/database.h"

namespace lf {

// Checks that only a densified store has virtual LF images, and that only a store of recorded LF
// images leaves some out. kUsage: a virtual LF image has the name of another LF image, by which
// packages would confuse the two.
Result<void> CheckPlan(const LightField& light_field, const PackedStorePlan& plan);

// Makes all tables of a store in one transaction, so that a program that is killed here leaves all
// tables or none. kOutput: the disk fails.
Result<void> MakeStoreTables(const LightField& light_field, const PackedStorePlan& plan,
                             Database* database);

}  // namespace lf
