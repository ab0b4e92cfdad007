// Nothing is wrong but its compiler's options.

#include "quiet_method.h"

QUIET_PLUGIN(QuietMethod, "compiled-otherwise");
