// SPDX-License-Identifier: Apache-2.0
#include "lf/camera/path/spelling.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lf {

size_t EditDistance(std::string_view a, std::string_view b) {
  // Rows i - 2, i - 1 and i of the table of distances, in which entry [i][j] is the distance
  // between the first i letters of `a` and the first j letters of `b`.
  std::vector<size_t> before(b.size() + 1), row(b.size() + 1), next(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t changed = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      next[j] = std::min({changed, row[j] + 1, next[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    std::swap(before, row);
    std::swap(row, next);
  }
  return row[b.size()];
}

std::string NearestWord(std::string_view word, std::span<const std::string> words) {
  constexpr size_t kLongestWord = 64;  // a longer word is not compared with `words`
  if (word.size() > kLongestWord) return {};
  std::string nearest;
  size_t smallest = kLongestWord;
  for (const std::string& candidate : words) {
    const bool lacks_unit = word.size() > 1 && candidate.starts_with(std::string(word) + "_");
    const size_t distance = lacks_unit ? 1 : EditDistance(word, candidate);
    if (distance >= smallest || 3 * distance > std::max(word.size(), candidate.size())) continue;
    smallest = distance;
    nearest = candidate;
  }
  return nearest;
}

}  // namespace lf
