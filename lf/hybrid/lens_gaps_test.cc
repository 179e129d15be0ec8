#include "lf/hybrid/lens_gaps.h"
