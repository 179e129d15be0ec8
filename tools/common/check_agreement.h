// SPDX-License-Identifier: Apache-2.0
// Tells people that the images of a light field do not belong to the poses of its LF cameras.
#pragma once

#include <atomic>
#include <string>

#include "tools/common/light_field_argument.h"

#include "lf/core/parallel.h"
#include "lf/core/result.h"
#include "lf/light_field/model/light_field.h"

namespace lf {

struct Disagreement {
  std::string text;    // TextOf() the agreement; empty: images and poses do not disagree
  std::string advice;  // a sentence with the call of lfimport that reports the repair
};

// Returns the disagreement of images and poses (import/agreement/agreement.h). kInterrupted: after
// `interrupted`, which may be null, became true. Other errors as for OpenStore() and
// JudgeAgreement().
Result<Disagreement> FindDisagreement(const LightField& light_field,
                                      const LightFieldArgument& argument, ThreadPool& pool,
                                      const std::atomic<bool>* interrupted = nullptr);

}  // namespace lf
