// Its id is that of one of the methods of stand_ins.so.

#include "quiet_method.h"

QUIET_PLUGIN(QuietMethod, "refined");
