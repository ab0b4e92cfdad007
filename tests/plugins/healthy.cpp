// Not broken: the neighbour whose cells must be complete, and in a second folder the duplicate of
// its id.

#include "quiet_method.h"

QUIET_PLUGIN(QuietMethod, "healthy");
