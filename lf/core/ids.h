// SPDX-License-Identifier: Apache-2.0
// Integer identities. Each kind has its own type, so that the compiler rejects an id of another
// kind.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace lf {

template <class Tag>
struct Id {
  uint32_t value = 0;
  friend auto operator<=>(const Id&, const Id&) = default;
};

// One photograph of the light field: its index in LightField::cameras.
using LfImageId = Id<struct LfImageTag>;

// One rendered image of the sequence, by its number (frame_numbers.h).
using FrameId = Id<struct FrameTag>;

}  // namespace lf

template <class Tag>
struct std::hash<lf::Id<Tag>> {
  size_t operator()(lf::Id<Tag> id) const noexcept { return id.value; }
};
