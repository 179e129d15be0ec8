// SPDX-License-Identifier: Apache-2.0
// Collects the distinct values among many.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

namespace lf {

// A list of distinct values, in the order in which they first came. The hash table takes 40 bytes
// per value in addition to the list. Equal values must have equal hashes.
template <class T, uint64_t (*HashOf)(const T&)>
class Distinct {
 public:
  Distinct() : indices_(0, Hash{&list_}, Equal{&list_}) {}
  Distinct(const Distinct&) = delete;
  Distinct& operator=(const Distinct&) = delete;

  size_t size() const { return list_.size(); }
  // Returns the index of the value in the list. Appends the value if it is new.
  uint32_t IndexOf(const T& value) {
    list_.push_back(value);  // because the set compares only values in the list
    const auto [index, is_new] = indices_.insert(static_cast<uint32_t>(list_.size() - 1));
    if (!is_new) list_.pop_back();
    return *index;
  }
  // Returns the list, and leaves this object empty.
  std::vector<T> Take() {
    indices_ = Indices(0, Hash{&list_}, Equal{&list_});
    return std::exchange(list_, {});
  }

 private:
  struct Hash {
    const std::vector<T>* list;
    size_t operator()(uint32_t index) const { return HashOf((*list)[index]); }
  };
  struct Equal {
    const std::vector<T>* list;
    bool operator()(uint32_t a, uint32_t b) const { return (*list)[a] == (*list)[b]; }
  };
  using Indices = std::unordered_set<uint32_t, Hash, Equal>;

  std::vector<T> list_;
  Indices indices_;
};

}  // namespace lf
