#include "lf/hybrid/render_mode.h"

namespace lf {

const char* NameOf(RenderMode mode) {
  constexpr const char* kNames[] = {"collect", "rebin", "hybrid"};
  return kNames[static_cast<int>(mode)];
}

}  // namespace lf
