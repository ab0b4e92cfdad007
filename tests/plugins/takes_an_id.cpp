// Its id is that of one of the two methods of hybrid_patches.so.

#include "quiet_method.h"

QUIET_PLUGIN(QuietMethod, "static-patches");
