// SPDX-License-Identifier: Apache-2.0
#include "tools/common/store_options.h"

#include "tools/common/program.h"
#include "tools/common/validators.h"

namespace lf {

void AddStoreOutput(OptionGroup& output, std::string& store) {
  output.Add("-o,--output STORE.lfs", store, "Packed store to write")
      ->required()
      ->check(NotEmpty());
}

void AddStoreRestart(OptionGroup& running, bool& resume, bool& overwrite) {
  CLI::Option* const resumes =
      running.AddFlag("--resume", resume,
                      "Continue an unfinished store\n"
                      "Give the same inputs and options as when the store was begun. The image "
                      "files must be unchanged.");
  running
      .AddFlag("--overwrite", overwrite,
               "Replace an existing store, finished or unfinished\n"
               "A file that is not a packed store is never replaced.")
      ->excludes(resumes);
}

}  // namespace lf
