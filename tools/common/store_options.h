// SPDX-License-Identifier: Apache-2.0
// The options that are common to programs that write a packed store.
#pragma once

#include <string>

#include "tools/common/help.h"

namespace lf {

// Adds -o STORE.lfs.
void AddStoreOutput(OptionGroup& output, std::string& store);

// Adds --resume and --overwrite, of which only one may be given.
void AddStoreRestart(OptionGroup& running, bool& resume, bool& overwrite);

// Adds --cache, whose value DepthCacheFolder() takes.
CLI::Option* AddDepthCache(OptionGroup& group, std::string& cache);

}  // namespace lf
