// The inner loop of demosaicing. Internal to store.
#pragma once

#include <cstdint>

namespace lf {

// Factors of the Laplacians in a row. A row of a mosaic holds G and either R or B: call that one C,
// and D the one that is not in the row. In 1/4096, of Laplacians as integers.
struct RowGains {
  int32_t g_at_c = 0;  // of 4 C less the four others
  int32_t d_at_c = 0;
  int32_t c_at_g = 0;  // of 10 G less the others, weighted
  int32_t d_at_g = 0;
};

// The RGB pixels of `pair_count` pairs: one that recorded C, one that recorded G.
//   rows  those from y - 2 to y + 2, at the first pair; three values before it and two after the
//         last pair are read
//   rgb   [pair_count][2][4]: R, G, B, 1
void DemosaicPairs(const uint16_t* const rows[5], bool c_is_red, const RowGains& gains,
                   int pair_count, uint16_t* rgb);

}  // namespace lf
