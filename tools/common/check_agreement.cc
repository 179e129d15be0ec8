// SPDX-License-Identifier: Apache-2.0
#include "tools/common/check_agreement.h"

#include <fmt/format.h>

#include <memory>
#include <vector>

#include "lf/core/shell_word.h"
#include "lf/import/agreement/agreement.h"
#include "lf/storage/load/open_store.h"

namespace lf {

Result<Disagreement> FindDisagreement(const LightField& light_field,
                                      const LightFieldArgument& argument, ThreadPool& pool,
                                      const std::atomic<bool>* interrupted) {
  LF_ASSIGN_OR_RETURN(const std::unique_ptr<LfImageStore> store,
                      OpenStore(light_field, Mosaics::kToRgb));
  LF_ASSIGN_OR_RETURN(const Agreement agreement,
                      JudgeAgreement(light_field, *store, pool, interrupted));
  if (agreement.verdict != Verdict::kDisagree) return Disagreement{};
  std::vector<std::string> command = {"lfimport", FileArgument(argument.path)};
  const std::vector<std::string> words = argument.Words();
  command.insert(command.end(), words.begin(), words.end());
  return Disagreement{TextOf(agreement),
                      fmt::format("The report names the repair: {}", ShellCommand(command))};
}

}  // namespace lf
