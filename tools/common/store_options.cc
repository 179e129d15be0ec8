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

CLI::Option* AddDepthCache(OptionGroup& group, std::string& cache) {
  return group
      .Add("--cache DIR", cache,
           "Folder that keeps depths for other calls (beside LIGHTFIELD)\n"
           "Depths of recorded LF images depend neither on PATH nor on the number of virtual LF "
           "images, and take most of the time. The default is a folder beside the light field, "
           "such as capture.depths; depths are not kept if this place cannot be written or belongs "
           "to another user. none: depths are not kept. Where images, poses or options differ, "
           "depths are searched again. The folder may be removed at any time.")
      ->check(NotEmpty());
}

}  // namespace lf
