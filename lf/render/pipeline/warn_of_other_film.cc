// SPDX-License-Identifier: Apache-2.0
#include "lf/render/pipeline/warn_of_other_film.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "lf/core/log.h"
#include "lf/render/state/run_inputs.h"
#include "lf/storage/packed/packed_store_file.h"

namespace lf {
namespace {

// Returns true if this process calls it with the text for the first time.
bool IsNew(const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard lock(mutex);
  return told.insert(text).second;
}

bool IsWeighted(const std::string& lens_weights) {
  return lens_weights != NameOf(LensWeights::kNone);
}

}  // namespace

Result<void> WarnOfOtherFilm(const Package& package, const FilmSettings& film) {
  if (!HoldsPackedStore(package.light_field)) return {};
  const std::filesystem::path& store = package.light_field.folder;
  LF_ASSIGN_OR_RETURN(const std::optional<StoreFilms> films, ReadStoreFilms(store));
  if (!films) return {};
  const std::string lenses = HashOfLenses(package.path);
  const bool is_known =
      std::find(films->lenses.begin(), films->lenses.end(), lenses) != films->lenses.end();
  if (is_known && film.mode == RenderMode::kCollect &&
      IsWeighted(films->lens_weights) == IsWeighted(NameOf(film.lens_weights)))
    return {};
  const std::string difference =
      !is_known                           ? "the film of " + films->source
      : film.mode != RenderMode::kCollect ? "this film with {mode collect}"
      : IsWeighted(films->lens_weights)   ? "this film with lens weights"
                                          : "this film with {lens_weights none}";
  if (!IsNew(store.string() + lenses + difference)) return {};
  LogWarning(
      "{}: this store was encoded for {} ({{lfcompressor quality_by_use}}), which uses its LF "
      "images differently: the quality of this film may be lower",
      store.string(), difference);
  return {};
}

}  // namespace lf
